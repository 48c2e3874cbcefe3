// The cameras' pictures in a browser: one, or a stream of them, by the rules of who may look; and turning a camera by
// hand.
#include "server/live/picture_stream.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <thread>

#include "camera/jpeg.hpp"
#include "tests/server/live/served_world.hpp"
#include "tests/server/live/web_client.hpp"
#include "tests/support/patience.hpp"
#include "tests/support/usarsim_client.hpp"

namespace kenaf::live {

namespace {

using nlohmann::json;

std::string placed_robot(const std::string& name, const std::string& location = "0,0,0") {
  return "INIT {ClassName USARBot.Kenaf} {Name " + name + "} {Location " + location + "}\r\n";
}

// The answer to a GET, to its end.
std::string whole_answer(const ServedWorld& world, std::string_view target, std::string_view headers = "") {
  WebClient client(world.port());
  client.send(get(target, headers));
  return client.answer();
}

std::string header(std::string_view headers, const std::string& name) {
  const std::size_t begin = headers.find(name + ": ");
  if (begin == std::string_view::npos) return "";
  const std::size_t from = begin + name.size() + 2;
  return std::string(headers.substr(from, headers.find("\r\n", from) - from));
}

// A browser's side of a stream: what is between two boundaries is a part.
struct Part {
  std::string headers, bytes;
};
class Stream {
 public:
  Stream(std::uint16_t port, const std::string& target, int receive_buffer_bytes = 0)
      : client_(port, receive_buffer_bytes) {
    client_.send(get(target));
    head_ = client_.answer();  // without a length: its headers alone
  }
  const std::string& head() const { return head_; }
  Part part() {
    const std::string begin = client_.answer();  // boundary and headers of the part, and its bytes
    const std::size_t end = begin.find("\r\n\r\n");
    return {begin.substr(0, end + 2), begin.substr(end + 4)};
  }

