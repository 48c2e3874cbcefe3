// Homing, in which the library moves flippers without being asked to by the program: it is watched as the loop is.
#include <catch2/catch.hpp>

#include "hrt/error.hpp"
#include "tests/libkenaf_real/changed_robot.hpp"
#include "tests/libkenaf_real/robot_on_bus.hpp"

using namespace kenaf;
using namespace kenaf::real;
using candrives::Sender;
using canopen::PowerState;
using std::chrono::milliseconds;

namespace {

// Onto the lower end of the range, at -pi rad, from 0 at 0.5 rad/s: 6 s.
std::string towards_switch() {
  std::string homing = kHomeHere;
  homing.replace(homing.find("37"), 2, "17").replace(homing.find("0.7"), 3, "-3.14");
  return homing;
}
ChangedRobot homed_by(const std::string& homing) {
  return ChangedRobot({{"\n[can.inclinometer]", homing + "\n[can.inclinometer]"}});
}

bool begins_homing(const canopen::Frame& frame, Sender sender) {
  return sender == Sender::master && frame.id >= 0x203 && frame.id <= 0x206 &&
         (canopen::get_unsigned(frame.data, 0, 2) & canopen::kControlNewSetPoint) != 0;
}

}  // namespace

TEST_CASE("A drive that fails while flippers are homed stops the others at once, and is named with its error") {
  const ChangedRobot description = homed_by(towards_switch());
  RobotOnBus robot(description.path());
  std::optional<canopen::Time> begun, failed;
  robot.wire.alter = [&](canopen::Frame& frame, Sender sender) {
    if (!begun && begins_homing(frame, sender)) begun = robot.wire.now();
    if (begun && !failed && sender == Sender::master && robot.wire.now() > *begun + milliseconds(500)) {
      failed = robot.wire.now();
      robot.wire.inject({candrives::FaultKind::error, 5, 0x2310});
    }
    return true;
  };
  try {
    robot.open();
    FAIL("it opened");
  } catch (const hrt::Error& error) {
    CHECK(error.code() == HRT_E_DEVICE);
    CHECK_THAT(error.what(), Catch::Contains("flipper rear left (node 5)") && Catch::Contains("0x2310"));
  }
  REQUIRE(failed);
  // seen with the next SYNC, commanded after it, executed at the one after that
  robot.wire.run_until(*failed + milliseconds(30));
  CHECK(robot.wire.now() <= *failed + milliseconds(40));
  for (const std::size_t i : {0u, 1u, 2u, 3u, 5u}) CHECK(robot.power(i) == PowerState::quick_stop_active);
}

TEST_CASE("Homing is not taken for done by what a drive says of the one before") {
  const ChangedRobot description = homed_by(towards_switch());
  RobotOnBus robot(description.path());
  std::optional<canopen::Time> begun;
  robot.wire.alter = [&](canopen::Frame& frame, Sender sender) {
    if (!begun && begins_homing(frame, sender)) begun = robot.wire.now();
    const bool is_state = sender == Sender::slaves && frame.id >= 0x183 && frame.id <= 0x186;
    if (is_state && begun && robot.wire.now() < *begun + milliseconds(80)) {
      const auto done = canopen::kStatusHomingAttained | canopen::kStatusTargetReached;
      canopen::put(frame.data, 0, 2, canopen::get_unsigned(frame.data, 0, 2) | static_cast<std::uint32_t>(done));
    }
    return true;
  };
  robot.open();
  for (const double angle_rad : robot.run(1, robot::Command{}).flipper_rad)
    CHECK(angle_rad == Approx(-3.14).margin(0.03));
  CHECK(robot.wire.now() > *begun + std::chrono::seconds(6));
}

TEST_CASE("A drive that takes the home offset the other way round is named, and opens with the description's key") {
  // Where offset_direction is -1, home then reads minus the offset: the simulated drives of that description do so.
  std::string negated = kHomeHere;
  const std::string key = "\noffset_direction = -1";
  negated.insert(negated.find("\nhome_rad"), key);
  const ChangedRobot plus = homed_by(kHomeHere), minus = homed_by(negated);
  for (const auto& [drives, description] : {std::pair(&minus, &plus), std::pair(&plus, &minus)}) {
    RobotOnBus robot(drives->path());
    std::snprintf(robot.config.robot, sizeof robot.config.robot, "%s", description->path().c_str());
    try {
      robot.open();
      FAIL("it opened");
    } catch (const hrt::Error& error) {
      CHECK(error.code() == HRT_E_DEVICE);
      CHECK_THAT(error.what(), Catch::Contains("flipper front left (node 3)") &&
                                   Catch::Contains("reports -0.700 rad") && Catch::Contains("not 0.700 rad") &&
                                   Catch::Contains("offset_direction"));
    }
  }
  RobotOnBus robot(minus.path());
  robot.open();
  for (const double angle_rad : robot.run(2, robot::Command{}).flipper_rad)
    CHECK(angle_rad == Approx(0.7).margin(1e-3));
}

TEST_CASE("Homing that moves is checked for the sign of the home offset") {
  std::string negated = towards_switch();
  negated.insert(negated.find("\nhome_rad"), "\noffset_direction = -1");
  const ChangedRobot plus = homed_by(towards_switch()), minus = homed_by(negated);
  RobotOnBus robot(minus.path());
  std::snprintf(robot.config.robot, sizeof robot.config.robot, "%s", plus.path().c_str());
  CHECK_THROWS_WITH(robot.open(), Catch::Contains("offset_direction"));
}
