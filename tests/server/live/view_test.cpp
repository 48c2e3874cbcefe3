// The live view through real sockets. No test depends on how fast this machine is.
#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <iterator>
#include <memory>
#include <vector>

#include "formats/protocol/usarsim_message.hpp"
#include "tests/server/live/served_world.hpp"
#include "tests/server/live/web_client.hpp"
#include "tests/support/process.hpp"
#include "tests/support/usarsim_client.hpp"

#if defined(__has_feature)
#define KENAF_CLANG_SANITIZES __has_feature(address_sanitizer)
#else
#define KENAF_CLANG_SANITIZES 0
#endif

namespace kenaf::live {

namespace {

using nlohmann::json;

std::string answer_to(const ServedWorld& world, std::string_view request) {
  WebClient client(world.port());
  client.send(request);
  return client.answer();
}

std::string status_of(const std::string& answer) {
  return answer.substr(9, 3);
}

// A page that looks on.
struct Page : WebClient {
  int you = 0;
  json server;

  explicit Page(const ServedWorld& world) : WebClient(world.port()) {
    REQUIRE(open_websocket());
    const json hello = message_of("hello");
    CHECK(hello["protocol"] == 2);
    you = hello["you"];
    server = hello["server"];
  }
  json state() { return message_of("state"); }
  // The newest state in which `condition` holds.
  template <typename Condition>
  json state_with(Condition condition) {
    for (;;) {
      const json next = state();
      if (condition(next)) return next;
    }
  }
  // Likewise of the first robot.
  template <typename Condition>
  json robot_with(Condition condition) {
    const json found =
        state_with([&](const json& next) { return !next["robots"].empty() && condition(next["robots"][0]); });
    return found["robots"][0];
  }
  int place() {
    send_text(R"({"type":"place"})");
    return message_of("placed")["robot"];
  }
  void drive(int robot, double left_mps, double right_mps) {
    send_text(json{{"type", "drive"}, {"robot", robot}, {"left", left_mps}, {"right", right_mps}}.dump());
  }
};

std::uint64_t resident_bytes() {
  std::ifstream statm("/proc/self/statm");
  std::uint64_t total = 0, resident = 0;
  statm >> total >> resident;
  return resident * 4096;
}

}  // namespace

TEST_CASE("The page, its parts and three.js are served, with a policy that loads nothing from elsewhere") {
  ServedWorld world;
  WebClient client(world.port());
  for (const auto& [path, type] : std::vector<std::pair<std::string, std::string>>{
           {"/", "text/html"},
           {"/page.css", "text/css"},
           {"/main.js", "text/javascript"},
           {"/three/build/three.module.js", "text/javascript"},
           {"/three/examples/jsm/controls/OrbitControls.js", "text/javascript"}}) {
    INFO(path);
    client.send(get(path));  // one after another on one connection
    const std::string answer = client.answer();
    CHECK(status_of(answer) == "200");
    CHECK(answer.find("Content-Type: " + type) != std::string::npos);
    CHECK(answer.find("default-src 'none'") != std::string::npos);
  }
  for (const char* path : {"/nothing", "/../main.cpp", "/%2e%2e/main.cpp", "//", "/page.css/", "/three/"}) {
    INFO(path);
    CHECK(status_of(answer_to(world, get(path))) == "404");
  }
}

TEST_CASE("Neither another name for this machine nor another server's page is answered") {
  ServedWorld world;
  CHECK(status_of(answer_to(world, "GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n")) == "403");
  CHECK(status_of(answer_to(world, "GET / HTTP/1.1\r\n\r\n")) == "403");
  CHECK(status_of(answer_to(world, get("/scene", "Origin: http://evil.example\r\n"))) == "403");
  CHECK(status_of(answer_to(world, get("/scene", "Origin: http://127.0.0.1\r\n"))) == "200");
  CHECK_FALSE(WebClient(world.port()).open_websocket("/ws", "Origin: http://evil.example\r\n"));
  CHECK_FALSE(WebClient(world.port()).open_websocket("/ws", "Origin: null\r\n"));
  CHECK(WebClient(world.port()).open_websocket("/ws", "Origin: http://127.0.0.1\r\n"));
}

TEST_CASE("Where a token is needed, nobody looks or drives without it") {
  ServedWorld world("0123456789abcdef");
  CHECK(world.url().ends_with("/#token=0123456789abcdef"));
  CHECK(status_of(answer_to(world, get("/"))) == "200");  // the page itself is no secret
  CHECK(status_of(answer_to(world, get("/scene"))) == "401");
  CHECK(status_of(answer_to(world, get("/scene?token=0123456789abcdeF"))) == "401");
  CHECK(status_of(answer_to(world, get("/scene?token=0123456789abcdef"))) == "200");
  CHECK_FALSE(WebClient(world.port()).open_websocket("/ws"));
  CHECK_FALSE(WebClient(world.port()).open_websocket("/ws?token="));
  CHECK(WebClient(world.port()).open_websocket("/ws?token=0123456789abcdef"));
}

TEST_CASE("Another address than loopback makes itself a token") {
  world_server::ServerOptions options;
  options.port = 0;
  world_server::WorldServer server(options);
  ViewOptions anywhere{true, "0.0.0.0", 0, ""};
  CHECK(View(server, anywhere).url().find("#token=") != std::string::npos);
  anywhere.token = "chosen";
  CHECK(View(server, anywhere).url().ends_with("#token=chosen"));
}

TEST_CASE("A token that was made is told, however little is logged") {
  world_server::ServerOptions options;
  options.port = 0;
  world_server::WorldServer server(options);
  support::TemporaryFolder folder;
  const auto said_with = [&](const ViewOptions& view_options) {
    const std::string path = folder.path() / "stderr";
    const int before = ::dup(STDERR_FILENO),
              file = ::open(path.c_str(), O_CREAT | O_TRUNC | O_WRONLY | O_CLOEXEC, 0600);
    const auto level = spdlog::get_level();
    spdlog::set_level(spdlog::level::off);
    ::dup2(file, STDERR_FILENO);
    const std::string url = open_view(server, view_options, nullptr)->url();
    ::dup2(before, STDERR_FILENO);
    spdlog::set_level(level);
    ::close(file);
    ::close(before);
    std::ifstream in(path);
    const std::string said((std::istreambuf_iterator<char>(in)), {});
    if (!said.empty()) CHECK(said == "live view: " + url + "\n");
    return !said.empty();
  };
  CHECK(said_with({true, "0.0.0.0", 0, ""}));
  CHECK_FALSE(said_with({true, "0.0.0.0", 0, "chosen"}));
  CHECK_FALSE(said_with({true, "127.0.0.1", 0, ""}));
}

TEST_CASE("A view with a page that waits for an answer ends before its world, which never ran") {
  world_server::ServerOptions options;
  options.port = 0;
  world_server::WorldServer server(options);
  auto view = std::make_unique<View>(server, ViewOptions{true, "127.0.0.1", 0, ""});
  WebClient page(view->port());
  REQUIRE(page.open_websocket());
  page.message_of("hello");
  page.send_text(R"({"type":"place"})");
  // One thread serves all: when it has answered these, it has taken what came before them.
  for (int i = 0; i < 2; ++i) {
    WebClient other(view->port());
    other.send(get("/page.css"));
    CHECK(status_of(other.answer()) == "200");
  }
  view.reset();
}

TEST_CASE("A port that is taken is named, and a program goes on without the view, unless that was asked for") {
  ServedWorld world;
  world_server::ServerOptions options;
  options.port = 0;
  world_server::WorldServer server(options);
  const ViewOptions taken{true, "127.0.0.1", world.port(), ""};
  CHECK_THROWS_WITH(View(server, taken), Catch::Contains(std::to_string(world.port())) && Catch::Contains("--view"));
  CHECK(open_view(server, taken, nullptr) == nullptr);
  ViewOptions asked_for = taken;
  asked_for.asked_for = true;
  CHECK_THROWS_WITH(open_view(server, asked_for, nullptr),
                    Catch::Contains("no live view") && Catch::Contains(std::to_string(world.port())));
  CHECK(open_view(server, ViewOptions{false, "127.0.0.1", 0, ""}, nullptr) == nullptr);
}

TEST_CASE("A page places a robot in an empty world, drives it, and it stops when the page goes silent") {
  ServedWorld world;
  Page page(world);
  const int robot = page.place();
  page.robot_with([&](const json& state) {
    page.drive(robot, 0.3, 0.3);  // again with every state
    return state["track_mps"][0] > 0.2;
  });
  const json stopped = page.robot_with([](const json& state) { return state.value("holder_silent", false); });
  CHECK(stopped["command"]["track"] == json::array({0, 0}));
  CHECK(stopped["p"][0] > 0);
  page.send_text(R"({"type":"remove","robot":)" + std::to_string(robot) + "}");
  page.state_with([](const json& state) { return state["robots"].empty(); });
}

TEST_CASE("A page has contacts only while it asks for them, and another page has none") {
  ServedWorld world;
  Page page(world), other(world);
  const int robot = page.place();
  page.send_text(R"({"type":"show","contacts":true})");
  const json standing =
      page.robot_with([](const json& state) { return state.contains("contacts") && !state["contacts"].empty(); });
  CHECK(standing["id"] == robot);
  for (int i = 0; i < 5; ++i) CHECK_FALSE(other.robot_with([](const json&) { return true; }).contains("contacts"));
  page.send_text(R"({"type":"show","contacts":false,"sensors":)" + std::to_string(robot) + "}");
  const json seeing = page.robot_with([](const json& state) { return state.contains("scans"); });
  CHECK_FALSE(seeing.contains("contacts"));
  CHECK(seeing.contains("imu"));
  page.send_text(R"({"type":"show"})");
  page.robot_with([](const json& state) { return !state.contains("scans"); });
}

TEST_CASE("A page places a robot where it says, on the ground and turned") {
  ServedWorld world;
  Page page(world);
  page.send_text(R"({"type":"place","p":[2,-3,0],"yaw":1.5707963})");
  page.message_of("placed");
  const json robot = page.robot_with([](const json&) { return true; });
  CHECK(robot["p"][0] == Approx(2).margin(1e-3));
  CHECK(robot["p"][1] == Approx(-3).margin(1e-3));
  CHECK(robot["p"][2] == Approx(0.09).margin(2e-3));  // its belly is 90 mm below its centre
  CHECK(robot["q"][3] == Approx(std::sqrt(0.5)).margin(1e-3));
}

TEST_CASE("Of two pages one drives, and when its connection ends the other can") {
  ServedWorld world;
  auto first = std::make_unique<Page>(world);
  Page second(world);
  CHECK(first->you != second.you);
  CHECK(first->server == second.server);
  const int robot = first->place();
  const std::string take = R"({"type":"take","robot":)" + std::to_string(robot) + "}";
  second.send_text(take);
  CHECK(second.message_of("refused")["request"] == "take");
  second.drive(robot, 0.5, 0.5);
  CHECK(second.message_of("refused")["request"] == "drive");
  first.reset();
  second.robot_with([](const json& state) { return !state.contains("holder"); });
  second.send_text(take);
  const json taken = second.robot_with([](const json& state) { return state.contains("holder"); });
  CHECK(taken["holder"] == second.you);
}

TEST_CASE("A page takes a robot over from its program, and the program has it back") {
  ServedWorld world;
  support::UsarsimClient program(world.usarsim_port());
  program.send("INIT {ClassName USARBot.Kenaf} {Name R1} {Location 0,0,0}\r\nDRIVE {Left 3} {Right 3}\r\n");
  Page page(world);
  const json before = page.robot_with([](const json&) { return true; });
  const int robot = before["id"];
  CHECK(before.contains("client"));
  page.send_text(R"({"type":"take","robot":)" + std::to_string(robot) + "}");
  page.robot_with([](const json& state) { return state.contains("holder"); });
  program.send("DRIVE {Left 3} {Right 3}\r\n");
  page.robot_with([](const json& state) { return std::abs(state["track_mps"][0].get<double>()) < 0.01; });
  page.send_text(R"({"type":"let-go","robot":)" + std::to_string(robot) + "}");
  page.robot_with([](const json& state) { return !state.contains("holder"); });
  program.send("DRIVE {Left 3} {Right 3}\r\n");
  page.robot_with([](const json& state) { return state["track_mps"][0] > 0.1; });
}

TEST_CASE("A page pauses, steps, speeds up and resets the world") {
  ServedWorld world;
  Page page(world);
  page.send_text(R"({"type":"step","time":1})");
  CHECK(page.message_of("refused")["request"] == "step");  // time stands still without a robot
  page.place();
  page.send_text(R"({"type":"speed","value":5})");
  page.state_with([](const json& state) { return state["speed"] == 5 && state["t"] > 0.2; });
  page.send_text(R"({"type":"pause","on":true})");
  const json paused = page.state_with([](const json& state) { return state["paused"] == true; });
  CHECK(page.state()["step"] == paused["step"]);
  page.send_text(R"({"type":"step","time":0.25})");
  const std::uint64_t end = paused["step"].get<std::uint64_t>() + 250;
  page.state_with([&](const json& state) { return state["step"] == end; });
  page.send_text(R"({"type":"reset"})");
  page.state_with([](const json& state) { return state["step"] == 0; });
  page.send_text(R"({"type":"pause","on":false})");
  page.state_with([](const json& state) { return state["t"] > 0; });
  page.send_text(R"({"type":"ping","t":4711})");
  CHECK(page.message_of("pong")["t"] == 4711);
}

TEST_CASE("A state says who paused the world: the operator's page, or the program by its robot") {
  ServedWorld world;
  Page page(world), other(world);
  page.place();
  CHECK_FALSE(page.state().contains("paused_by"));
  other.send_text(R"({"type":"pause","on":true})");
  const json by_page = page.state_with([](const json& state) { return state["paused"] == true; });
  CHECK(by_page["paused_by"] == json{{"operator", other.you}});
  // who comes later has not stopped it
  page.send_text(R"({"type":"step","time":0.001})");
  const json stepped = page.state_with([&](const json& state) { return state["step"] > by_page["step"]; });
  CHECK(stepped["paused_by"] == json{{"operator", other.you}});
  page.send_text(R"({"type":"pause","on":false})");
  page.state_with([](const json& state) { return state["paused"] == false && !state.contains("paused_by"); });

  support::UsarsimClient program(world.usarsim_port());
  program.send("INIT {ClassName USARBot.Kenaf} {Name R1} {Location 0,3,0}\r\nCONTROL {Type Pause}\r\n");
  const json by_program = page.state_with([](const json& state) { return state["paused"] == true; });
  CHECK(by_program["paused_by"] == json{{"program", "R1"}});
}

TEST_CASE("What is no request is refused, and the page is served on") {
  ServedWorld world;
  Page page(world);
  for (const char* wrong : {"", "{", "[[[[", R"({"type":"drive","robot":1,"left":"fast"})", "\xff\xfe"}) {
    if (std::string_view(wrong) == "\xff\xfe") continue;  // no text at all: the next test
    page.send_text(wrong);
    page.message_of("refused");
  }
  page.send_text(R"({"type":"ping","t":1})");
  page.message_of("pong");
}

TEST_CASE("Hostile bytes end their own connection and nothing else") {
  ViewLimits limits;
  limits.quiet_s = 1;  // some of them look like a beginning
  ServedWorld world("", limits);
  const auto closed = [&](std::string_view bytes) {
    WebClient client(world.port());
    client.send(bytes);
    client.rest();  // returns when the server closes
  };
  closed("\x16\x03\x01\x02\x01garbage of another protocol\r\n\r\n");
  closed(std::string(100000, 'A'));
  closed("GET / HTTP/9.9\r\n\r\n");
  closed("GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 99999999999\r\n\r\n");
  closed("GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nX: " + std::string(20000, 'x') + "\r\n\r\n");
  closed("POST /ws HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 3\r\n\r\nabc");
  closed("DELETE / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n");
  const auto closed_after_upgrade = [&](std::string_view bytes) {
    WebClient client(world.port());
    REQUIRE(client.open_websocket());
    client.send(bytes);
    while (client.message()) {
    }
  };
  using namespace std::string_literals;
  closed_after_upgrade("\x81\x02\xff\xff"s);                            // not masked
  closed_after_upgrade("\x81\x82\x00\x00\x00\x00\xff\xfe"s);            // not UTF-8
  closed_after_upgrade("\x81\xfe\x20\x00"s + std::string(8196, '\0'));  // longer than a message may be
  closed_after_upgrade("\x81\xff\x7f\xff\xff\xff\xff\xff\xff\xff"s);    // 2^63 bytes
  closed_after_upgrade("\xff\xff\xff\xff\xff\xff"s);
  CHECK_FALSE(Page(world).state().empty());
  CHECK(status_of(answer_to(world, get("/"))) == "200");
}

TEST_CASE("A browser that says nothing is let go of, as one that opens too many connections is") {
  ViewLimits limits;
  limits.quiet_s = 1;
  limits.connections = 4;
  ServedWorld world("", limits);
  std::vector<std::unique_ptr<WebClient>> silent;
  for (int i = 0; i < 10; ++i) silent.push_back(std::make_unique<WebClient>(world.port()));
  for (const auto& client : silent) CHECK(client->rest().empty());  // closed, at once or after 1 s
  CHECK(status_of(answer_to(world, get("/"))) == "200");
}

TEST_CASE("No more than the allowed number of pages looks on") {
  ViewLimits limits;
  limits.viewers = 2;
  ServedWorld world("", limits);
  WebClient first(world.port()), second(world.port()), third(world.port());
  REQUIRE(first.open_websocket());
  REQUIRE(second.open_websocket());
  first.message_of("hello");
  second.message_of("hello");
  CHECK_FALSE(third.open_websocket());
}

TEST_CASE("Fifty pages that read nothing cost bounded memory, and others see every state") {
  ViewLimits limits;
  limits.period_s = 0.001;
  ServedWorld world("", limits);
  Page page(world);
  for (int i = 0; i < 8; ++i) page.place();
  std::vector<std::unique_ptr<WebClient>> slow;
  for (int i = 0; i < 50; ++i) {
    slow.push_back(std::make_unique<WebClient>(world.port(), 4096));
    REQUIRE(slow.back()->open_websocket());
    page.state();  // and answers pings: of one that is quiet for long the view lets go
  }
  // Until what the system keeps for them is full: 8 robots are some 3 kB a state, a socket keeps about 64 kB
  for (int i = 0; i < 100; ++i) page.state();
  [[maybe_unused]] const std::uint64_t before = resident_bytes();
  std::uint64_t first = page.state()["n"], last = 0;
  for (int i = 0; i < 500; ++i) last = page.state()["n"];
  CHECK(last >= first + 500);
  // 500 states of 3 kB for 50 pages would be 75 MB. A sanitizer keeps what is freed, so memory says nothing there.
#if !defined(__SANITIZE_ADDRESS__) && !KENAF_CLANG_SANITIZES
  CHECK(resident_bytes() < before + (8 << 20));
#endif
  page.send_text(R"({"type":"ping","t":1})");
  page.message_of("pong");
}

TEST_CASE("A page that asks without end and reads no answer is let go of") {
  ViewLimits limits;
  limits.requests_per_s = 1000000;
  ServedWorld world("", limits);
  WebClient flood(world.port(), 4096);
  REQUIRE(flood.open_websocket());
  std::string frames;
  for (int i = 0; i < 40000; ++i) frames += std::string("\x81\x80\0\0\0\0", 6);  // an empty text: refused in words
  int rounds = 0;
  while (flood.send(frames)) REQUIRE(++rounds < 1000);
  Page witness(world);
  witness.state_with([](const json& state) { return state["viewers"] == 1; });
}

}  // namespace kenaf::live
