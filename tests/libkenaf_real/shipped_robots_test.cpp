// Every shipped description of a real robot drives over a bus: docs/descriptions.md has the list.
#include <catch2/catch.hpp>

#include <filesystem>
#include <set>

#include "can/canbus/bus_layout.hpp"
#include "libkenaf_real/bus_cycle.hpp"
#include "robot/state.hpp"
#include "tests/libkenaf_real/robot_on_bus.hpp"

using namespace kenaf;
using namespace kenaf::real;
using canopen::PowerState;

namespace {

const std::set<std::string> kReal{"kenaf", "marmotte", "maxxii", "husky", "jackal", "warthog", "p2at", "p2dx", "p3at"};

}  // namespace

TEST_CASE("All shipped robots are real ones, with a bus, but UDK's") {
  std::set<std::string> shipped;
  for (const auto& entry : std::filesystem::directory_iterator(KENAF_SOURCE_DIR "/share/robots"))
    shipped.insert(entry.path().stem().string());
  shipped.erase("basicskidrobot");
  CHECK(shipped == kReal);
}

TEST_CASE("Each real robot opens, drives forward, turns, closes, and its sides stop in time without a master") {
  for (const std::string& name : kReal) {
    CAPTURE(name);
    RobotOnBus robot(name);
    robot.config.track_gauge_mm = 1e3 * robot.description.track_gauge_m;
    robot.open();
    REQUIRE(robot.all_are(PowerState::operation_enabled));
    CHECK(robot.transport.warning().empty());

    // 1.00 s at 0.2 m/s, less 0.2 / a * 0.2 / 2 for the ramp up, which the drives make
    const double way_m = 0.2 - 0.2 * 0.2 / (2 * robot.description.drives.front().acceleration);
    robot::State before = robot.run(1, drive_at(0.2, 0.2));
    robot::State after = robot.run(101, drive_at(0.2, 0.2));
    for (const std::size_t side : {robot::kLeft, robot::kRight}) {
      CHECK(after.track_m[side] - before.track_m[side] == Approx(way_m).margin(0.0004));
      CHECK(after.track_mps[side] == Approx(0.2).margin(1e-3));
      CHECK(robot.plant.state().track_mps[side] == Approx(0.2).margin(1e-3));
    }
    CHECK((after.fields & robot::kHasPosture) != 0);
    CHECK(after.battery_v == Approx(25.9));
    CHECK(((after.fields & robot::kHasFlippers) != 0) == (name == "kenaf"));

    after = robot.run(50, drive_at(-0.1, 0.1));
    CHECK(after.track_mps[robot::kLeft] == Approx(-0.1).margin(1e-3));
    CHECK(after.track_mps[robot::kRight] == Approx(0.1).margin(1e-3));

    // full speed takes up to 1.4 s; after the master's death all stand within what the description says
    const double full_mps = robot.description.drives.front().max_speed;
    robot.run(200, drive_at(full_mps, full_mps));
    CHECK(robot.plant.state().track_mps[0] == Approx(full_mps).epsilon(1e-3));
    robot.wire.stop_master();
    CHECK(robot.seconds_to_rest() <= robot.description.stop_within_s);
  }
}

TEST_CASE("Drives that lag behind their ramps are at rest when longest_stop_s says so") {
  for (const std::string& name : kReal) {
    CAPTURE(name);
    RobotOnBus robot(name);
    robot.config.track_gauge_mm = 1e3 * robot.description.track_gauge_m;
    robot.plant.speed_loop_s = robot.description.speed_loop_s;
    robot.open();
    const double full_mps = robot.description.drives.front().max_speed;
    robot.run(300, drive_at(full_mps, full_mps));
    CHECK(robot.plant.state().track_mps[0] == Approx(full_mps).epsilon(1e-3));
    robot.wire.stop_master();
    const double died_s = robot.seconds();
    while (std::abs(robot.plant.state().track_mps[0]) > canbus::kAtRest_mps && robot.seconds() < died_s + 3)
      robot.wire.run_until(robot.wire.now() + std::chrono::milliseconds(1));

    // The last heartbeat was up to 20 ms before the death; steps of 1 ms here, in the drives and in their plant.
    const double rest_s = robot.seconds() - died_s, longest_s = longest_stop_s(robot.description);
    CHECK(rest_s <= longest_s + 0.003);
    CHECK(rest_s >= longest_s - robot.description.master_heartbeat_s - 0.003);
  }
}

TEST_CASE("Every real robot's cycle at 100 Hz fits its bus with room for half as much again") {
  for (const std::string& name : kReal) {
    CAPTURE(name);
    const canbus::RobotBus bus = canbus::load_robot_bus(name);
    CHECK(canbus::worst_case_bits_per_s(bus, 0.01) < 0.5 * bus.bit_rate);
    CHECK_NOTHROW(check_period(bus, 0.01));
  }
}
