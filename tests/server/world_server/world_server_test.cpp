// The whole server through real sockets. No test depends on how fast this machine is.
#include "server/world_server/world_server.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <thread>

#include "robot/angles.hpp"
#include "tests/support/usarsim_client.hpp"

namespace kenaf::world_server {

namespace {

using support::number_in;
using support::UsarsimClient;

// A server in a thread of its own.
class Running {
 public:
  explicit Running(double speed, bool udk_dialect = false) : server_(options(speed, udk_dialect)) {
    thread_ = std::thread([this] { server_.run(); });
  }
  ~Running() {
    server_.stop();
    thread_.join();
  }
  std::uint16_t port() const { return server_.port(); }

 private:
  static ServerOptions options(double speed, bool udk_dialect) {
    ServerOptions chosen;
    chosen.port = 0;
    chosen.speed = speed;
    chosen.udk_dialect = udk_dialect;
    chosen.lockstep_wait_s = 60;  // on a busy machine the client's answer may take longer than it should
    return chosen;
  }
  WorldServer server_;
  std::thread thread_;
};

// A client that answers each frame with a command that depends on it; what it saw of its path.
std::vector<std::string> drive_by_frames(std::uint16_t port, int frames) {
  UsarsimClient client(port);
  client.line_that_begins("NFO");
  client.send(
      "CONTROL {Type Session} {Period 0.01} {Lockstep True} {Precision 15}\r\n"
      "INIT {ClassName USARBot.Kenaf} {Name R1} {Location 0,0,0}\r\n");
  std::vector<std::string> path;
  for (int frame = 1; frame <= frames; ++frame) {
    std::string line = client.line_that_begins("SEN");
    while (!line.starts_with("STA")) {
      if (line.find("GroundTruth") != std::string::npos) path.push_back(line);
      line = client.line();
    }
    REQUIRE(number_in(line, "Frame") == frame);
    REQUIRE(number_in(line, "Late") == 0);
    // closed loop: the right side follows where the robot looks
    const double yaw = robot::wrap_angle(number_in(path.back(), "Orientation", 2));
    client.send("DRIVE {Left 3} {Right " + std::to_string(2 + yaw) + "} {Frame " + std::to_string(frame) + "}\r\n");
  }
  return path;
}

}  // namespace

TEST_CASE("Half, double and full speed give the same path, bit for bit") {
  constexpr int kFrames = 60;
  const auto at = [](double speed) {
    Running server(speed);
    return drive_by_frames(server.port(), kFrames);
  };
  const auto full = at(0);
  REQUIRE(full.size() == kFrames);
  CHECK(at(0.5) == full);
  CHECK(at(2) == full);
}

TEST_CASE("A plain client of the UT2004 server drives a P2DX") {
  Running server(0);
  UsarsimClient client(server.port());
  CHECK(client.line() == "NFO {Gametype BotDeathMatch} {Level flat} {TimeLimit 20}");
  client.send("INIT {ClassName USARBot.P2DX} {Name R1} {Location 0,0,1.8}\r\nDRIVE {Left 1.0} {Right 1.0}\r\n");
  std::string truth;
  do {
    truth = client.line_that_begins("SEN {Time");
  } while (truth.find("GroundTruth") == std::string::npos || number_in(truth, "Time") < 3);
  CHECK(number_in(truth, "Location", 0) > 0.1);
  client.send("SET {Type Encoder} {Name ECLeft} {Opcode RESET}\r\n");
  CHECK(client.line_that_begins("RES").ends_with("{Status OK}"));
}

TEST_CASE("Sixteen robots share a world, each with a connection of its own") {
  Running server(0);
  std::vector<std::unique_ptr<UsarsimClient>> clients;
  for (int i = 0; i < 16; ++i) {
    clients.push_back(std::make_unique<UsarsimClient>(server.port()));
    clients.back()->send("INIT {ClassName USARBot.P2AT} {Name R" + std::to_string(i) + "} {Location 0," +
                         std::to_string(2 * i) + ",0}\r\nDRIVE {Left " + std::to_string(i % 4) + "} {Right " +
                         std::to_string(i % 4) + "}\r\n");
  }
  for (int i = 0; i < 16; ++i) {
    std::string truth;
    // the first after two seconds of this robot's life, whenever it began
    int seen = 0;
    while (seen < 12) {
      truth = clients[static_cast<std::size_t>(i)]->line_that_begins("SEN {Time");
      if (truth.find("GroundTruth") != std::string::npos) ++seen;
    }
    CHECK(number_in(truth, "Location", 1) == Approx(2 * i).margin(0.1));
    if (i % 4 == 0) CHECK(std::abs(number_in(truth, "Location", 0)) < 0.05);
    if (i % 4 != 0) CHECK(number_in(truth, "Location", 0) > 0.05);
  }
}

TEST_CASE("Closing the connection removes the robot, and its place is free again") {
  Running server(1);
  for (int i = 0; i < 3; ++i) {
    UsarsimClient client(server.port());
    client.send("INIT {ClassName USARBot.P2DX} {Name R}\r\n");
    std::string truth;
    while (truth.find("GroundTruth") == std::string::npos) truth = client.line_that_begins("SEN {Time");
    CHECK(number_in(truth, "Location", 1) ==
          0);  // the first start pose of share/worlds/flat.sdf; the second is at y = -2
  }
}

TEST_CASE("One client's flood and garbage do not keep the others from their frames") {
  Running server(0);
  UsarsimClient hostile(server.port());
  std::string garbage;
  for (int i = 0; i < 900; ++i) garbage += "\x01\xff{garbage\r\n";
  for (int i = 0; i < 200; ++i) garbage += std::string(500, 'x') + " {Type {{{\n";
  std::atomic<bool> stop = false;
  std::thread flood([&] {
    try {
      hostile.send(garbage);
      UsarsimClient flooder(server.port());
      while (!stop) flooder.send("DRIVE {Left 1}\r\nGETCONF {Type Robot}\r\nPING {Id 1}\r\n");
    } catch (const std::exception&) {  // it was let go, as it should be
    }
  });
  const auto path = drive_by_frames(server.port(), 100);
  CHECK(path.size() == 100);
  stop = true;
  flood.join();
}

TEST_CASE("A client that does not read is let go, and the others go on") {
  Running server(0);
  UsarsimClient deaf(server.port());
  deaf.send("INIT {ClassName USARBot.Kenaf} {Location 0,5,0}\r\nCONTROL {Type Session} {Period 0.001}\r\n");
  UsarsimClient other(server.port());
  other.send("INIT {ClassName USARBot.P2DX} {Location 0,0,0}\r\n");
  // 8 MiB beyond what the system's buffers hold are well below 20000 outputs of a kilobyte and more.
  double time_s = 0;
  while (time_s < 20) time_s = number_in(other.line_that_begins("STA"), "Time");
  const auto read_to_the_end = [&] {
    while (true) deaf.line();
  };
  CHECK_THROWS(read_to_the_end());
}

TEST_CASE("A server that is stopped closes its connections, and its port is free for the next") {
  auto server = std::make_unique<Running>(1);
  const std::uint16_t port = server->port();
  UsarsimClient client(port);
  client.line_that_begins("NFO");
  server.reset();
  CHECK_THROWS(client.line());
  ServerOptions options;
  options.port = port;
  WorldServer next(options);
  CHECK(next.port() == port);
}

TEST_CASE("What cannot be served is said in words") {
  Running server(1);
  ServerOptions options;
  options.port = server.port();
  CHECK_THROWS_WITH(WorldServer(options),
                    Catch::Contains("cannot listen on 127.0.0.1:" + std::to_string(server.port())));
  options = {};
  options.port = 0;
  options.listen_address = "nowhere at all";
  CHECK_THROWS_WITH(WorldServer(options), Catch::Contains("nowhere at all"));
  options = {};
  options.port = 0;
  options.world = "atlantis";
  CHECK_THROWS_WITH(WorldServer(options), Catch::Contains("atlantis"));
  options = {};
  options.port = 0;
  options.robot = "marvin";
  CHECK_THROWS_WITH(WorldServer(options), Catch::Contains("marvin"));
  options = {};
  options.port = 0;
  options.time_step_s = 0;
  CHECK_THROWS_WITH(WorldServer(options), Catch::Contains("time step"));
}

TEST_CASE("A server that was told to stop before it ran does not run") {
  ServerOptions options;
  options.port = 0;
  WorldServer server(options);
  server.stop();
  server.run();
  SUCCEED();
}

}  // namespace kenaf::world_server