 private:
  WebClient client_;
  std::string head_;
};

camera::Picture picture_in(const std::string& jpeg) {
  return camera::decode_jpeg({reinterpret_cast<const std::uint8_t*>(jpeg.data()), jpeg.size()});
}

}  // namespace

TEST_CASE("A picture's path names a camera, alone or of a robot, and its query a size") {
  const auto path = [](std::string_view text, std::string_view query = "") {
    const auto found = parse_picture_path(text, query);
    if (!found) return std::string("none");
    const bool is_half = found->size == image_server::PictureSize::half;
    return found->view + (is_half ? " half" : "") + (found->stream ? " stream" : " picture");
  };
  CHECK(path("/Camera.mjpg") == "Camera stream");
  CHECK(path("/R1/Camera.jpg") == "R1/Camera picture");
  CHECK(path("/a%20b%2fc/Camera.mjpg") == "a b/c/Camera stream");
  CHECK(path("/%233/Camera.mjpg") == "#3/Camera stream");
  CHECK(path("/%4.jpg") == "%4 picture");
  CHECK(path("/100%zz.jpg") == "100%zz picture");
  for (const char* none : {"", "/", "/.jpg", "Camera.jpg", "/Camera", "/Camera.jpg/"}) CHECK(path(none) == "none");
  CHECK(path("/Camera.mjpg", "size=half&token=1") == "Camera half stream");
  CHECK(path("/Camera.jpg", "token=1&size=full") == "Camera picture");
  for (const char* none : {"size=huge", "size=HALF", "size=half "}) CHECK(path("/Camera.jpg", none) == "none");
}

TEST_CASE("One picture: a JPEG, its number, its robot time and its age") {
  ServedWorld world;
  CHECK(whole_answer(world, "/camera/Camera.jpg").starts_with("HTTP/1.1 404"));
  support::UsarsimClient program(world.usarsim_port());
  program.send(placed_robot("My Robot"));
  program.line_that_begins("STA");
  for (const char* target : {"/camera/My%20Robot/Camera.jpg", "/camera/BirdsEye.jpg"}) {
    const std::string answer = whole_answer(world, target);
    const std::size_t end = answer.find("\r\n\r\n");
    REQUIRE(answer.starts_with("HTTP/1.1 200"));
    CHECK(header(answer, "Content-Type") == "image/jpeg");
    CHECK(header(answer, "Content-Security-Policy").starts_with("default-src 'none'"));
    CHECK(std::stoul(header(answer, "X-Frame-Number")) >= 1);
    CHECK(std::stod(header(answer, "X-Robot-Time")) >= 0);
    CHECK(std::stod(header(answer, "X-Age-Ms")) >= 20);  // the latency
    CHECK(picture_in(answer.substr(end + 4)).width == 640);
  }
  const std::string none = whole_answer(world, "/camera/Third.jpg");
  CHECK(none.starts_with("HTTP/1.1 404"));
  CHECK(none.find("My Robot/BirdsEye") != std::string::npos);
}

TEST_CASE("A stream: each part a newer picture, until the robot leaves") {
  ServedWorld world;
  support::UsarsimClient witness(world.usarsim_port());
  witness.send(placed_robot("R1"));
  witness.line_that_begins("STA");
  auto program = std::make_unique<support::UsarsimClient>(world.usarsim_port());
  program->send(placed_robot("R2", "0,3,0"));
  program->line_that_begins("STA");
  Stream stream(world.port(), "/camera/R2/Camera.mjpg");
  CHECK(stream.head().starts_with("HTTP/1.1 200"));
  CHECK(header(stream.head(), "Content-Type") == "multipart/x-mixed-replace; boundary=kenaf-frame");
  unsigned long number = 0;
  double time_s = -1;
  for (int i = 0; i < 5; ++i) {
    const Part part = stream.part();
    CHECK(part.headers.find("--kenaf-frame\r\n") != std::string::npos);
    CHECK(header(part.headers, "Content-Type") == "image/jpeg");
    const unsigned long next = std::stoul(header(part.headers, "X-Frame-Number"));
    const double next_s = std::stod(header(part.headers, "X-Robot-Time"));
    CHECK(next > number);
    CHECK(next_s > time_s);
    number = next;
    time_s = next_s;
    CHECK(part.bytes.find("kenaf-frame/1 number=" + std::to_string(number)) != std::string::npos);
    CHECK(picture_in(part.bytes).height == 480);
  }
  program.reset();
  CHECK_THROWS_WITH(
      [&] {
        for (;;) stream.part();
      }(),
      Catch::Contains("closed"));
}

TEST_CASE("A picture of half the size shows the same moment under the same number") {
  ServedWorld world;
  support::UsarsimClient program(world.usarsim_port());
  program.send(placed_robot("R1"));
  program.line_that_begins("STA");
  Stream full(world.port(), "/camera/Camera.mjpg");
  full.part();
  const auto number_of = [](const Part& part) { return std::stoul(header(part.headers, "X-Frame-Number")); };
  WebClient page(world.port());
  REQUIRE(page.open_websocket());
  page.send_text(R"({"type":"pause","on":true})");
  for (json message = json::object(); !message.value("paused", false);) message = page.message().value();

  // While time stands, one that nobody has asked for before is of the moment that the other one shows.
  Stream half(world.port(), "/camera/Camera.mjpg?size=half");
  const Part small = half.part();
  CHECK(picture_in(small.bytes).width == 320);
  CHECK(picture_in(small.bytes).height == 240);
  Part large = full.part();
  while (number_of(large) < number_of(small)) large = full.part();
  CHECK(picture_in(large.bytes).width == 640);
  CHECK(number_of(large) == number_of(small));
  CHECK(header(large.headers, "X-Robot-Time") == header(small.headers, "X-Robot-Time"));

  // Once time runs again, too.
  page.send_text(R"({"type":"pause","on":false})");
  std::map<std::string, std::string> time_of;
  for (int i = 0; i < 20; ++i) {
    const Part part = full.part();
    time_of[header(part.headers, "X-Frame-Number")] = header(part.headers, "X-Robot-Time");
  }
  int same = 0;
  for (int i = 0; i < 20; ++i) {
    const Part part = half.part();
    const auto found = time_of.find(header(part.headers, "X-Frame-Number"));
    if (found == time_of.end()) continue;
    ++same;
    CHECK(found->second == header(part.headers, "X-Robot-Time"));
  }
  CHECK(same > 0);
  CHECK(whole_answer(world, "/camera/Camera.jpg?size=huge").find("?size=half") != std::string::npos);
}

TEST_CASE("Pictures need the token, and are not for other servers' pages") {
  ServedWorld world("0123456789abcdef");
  support::UsarsimClient program(world.usarsim_port());
  program.send(placed_robot("R1"));
  program.line_that_begins("STA");
  CHECK(whole_answer(world, "/camera/Camera.jpg").starts_with("HTTP/1.1 401"));
  CHECK(whole_answer(world, "/camera/Camera.mjpg?token=0").starts_with("HTTP/1.1 401"));
  CHECK(whole_answer(world, "/camera/Camera.jpg?token=0123456789abcdef").starts_with("HTTP/1.1 200"));
  CHECK(whole_answer(world, "/camera/Camera.jpg?token=0123456789abcdef", "Origin: http://evil.example\r\n")
            .starts_with("HTTP/1.1 403"));
  WebClient other(world.port());
  other.send("GET /camera/Camera.jpg?token=0123456789abcdef HTTP/1.1\r\nHost: evil.example\r\n\r\n");
  CHECK(other.answer().starts_with("HTTP/1.1 403"));
}

TEST_CASE("A browser that does not read misses pictures, and one that goes has none drawn") {
  ViewLimits limits;
  limits.pictures = 2;
  ServedWorld world("", limits);
  support::UsarsimClient program(world.usarsim_port());
  program.send(placed_robot("R1"));
  program.line_that_begins("STA");
  {
    Stream slow(world.port(), "/camera/Camera.mjpg", 4096), quick(world.port(), "/camera/Camera.mjpg");
    unsigned long newest = 0;
    for (int i = 0; i < 40; ++i) newest = std::stoul(header(quick.part().headers, "X-Frame-Number"));
    CHECK(whole_answer(world, "/camera/Camera.mjpg").starts_with("HTTP/1.1 503"));
    // what lay in the system's buffers is old; what comes behind it is not
    unsigned long number = std::stoul(header(slow.part().headers, "X-Frame-Number"));
    int parts = 1;
    while (number < newest) {
      number = std::stoul(header(slow.part().headers, "X-Frame-Number"));
      ++parts;
    }
    CHECK(parts < 40);
  }
  CHECK(support::eventually([&] { return world.cameras().newest().empty(); }));
}

TEST_CASE(
    "Who holds a robot turns and zooms its camera, and the state says where it looks and how old its picture is") {
  ServedWorld world;
  WebClient page(world.port());
  REQUIRE(page.open_websocket());
  CHECK(page.message_of("hello")["pictures"] == true);
  page.send_text(R"({"type":"place"})");
  const json inventory = [&] {
    for (;;) {
      json next = page.message_of("inventory");
      if (!next["robots"].empty()) return next;
    }
  }();
  const json about = inventory["robots"][0];
  CHECK(about["cameras"][0]["name"] == "Camera");
  CHECK(about["cameras"][0]["fov"] == json::array({0.1, 1.4}));
  CHECK(about["cameras"][0]["pan"] == json::array({-3.1416, 3.1416}));
  CHECK(about["cameras"][1]["name"] == "BirdsEye");
  CHECK_FALSE(about["cameras"][1].contains("pan"));
  page.send_text(
      json{{"type", "look"}, {"robot", about["id"]}, {"camera", "Camera"}, {"pan", 0.3}, {"tilt", 9}, {"fov", 0.5}}
          .dump());
  Stream stream(world.port(), "/camera/Camera.mjpg");
  for (;;) {
    const json camera = page.message_of("state")["robots"][0]["cameras"][0];
    if (camera["pan"] != 0.3 || camera["tilt"] != 1.5708 || camera["fov"] != 0.5 || !camera.contains("age")) continue;
    CHECK(camera["age"] >= 0.02);
    CHECK(camera["n"] >= 1);
    break;
  }
  page.send_text(json{{"type", "look"}, {"robot", about["id"]}, {"camera", "BirdsEye"}, {"pan", 0.3}}.dump());
  CHECK(page.message_of("refused")["request"] == "look");
}

TEST_CASE("Without cameras the page says so, and there are no pictures") {
  world_server::ServerOptions options;
  options.port = 0;
  world_server::WorldServer server(options);
  ViewOptions view_options;
  view_options.port = 0;
  View view(server, view_options);
  WebClient page(view.port()), other(view.port());
  REQUIRE(page.open_websocket());
  CHECK(page.message_of("hello")["pictures"] == false);
  other.send(get("/camera/Camera.mjpg"));
  CHECK(other.answer().starts_with("HTTP/1.1 404"));
}

}  // namespace kenaf::live
