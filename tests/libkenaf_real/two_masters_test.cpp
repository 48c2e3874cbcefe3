// There is one master on a bus: whoever comes second is refused, also where the first one is busy starting; two that
// met nevertheless both stop.
#include <catch2/catch.hpp>

#include "hrt/error.hpp"
#include "tests/libkenaf_real/robot_on_bus.hpp"

using namespace kenaf;
using namespace kenaf::real;
using candrives::Sender;
using canopen::PowerState;
using std::chrono::milliseconds;

namespace {

// The shipped description's master_node.
const canopen::Frame kMastersHeartbeat = encode(canopen::Heartbeat{127, canopen::NmtState::operational});

bool is_boot_up(const canopen::Frame& frame) {
  const auto heartbeat = canopen::heartbeat_from(frame);
  return heartbeat && heartbeat->state == canopen::NmtState::boot_up;
}

struct Refusal {
  int code = HRT_OK;
  std::string text;
};
Refusal refusal_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const hrt::Error& error) {
    return {error.code(), error.what()};
  }
  return {};
}

}  // namespace

TEST_CASE("A master is heard from the end of its listening on, however long its nodes take to start") {
  RobotOnBus robot;
  robot.wire.alter = [&](canopen::Frame& frame, Sender sender) {
    return sender != Sender::slaves || !is_boot_up(frame) || robot.wire.now() > milliseconds(1000);
  };
  robot.open();
  // It listens for 0.1 s (master_silence_s). Another program that begins to listen later than that hears one within the
  // 20 ms between two heartbeats.
  canopen::Time last = milliseconds(80);
  for (const candrives::LoggedFrame& one : robot.wire.log()) {
    if (one.frame != kMastersHeartbeat || one.at > milliseconds(1100)) continue;
    CHECK(one.at - last <= milliseconds(22));
    last = one.at;
  }
  CHECK(last > milliseconds(1070));
}

TEST_CASE("A master that turns up while the nodes start, or the drives are enabled, ends the opening") {
  for (const canopen::Time when : {milliseconds(200), milliseconds(1300)}) {
    RobotOnBus robot;
    bool others_turn = false;
    robot.wire.alter = [&](canopen::Frame& frame, Sender sender) {
      if (robot.wire.now() > when && !std::exchange(others_turn, true)) robot.wire.send_as_other(kMastersHeartbeat);
      return sender != Sender::slaves || !is_boot_up(frame) || robot.wire.now() > milliseconds(1000);
    };
    const Refusal refusal = refusal_of([&] { robot.open(); });
    CHECK(refusal.code == HRT_E_REFUSED);
    CHECK_THAT(refusal.text, Catch::Contains("another program controls the robot") && Catch::Contains("node 127"));
    CHECK(robot.wire.now() < when + milliseconds(100));
  }
}

TEST_CASE("A SYNC without a master is named with what may keep it going") {
  RobotOnBus robot;
  robot.wire.start_sync(milliseconds(10));
  const Refusal refusal = refusal_of([&] { robot.open(); });
  CHECK(refusal.code == HRT_E_REFUSED);
  CHECK_THAT(refusal.text, Catch::Contains("there is already a SYNC on can0") && Catch::Contains("child process"));
}

TEST_CASE("A second master's heartbeat in the loop stops the robot at once") {
  RobotOnBus robot;
  robot.open();
  robot.run(50, drive_at(0.2, 0.2));
  robot.wire.send_as_other(kMastersHeartbeat);
  const Refusal loss = refusal_of([&] { robot.run(2, drive_at(0.2, 0.2)); });
  CHECK(loss.code == HRT_E_LINK);
  CHECK_THAT(loss.text, Catch::Contains("another program controls the robot"));
  // the quick stop is taken at the next SYNC, within 10 ms; from 0.2 m/s at 12.5 m/s^2 it takes 16 ms
  CHECK(robot.seconds_to_rest() <= 0.011 + 0.016);
  CHECK(robot.all_are(PowerState::quick_stop_active));
}
