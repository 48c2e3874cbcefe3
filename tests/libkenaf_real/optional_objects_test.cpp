// Drives that lack what CiA 402 leaves to them: the voltage of their supply (0x6079), their current (0x6078), its unit
// (0x6075).
#include <catch2/catch.hpp>

#include "hrt/error.hpp"
#include "robot/state.hpp"
#include "tests/libkenaf_real/changed_robot.hpp"
#include "tests/libkenaf_real/robot_on_bus.hpp"

using namespace kenaf;
using namespace kenaf::real;

namespace {

// The shipped robot with `keys` in its [can].
ChangedRobot robot_with(const std::string& keys) {
  return ChangedRobot({{"interface = \"can0\"", "interface = \"can0\"\n" + keys}});
}

std::string error_of_opening(RobotOnBus& robot) {
  try {
    robot.open();
  } catch (const hrt::Error& error) {
    return error.what();
  }
  return {};
}

}  // namespace

TEST_CASE("A robot whose drives do not measure voltage or current opens, and says what it does not know") {
  struct Case {
    std::string keys;
    std::uint32_t lacks;
  };
  for (const Case& one : {Case{"battery = false", robot::kHasBattery}, Case{"currents = false", robot::kHasCurrents},
                          Case{"battery = false\ncurrents = false", robot::kHasBattery | robot::kHasCurrents}}) {
    const ChangedRobot changed = robot_with(one.keys);
    RobotOnBus robot(changed.path());  // its simulated drives lack the objects, too
    robot.open();
    const robot::State state = robot.run(50, drive_at(0.2, 0.2));
    const std::uint32_t all =
        robot::kHasPosture | robot::kHasEncoders | robot::kHasFlippers | robot::kHasCurrents | robot::kHasBattery;
    CAPTURE(one.keys);
    CHECK((state.fields & all) == (all & ~one.lacks));
    CHECK(state.track_mps[0] == Approx(0.2).margin(1e-3));
    CHECK(state.track_a[0] == 0);
    CHECK(state.late_commands == 0);  // and no cycle waits for frames that do not come
    CHECK(robot.transport.round_trip_s() < 0.004);
  }
}

TEST_CASE("A drive that lacks what the description wants of it is refused with the key that does without") {
  const canopen::NodeId left_track = 1;
  for (const std::string key : {"battery", "currents"}) {
    const ChangedRobot lacking = robot_with(key + " = false");
    RobotOnBus robot(lacking.path());
    std::snprintf(robot.config.robot, sizeof robot.config.robot, "kenaf");
    CHECK_THAT(error_of_opening(robot), Catch::Contains("track left (node " + std::to_string(left_track) + ")") &&
                                            Catch::Contains("`" + key + " = false` in [can]"));
  }
}

TEST_CASE("Currents without the unit that they are in are none") {
  RobotOnBus robot;
  robot.wire.alter = [](canopen::Frame& frame, candrives::Sender) {
    // node 4's answer to reading 0x6075: "no such object", SDO abort 0x06020000
    if (frame.id == 0x584 && canopen::get_unsigned(frame.data, 1, 3) == 0x006075)
      frame.data = {0x80, 0x75, 0x60, 0x00, 0x00, 0x00, 0x02, 0x06};
    return true;
  };
  robot.open();
  CHECK((robot.run(1, robot::Command{}).fields & robot::kHasCurrents) == 0);
}
