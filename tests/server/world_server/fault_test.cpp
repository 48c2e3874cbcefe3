// What a client and the log receive about a robot whose simulation failed. World: an island of 4 m by 4 m and nothing
// around it.
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <sstream>

#include "tests/formats/runs/temporary_folder.hpp"
#include "tests/server/world_server/conversation.hpp"

namespace kenaf::world_server {

namespace {

constexpr const char* kIsland = R"(<sdf version="1.9"><world name="island">
  <gravity>0 0 -9.80665</gravity>
  <frame name="start_00"><pose>0 0 0 0 0 0</pose></frame>
  <model name="box"><static>true</static><pose>0 0 -0.5 0 0 0</pose><link name="link"><collision name="collision">
    <geometry><box><size>4 4 1</size></box></geometry></collision></link></model>
</world></sdf>)";

// sqrt(2 * 100 m / g) = 4.516 s, from 10 m beside the island
constexpr double kFall_s = 4.6;
const std::string kInitBeside = "INIT {ClassName USARBot.Kenaf} {Name R1} {Location 10,0,0}\r\n";

struct Island {
  test::TemporaryFolder folder;
  std::ostringstream log;
  std::shared_ptr<spdlog::logger> before = spdlog::default_logger();

  Island() {
    test::write_file(folder / "island.sdf", kIsland);
    spdlog::set_default_logger(
        std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_mt>(log)));
  }
  ~Island() { spdlog::set_default_logger(before); }
  Island(const Island&) = delete;
  Island& operator=(const Island&) = delete;

  ServerOptions options(bool udk = false) const {
    ServerOptions options = fast(udk);
    options.world = (folder / "island.sdf").string();
    return options;
  }
  int errors_logged() const {
    int count = 0;
    std::istringstream lines(log.str());
    for (std::string line; std::getline(lines, line);) count += line.find("[error]") != std::string::npos;
    return count;
  }
};

std::vector<std::string> starting(std::vector<std::string> lines, std::string_view start) {
  std::erase_if(lines, [start](const std::string& line) { return !line.starts_with(start); });
  return lines;
}

}  // namespace

TEST_CASE("A robot that leaves the world: one line in the log, one RES, and outputs that go on in numbers") {
  const bool udk = GENERATE(false, true);
  const Island island;
  Conversation client(island.options(udk));
  client.send(kInitBeside);
  REQUIRE(client.run(kFall_s));
  const auto before = client.lines();
  const auto reports = starting(before, "RES");
  REQUIRE(reports.size() == 1);
  CHECK(reports[0].ends_with("{Type Robot} {Name R1} {Status Failed}"));
  CHECK(island.errors_logged() == 1);
  CHECK(island.log.str().find("robot R1 failed: it left the world") != std::string::npos);

  REQUIRE(client.run(1));
  const auto after = client.lines();
  CHECK(starting(after, "RES").empty());
  CHECK(island.errors_logged() == 1);
  // a plain client's messages are what they always were: the same types and groups
  const auto status = starting(after, "STA");
  CHECK(status.size() == (udk ? 10 : 5));
  CHECK(status.back().find("Fault") == std::string::npos);
  for (const std::string& line : after) CHECK(line.find("nan") == std::string::npos);
}

TEST_CASE("A client with a Session reads the fault in every STA, until the robot is moved back and begins anew") {
  const Island island;
  Conversation client(island.options());
  client.send("CONTROL {Type Session} {Period 0.1}\r\n" + kInitBeside);
  client.send("DRIVE {Left 3} {Right 3}\r\n");
  REQUIRE(client.run(kFall_s));
  const auto lines = client.lines();
  CHECK(starting(lines, "RES").back().find("{Status Failed} {Reason it left the world: ") != std::string::npos);
  CHECK(starting(lines, "STA").back().find("{Fault it left the world: ") != std::string::npos);

  client.send("CONTROL {Type AbsMove} {Name R1} {Location 0,0,0}\r\n");
  REQUIRE(client.run(1));
  CHECK(client.last("STA").find("Fault") == std::string::npos);
  CHECK(client.truth().X_WB.p.head<2>().norm() < 1e-3);  // at rest: the command before the fault is forgotten
  client.send("DRIVE {Left 3} {Right 3}\r\n");
  REQUIRE(client.run(1));
  CHECK(client.truth().X_WB.p.x() > 0.1);

  // and each fault is reported anew
  client.send("CONTROL {Type AbsMove} {Name R1} {Location 10,0,0}\r\n");
  client.lines();
  REQUIRE(client.run(kFall_s));
  CHECK(client.lines("RES").size() == 1);
  CHECK(island.errors_logged() == 2);
}

TEST_CASE("A reset starts a failed robot again") {
  const Island island;
  Conversation client(island.options());
  client.send("CONTROL {Type Session} {Period 0.1}\r\n" + kInitBeside);
  REQUIRE(client.run(kFall_s));
  CHECK(client.last("STA").find("Fault") != std::string::npos);
  client.send("CONTROL {Type Reset}\r\n");
  client.simulation.advance(client.wall_s);
  const std::string status = client.last("STA");
  CHECK(status.find("Fault") == std::string::npos);
  CHECK(number_in(status, "Time") == 0);
}

TEST_CASE("A robot whose simulation went wrong keeps no other from driving") {
  const Island island;
  Conversation client(island.options());
  client.send(kInitBeside);
  Session& neighbour = client.simulation.connect("neighbour");
  client.send(neighbour, "INIT {ClassName USARBot.Kenaf} {Name R2} {Location 0,0,0}\r\n");
  REQUIRE(client.run(kFall_s));
  client.lines(neighbour);
  client.send(neighbour, "DRIVE {Left 3} {Right 3}\r\n");
  REQUIRE(client.run(1));
  CHECK(starting(client.lines(neighbour), "RES").empty());
  CHECK(client.simulation.world.truth(neighbour.robot->id).X_WB.p.x() > 0.1);
}

}  // namespace kenaf::world_server
