// Every way of losing control: who is named, how long the tracks still run, and how the robot comes back.
//
// Numbers by hand, for the shipped robot: the drives miss the master's heartbeat 0.1 s after its last one, which is
// sent each 20 ms; they stop from 0.2 m/s at 12.5 m/s^2 in 16 ms. So 0.116 s after the last heartbeat, and in no case
// more than 0.137 s after the master died.
#include <catch2/catch.hpp>

#include "hrt/error.hpp"
#include "hrt/estimate.hpp"
#include "robot/state.hpp"
#include "tests/libkenaf_real/robot_on_bus.hpp"

using namespace kenaf;
using namespace kenaf::real;
using candrives::Fault;
using candrives::FaultKind;
using canopen::PowerState;

namespace {

constexpr double kStop_s = 0.2 / 12.5;

// Drives forward until the loop ends with an error; the error, and how many cycles it took.
struct Loss {
  int code = 0;
  std::string text;
  int cycles = 0;
};
Loss drive_until_lost(RobotOnBus& robot, int at_most = 100) {
  Loss loss;
  try {
    for (; loss.cycles < at_most; ++loss.cycles) robot.run(1, drive_at(0.2, 0.2));
  } catch (const hrt::Error& error) {
    loss.code = error.code();
    loss.text = error.what();
  }
  return loss;
}

Loss opening(RobotOnBus& robot) {
  try {
    robot.open();
  } catch (const hrt::Error& error) {
    return {error.code(), error.what()};
  }
  return {};
}

void recover(RobotOnBus& robot) {
  robot.transport.close();
  robot.open();
  CHECK(robot.all_are(PowerState::operation_enabled));
  const double before_m = robot.plant.state().track_m[0];
  robot.run(50, drive_at(0.2, 0.2));
  CHECK(robot.plant.state().track_m[0] - before_m > 0.05);
}

}  // namespace

TEST_CASE("A master that dies, or hangs, stops the robot within 0.14 s") {
  for (int cycles = 30; cycles < 34; ++cycles) {  // at each moment between two heartbeats
    RobotOnBus robot;
    robot.open();
    robot.run(cycles, drive_at(0.2, 0.2));
    robot.wire.stop_master();
    const double rest_s = robot.seconds_to_rest();
    CAPTURE(cycles, rest_s);
    CHECK(rest_s >= 0.08 + kStop_s - 0.001);
    CHECK(rest_s <= 0.12 + kStop_s + 0.002);
    CHECK(robot.all_are(PowerState::quick_stop_active));
  }
}

TEST_CASE("A drive that falls silent is named, and the others stop at once") {
  for (std::size_t drive = 0; drive < canbus::load_robot_bus("kenaf").drives.size(); ++drive) {
    RobotOnBus robot;
    robot.open();
    robot.run(30, drive_at(0.2, 0.2));
    const canopen::NodeId node = robot.description.drives[drive].node;
    robot.wire.inject({FaultKind::silent, node});
    const Loss loss = drive_until_lost(robot);
    CHECK(loss.code == HRT_E_DEVICE);
    CHECK_THAT(loss.text, Catch::Contains(robot.description.drives[drive].name + " (node " + std::to_string(node) +
                                          ") has been silent for"));
    // 0.05 s of silence are five cycles
    CHECK(loss.cycles <= 6);
    // the silent one hears no heartbeat either, and stops by itself
    const double rest_s = robot.seconds_to_rest();
    CAPTURE(drive, rest_s);
    CHECK(0.05 + rest_s < 0.2);
    robot.wire.inject({FaultKind::healed, node});
    recover(robot);
  }
}

TEST_CASE("A drive in fault is named with its error, and the others stop at once") {
  RobotOnBus robot;
  robot.open();
  robot.run(30, drive_at(0.2, 0.2));
  robot.wire.inject({FaultKind::error, 5, 0x2310});
  const Loss loss = drive_until_lost(robot);
  CHECK(loss.code == HRT_E_DEVICE);
  CHECK_THAT(loss.text, Catch::Contains("flipper rear left (node 5)") && Catch::Contains("0x2310") &&
                            Catch::Contains("over current"));
  CHECK(loss.cycles <= 3);
  // the quick stop is taken at the next SYNC; 20 ms were waited for the emergency message meanwhile, 10 ms are a cycle
  CHECK(robot.seconds_to_rest() <= 0.011 + kStop_s);
  recover(robot);  // a fault reset is enough
}

TEST_CASE("A drive that lost its supply is named as restarted or silent, and comes back") {
  RobotOnBus robot;
  robot.open();
  robot.run(30, drive_at(0.2, 0.2));
  robot.wire.inject({FaultKind::power_loss, 2});
  const Loss loss = drive_until_lost(robot);
  CHECK(loss.code == HRT_E_DEVICE);
  CHECK_THAT(loss.text, Catch::Contains("track right (node 2)"));
  CHECK(robot.seconds_to_rest() < 0.15);
  recover(robot);
}

