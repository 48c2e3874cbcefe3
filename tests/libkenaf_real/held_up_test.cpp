// A program that is held up (SIGSTOP, a machine that swaps, a debugger) and goes on: what it says then to drives that
// have seen its heartbeat end.
#include <catch2/catch.hpp>

#include "hrt/error.hpp"
#include "robot/state.hpp"
#include "tests/libkenaf_real/changed_robot.hpp"
#include "tests/libkenaf_real/robot_on_bus.hpp"

using namespace kenaf;
using namespace kenaf::real;
using candrives::Sender;
using canopen::PowerState;
using std::chrono::milliseconds;

namespace {

// Controlwords that the master sends from now on, of any drive.
std::shared_ptr<std::vector<std::uint16_t>> watch_controlwords(RobotOnBus& robot) {
  auto words = std::make_shared<std::vector<std::uint16_t>>();
  robot.wire.alter = [words](canopen::Frame& frame, Sender sender) {
    if (sender == Sender::master && frame.id >= 0x201 && frame.id <= 0x206)
      words->push_back(static_cast<std::uint16_t>(canopen::get_unsigned(frame.data, 0, 2)));
    return true;
  };
  return words;
}

// Drives on after a pause that has ended the program's control: nothing but one quick stop for each drive is sent.
// Returns the error's words.
std::string words_of_loss(RobotOnBus& robot, bool has_state) {
  const auto words = watch_controlwords(robot);
  std::string said;
  try {
    if (has_state) robot.transport.send(drive_at(0.2, 0.2));
    robot.run(3, drive_at(0.2, 0.2));
    FAIL("it drives on");
  } catch (const hrt::Error& error) {
    CHECK(error.code() == HRT_E_LINK);
    said = error.what();
  }
  CHECK(*words == std::vector<std::uint16_t>(robot.description.drives.size(), canopen::kControlQuickStop));
  return said;
}

// From SYNC to SYNC, of the target that a drive has: the last one that came. In its units.
std::int32_t longest_step(const RobotOnBus& robot, std::uint16_t command_id) {
  std::int32_t longest = 0;
  std::optional<std::int32_t> newest, taken;
  for (const candrives::LoggedFrame& one : robot.wire.log()) {
    if (one.frame.id == command_id) newest = canopen::get_signed(one.frame.data, 2, 4);
    if (!is_sync(one.frame) || !newest) continue;
    longest = std::max(longest, std::abs(*newest - taken.value_or(*newest)));
    taken = newest;
  }
  return longest;
}

}  // namespace

TEST_CASE("A program that was held up for longer than its drives wait for it says nothing but quick stop") {
  // held up while it waits for a state, and between the state and its answer
  for (const bool has_state : {false, true}) {
    RobotOnBus robot;
    robot.open();
    robot.run(50, drive_at(0.2, 0.2));
    if (has_state) (void)robot.transport.wait_state();
    const canopen::Time begin = robot.wire.now();
    robot.wire.hold_up_until(begin + milliseconds(300));
    REQUIRE(robot.all_are(PowerState::quick_stop_active));
    CHECK_THAT(words_of_loss(robot, has_state),
               Catch::Contains("was held up for 0.3") && Catch::Contains("stopped by themselves"));
    for (const candrives::LoggedFrame& one : robot.wire.log())
      CHECK_FALSE((one.at > begin + milliseconds(100) && one.frame.id == 0x77f));
    robot.transport.close();
    robot.open();
    CHECK(robot.all_are(PowerState::operation_enabled));
  }
}

TEST_CASE("A computer that was suspended says nothing but quick stop when it wakes, however short it slept") {
  // while the program waits for a state, and between the state and its answer; for longer than the drives wait, and not
  for (const bool has_state : {false, true}) {
    for (const milliseconds slept : {milliseconds(5000), milliseconds(30)}) {
      RobotOnBus robot;
      robot.open();
      robot.run(50, drive_at(0.2, 0.2));
      if (has_state) (void)robot.transport.wait_state();
      robot.wire.suspend_until(robot.wire.now() + slept);
      const bool have_stopped = slept > milliseconds(100);
      CHECK(robot.all_are(have_stopped ? PowerState::quick_stop_active : PowerState::operation_enabled));
      CHECK_THAT(words_of_loss(robot, has_state),
                 Catch::Contains(have_stopped ? "this computer was suspended for 5.00 s"
                                              : "this computer was suspended for 0.03 s"));
      // the next session counts anew
      robot.transport.close();
      robot.open();
      CHECK(robot.all_are(PowerState::operation_enabled));
      robot.run(50, drive_at(0.2, 0.2));
    }
  }
}

TEST_CASE("A suspend while the robot is being opened ends the opening") {
  RobotOnBus robot;
  bool slept = false;
  robot.wire.alter = [&](canopen::Frame& frame, Sender sender) {
    // the first order to a drive: it is configured, and about to be enabled
    if (sender == Sender::master && frame.id == 0x201 && !slept) {
      slept = true;
      robot.wire.suspend_until(robot.wire.now() + milliseconds(300));
    }
    return true;
  };
  CHECK_THROWS_WITH(robot.open(), Catch::Contains("this computer was suspended for 0.30 s"));
}

TEST_CASE("A program that was held up for less than that goes on") {
  RobotOnBus robot;
  robot.open();
  robot.run(50, drive_at(0.2, 0.2));
  // the last heartbeat is 20 ms old at most, and the drives wait for 100 ms
  robot.wire.hold_up_until(robot.wire.now() + milliseconds(70));
  robot.run(10, drive_at(0.2, 0.2));
  CHECK(robot.all_are(PowerState::operation_enabled));
}

TEST_CASE("What was missed in a short hold-up is not made up for in one period") {
  const ChangedRobot cyclic({{"profile velocity", "cyclic velocity"}, {"profile position", "cyclic position"}});
  for (const bool has_state : {false, true}) {
    RobotOnBus robot(cyclic.path());
    robot.open();
    robot::Command command = drive_at(0.05, 0.05);
    command.flipper[0] = {robot::JointMode::angle, 1};
    const robot::State before = robot.run(30, command);  // full speed after 10: 1.5 rad/s / 15 rad/s^2 = 0.1 s
    command.track_speed_mps = {0.4, 0.4};
    if (has_state) (void)robot.transport.wait_state();
    robot.wire.hold_up_until(robot.wire.now() + milliseconds(60));
    if (has_state) robot.transport.send(command);
    const robot::State after = robot.run(10, command);
    // Full speed of the flipper is 0.015 rad a period, and the tracks' 5 m/s^2 are 0.05 m/s. An answer that was late
    // and the one after it may be in one period.
    const canbus::DriveUnits &flipper = robot.description.drives[2].units, &track = robot.description.drives[0].units;
    CHECK(longest_step(robot, 0x203) <= 2 * (0.015 * std::abs(flipper.counts_per_unit) + 1));
    CHECK(longest_step(robot, 0x201) <= 2 * (0.05 * std::abs(track.velocity_per_unit) + 1));
    CHECK(after.frame - before.frame >= 15);  // and the cycles that were missed are counted
  }
}
