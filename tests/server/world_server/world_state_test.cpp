// What the simulation shows of itself to other threads.
#include "server/world_server/world_state.hpp"

#include <cmath>
#include <condition_variable>
#include <mutex>
#include <numbers>
#include <thread>

#include "server/world_server/manual_drive.hpp"
#include "server/world_server/world_server.hpp"
#include "tests/server/world_server/conversation.hpp"
#include "tests/support/patience.hpp"

namespace kenaf::world_server {

TEST_CASE("A state holds the clock, and each robot with its posture, its command and who gives it") {
  Conversation talk;
  talk.send("INIT {ClassName USARBot.Kenaf} {Name R1} {Location 1,-2,0}\r\nDRIVE {Left 3} {Right 3}\r\n");
  REQUIRE(talk.run(1));
  talk.simulation.set_paused(true);
  WorldState state;
  read_state(talk.simulation, state);
  CHECK(state.step == 1000);
  CHECK(state.time_s == Approx(1));
  CHECK(state.paused);
  CHECK(state.speed == 0);
  REQUIRE(state.robots.size() == 1);
  const RobotState& robot = state.robots.front();
  CHECK(robot.id == talk.session->id);
  CHECK(robot.name == "R1");
  CHECK(robot.class_name == "USARBot.Kenaf");
  const double speed_mps = 3 * 0.065;  // rad/s of a sprocket of that radius
  CHECK(robot.command.track_speed_mps[robot::kLeft] == Approx(speed_mps));
  CHECK(robot.track_mps[robot::kLeft] == Approx(speed_mps).epsilon(0.02));
  // share/robots/kenaf.toml: 0.3 A idle
  CHECK(robot.track_a[robot::kLeft] >= 0.3);
  CHECK(robot.X_WB.p.y() == Approx(2).margin(0.01));  // USARSim's y is to the right
  CHECK(robot.X_WB.p.x() > 1.1);
  CHECK(robot.flipper_rad[robot::kFrontLeft] == Approx(1.0).margin(0.02));
  CHECK(robot.client_silent_s == Approx(1));
  CHECK(robot.has_client);
  CHECK(robot.holder == OperatorId{0});
  CHECK(robot.dimensions.tracks.at(0).length_m == 0.58);

  REQUIRE(take_robot(talk.simulation, robot.id, OperatorId{9}).empty());
  read_state(talk.simulation, state);
  CHECK(state.robots.front().holder == OperatorId{9});
  CHECK(state.robots.front().command.track_speed_mps[robot::kLeft] == 0);
}

TEST_CASE("A state has contacts, scans and what an inertial sensor feels if they are asked for") {
  Conversation talk;
  // a wall 1 m before the robot's centre: its face is 0.95 m away
  talk.send(
      "CONTROL {Type Create} {ClassName Box} {Name wall} {Location 1,0,-0.5} {Scale 0.1,4,1}\r\n"
      "INIT {ClassName USARBot.Kenaf} {Name R1} {Location 0,0,0}\r\n");
  REQUIRE(talk.run(1));
  WorldState state;
  read_state(talk.simulation, state);
  REQUIRE(state.robots.size() == 1);
  CHECK(state.robots[0].contacts.empty());
  CHECK(state.robots[0].scans.empty());
  CHECK_FALSE(state.robots[0].inertial);

  read_state(talk.simulation, state, {false, {state.robots[0].id}});
  const RobotState& robot = state.robots[0];
  CHECK(robot.contacts.empty());
  REQUIRE(robot.inertial);
  CHECK((robot.inertial->a_W_mps2 - Eigen::Vector3d(0, 0, 9.80665)).norm() < 0.01);
  CHECK(robot.inertial->w_W_radps.norm() < 0.01);
  // share/robots/kenaf.toml: a scanner of 180 degrees at x = 0.15 m, a sonar at x = 0.22 m
  REQUIRE(robot.scans.size() == 2);
  const double scanner_x_m = robot.X_WB.p.x() + 0.15, sonar_x_m = robot.X_WB.p.x() + 0.22;
  const auto& ranges = robot.scans[0].range_m;
  REQUIRE(ranges.size() == kMostScanRays);
  CHECK(ranges[kMostScanRays / 2] == Approx(0.95 - scanner_x_m).margin(2e-3));
  CHECK(ranges[68] == Approx((0.95 - scanner_x_m) / std::cos(std::numbers::pi * (0.5 - 68 / 90.0))).margin(4e-3));
  CHECK(std::isinf(ranges.front()));  // along the wall
  CHECK(robot.scans[1].sonar);
  CHECK(robot.scans[1].range_m[0] == Approx(0.95 - sonar_x_m).margin(2e-3));

  read_state(talk.simulation, state, {true, {}});
  CHECK_FALSE(state.robots[0].contacts.empty());
  CHECK(state.robots[0].scans.empty());
  CHECK_FALSE(state.robots[0].inertial);
}

TEST_CASE("A state shows the boxes that may move: loose ones of the world, and those that clients made") {
  ServerOptions options = fast();
  options.world = "boxes";
  Conversation talk(options);
  std::size_t loose = 0;
  for (const physics::Box& box : talk.simulation.world.description().boxes) loose += box.mass_kg > 0 ? 1 : 0;
  talk.send("CONTROL {Type Create} {ClassName Box} {Name b} {Location 0,0,-1} {Scale 0.1,0.2,0.3}\r\n");
  WorldState state;
  read_state(talk.simulation, state);
  REQUIRE(state.boxes.size() == loose + 1);
  CHECK(state.boxes.back().size_m == Eigen::Vector3d(0.1, 0.2, 0.3));
  CHECK(state.boxes.back().X_WBox.p.z() == Approx(1));
  talk.send("CONTROL {Type Kill} {Name b}\r\n");
  read_state(talk.simulation, state);
  CHECK(state.boxes.size() == loose);
}

TEST_CASE("Another thread is answered by the world's thread, also while time stands still") {
  ServerOptions options = fast();
  options.port = 0;
  WorldServer server(options);
  std::thread world([&] { server.run(); });
  std::mutex mutex;
  std::condition_variable changed;
  std::uint64_t steps = 1;
  bool answered = false;
  const auto ask = [&] {
    answered = false;
    server.ask([&](Simulation& simulation) {
      const std::lock_guard lock(mutex);
      steps = simulation.world.step_count();
      std::uint32_t robot = 0;
      if (simulation.robot_count() == 0) CHECK(place_robot_by_hand(simulation, OperatorId{1}, robot).empty());
      answered = true;
      changed.notify_one();
    });
    std::unique_lock lock(mutex);
    return changed.wait_for(lock, support::patience(), [&] { return answered; });
  };
  CHECK(ask());
  CHECK(steps == 0);
  CHECK(ask());
  server.stop();
  world.join();
  server.ask([](Simulation&) { FAIL("the world's thread has ended"); });
}

}  // namespace kenaf::world_server