TEST_CASE("An interface that goes down ends the loop, and the drives stop by themselves") {
  RobotOnBus robot;
  robot.open();
  robot.run(30, drive_at(0.2, 0.2));
  robot.wire.go_down("CAN interface 'can0' went down: `ip link set can0 up`");
  const Loss loss = drive_until_lost(robot);
  CHECK(loss.code == HRT_E_LINK);
  CHECK(loss.cycles == 0);
  CHECK_THAT(loss.text, Catch::Contains("went down"));
  CHECK(robot.seconds_to_rest() <= 0.12 + kStop_s + 0.002);
  robot.transport.close();
  robot.wire.come_up();
  recover(robot);
}

TEST_CASE("An inclinometer or a gyro that falls silent takes the posture away, says so, and the robot goes on") {
  for (const auto& [node, name] :
       {std::pair<canopen::NodeId, std::string>{7, "inclinometer (node 7)"}, {8, "gyro (node 8)"}}) {
    RobotOnBus robot;
    robot.open();
    robot.run(10, drive_at(0.2, 0.2));
    robot.wire.inject({FaultKind::silent, node});
    robot::State state = robot.run(5, drive_at(0.2, 0.2));
    CHECK((state.fields & robot::kHasPosture) != 0);  // 0.1 s
    state = robot.run(10, drive_at(0.2, 0.2));
    CHECK((state.fields & robot::kHasPosture) == 0);
    CHECK_THAT(robot.transport.warning(), Catch::StartsWith(name + " is silent"));
    CHECK(state.track_mps[0] == Approx(0.2).margin(1e-3));
    robot.wire.inject({FaultKind::healed, node});
    state = robot.run(5, drive_at(0.2, 0.2));
    CHECK((state.fields & robot::kHasPosture) != 0);
    CHECK(robot.transport.warning().empty());
  }
}

TEST_CASE("A turn that is made while a sensor of the posture is silent counts, and counts once") {
  struct Case {
    int silent_cycles;
    double margin_rad;
  };
  // The posture is away after 0.1 s of silence, so for 0.2 and 0.5 s here. From 0.25 s on the heading is the tracks',
  // and the smoothing begins anew after it: it lags by 0.025 rad at this rate, and a cycle more is not seen.
  for (const Case& one : {Case{30, 0.01}, Case{60, 0.04}}) {
    for (const canopen::NodeId node : {canopen::NodeId{7}, canopen::NodeId{8}}) {
      RobotOnBus robot;
      robot.open();
      hrt::Estimator estimator({0.2, 1});
      hrt::Estimate now;
      const auto turn = [&](int cycles) {
        robot::State state{};
        for (int i = 0; i < cycles; ++i) {
          state = robot.run(1, drive_at(-0.05, 0.05));  // 0.5 rad/s at a gauge of 0.2 m
          now = estimator.update(state);
        }
        return state;
      };
      robot.plant.yaw_rate_radps = 0.5;
      turn(100);
      const double before_rad = now.heading_rad;
      robot.wire.inject({FaultKind::silent, node});
      CHECK((turn(one.silent_cycles).fields & robot::kHasPosture) == 0);
      robot.wire.inject({FaultKind::healed, node});
      CHECK((turn(150 - one.silent_cycles).fields & robot::kHasPosture) != 0);
      CAPTURE(one.silent_cycles, node);
      CHECK(now.heading_rad - before_rad == Approx(0.5 * 1.5).margin(one.margin_rad));
    }
  }
}

TEST_CASE("A drive that sends PDOs of the wrong length is as good as silent") {
  RobotOnBus robot;
  robot.open();
  robot.run(30, drive_at(0.2, 0.2));
  robot.wire.inject({FaultKind::short_pdos, 1});
  CHECK_THAT(drive_until_lost(robot).text, Catch::Contains("track left (node 1) has been silent for"));
}

TEST_CASE("A drive that does not act on controlwords is named as one that could not be enabled") {
  RobotOnBus robot;
  robot.wire.inject({FaultKind::deaf, 4});
  const Loss loss = opening(robot);
  CHECK(loss.code == HRT_E_DEVICE);
  CHECK_THAT(loss.text, Catch::Contains("flipper front right (node 4) could not be enabled") &&
                            Catch::Contains("switch on disabled"));
  CHECK(robot.stands());
}

TEST_CASE("Set-up names node, object and reason where SDO goes wrong") {
  struct Case {
    FaultKind kind;
    const char* says;
  };
  for (const Case& one : {Case{FaultKind::sdo_abort, "SDO abort"}, Case{FaultKind::sdo_late, "no answer"}}) {
    RobotOnBus robot;
    robot.wire.inject({one.kind, 3});
    const Loss loss = opening(robot);
    CHECK(loss.code == HRT_E_DEVICE);
    CHECK_THAT(loss.text, Catch::Contains("flipper front left (node 3)") && Catch::Contains("0x1000:00") &&
                              Catch::Contains(one.says));
    robot.wire.inject({FaultKind::healed, 3});
    robot.transport.close();
    robot.wire.run_until(robot.wire.now() + std::chrono::seconds(2));
    recover(robot);
  }
}

TEST_CASE("A node that is not there is named, and all that are missing with it") {
  RobotOnBus robot;
  robot.wire.inject({FaultKind::silent, 2});
  robot.wire.inject({FaultKind::silent, 7});
  const Loss loss = opening(robot);
  CHECK(loss.code == HRT_E_DEVICE);
  CHECK_THAT(loss.text, Catch::Contains("track right (node 2), inclinometer (node 7)"));
}
