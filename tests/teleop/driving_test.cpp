// The rules of who has the robot and how it is driven are tested without clock and sockets. Only the newest wish
// counts, and only where the operator saw the robot no longer ago than the limit; old and doubled wishes are dropped
// and are no sign of life, and silence stops tracks and flippers as soon as it reaches its limit, not before. After a
// start, a silence, a lost robot or a change of console nothing moves until the dead-man was seen released, and a
// second console waits until the first was silent for long enough or has left. The emergency stop latches, any console
// may press it, but only the one that drives releases it, with the dead-man let go; speeds are cut to the limit and
// follow the ramps, and a posture is carried out once, and never if it was ordered while the robot stood halted.
#include "teleop/driving.hpp"

#include <catch2/catch.hpp>
#include <limits>

using namespace kenaf::teleop;

namespace {

Wish wish_of(std::uint64_t session, std::uint32_t sequence, bool deadman = false, double speed_mmps = 0) {
  return {.session = session,
          .sequence = sequence,
          .newest_status = 0,
          .deadman = deadman,
          .emergency_stop = false,
          .release_emergency = false,
          .track_mmps = {speed_mmps, speed_mmps},
          .flipper_order = 0,
          .flipper_deg = {}};
}

// A control loop that is turned by hand, every 10 ms of its own time. Ramps of 1000 mm/s^2 up and 2000 down: 10 and
// 20 mm/s a turn.
struct Loop {
  Seat seat{};
  Driving driving{};
  DrivingLimits limits{.silence_s = 0.5, .max_track_mmps = 300, .speed_up_mmps2 = 1000, .slow_down_mmps2 = 2000};
  double now_s = 100;
  std::uint32_t sequence = 0;
  bool robot_open = true, emergency_pressed = false;
  double view_age_s = 0.2;

  Order turn() {
    now_s += 0.01;
    const Order order = decide(driving, {seat, emergency_pressed, robot_open, now_s, 0.01, view_age_s}, limits);
    emergency_pressed = false;
    return order;
  }
  Order turn(Wish wish) {
    wish.sequence = ++sequence;
    REQUIRE(admit(seat, wish, now_s, 2) == Admission::newest);
    emergency_pressed |= wish.emergency_stop;
    return turn();
  }
  Order idle() { return turn(wish_of(1, 0)); }
  Order drive(double speed_mmps = 200) { return turn(wish_of(1, 0, true, speed_mmps)); }
  void make_ready() {
    turn();
    idle();  // the first wish of a console only makes it known
    idle();
    REQUIRE(driving.mode == Mode::ready);
  }
  void reach(double speed_mmps) {
    for (int i = 0; i < 100; ++i) drive(speed_mmps);
    REQUIRE(driving.track_mmps[kLeft] == Approx(speed_mmps));
  }
};

const std::array<double, kTrackCount> kStand{0, 0};

}  // namespace

TEST_CASE("Only the newest wish counts") {
  Seat seat;
  CHECK(admit(seat, wish_of(1, 5, true, 100), 10, 2) == Admission::newest);
  CHECK(admit(seat, wish_of(1, 4, true, 200), 11, 2) == Admission::old);
  CHECK(admit(seat, wish_of(1, 5, true, 100), 11, 2) == Admission::old);
  CHECK(seat.wish->track_mmps[kLeft] == 100);
  CHECK(seat.heard_s == 10);  // they were no sign of life
  CHECK(seat.received == 3);  // but they arrived
  CHECK(admit(seat, wish_of(1, 9), 11.5, 2) == Admission::newest);
  CHECK(seat.heard_s == 11.5);
}

TEST_CASE("The robot is taken until its console was silent for long enough, or left") {
  Seat seat;
  CHECK(admit(seat, wish_of(1, 7), 10, 2) == Admission::newest);
  CHECK(admit(seat, wish_of(2, 1), 11.99, 2) == Admission::taken);
  CHECK(admit(seat, wish_of(1, 8), 11.99, 2) == Admission::newest);
  CHECK(admit(seat, wish_of(2, 2), 13.98, 2) == Admission::taken);
  CHECK(seat.wish->session == 1);
  CHECK(admit(seat, wish_of(2, 3), 14, 2) == Admission::newest);  // 2.01 s after the first one's last wish
  CHECK(seat.received == 1);
  CHECK(admit(seat, wish_of(1, 9), 14, 2) == Admission::taken);  // which comes too late

  leave(seat, 1);
  CHECK(seat.session == 2);  // not its seat to give up
  leave(seat, 2);
  CHECK(admit(seat, wish_of(2, 4), 14, 2) == Admission::old);  // its own Bye has overtaken it
  CHECK(admit(seat, wish_of(3, 1), 14, 2) == Admission::newest);
  CHECK(admit(seat, wish_of(2, 5), 20, 2) == Admission::old);
}

TEST_CASE("A console that begins with the dead-man held does not drive") {
  Loop loop;
  CHECK(loop.driving.mode == Mode::no_robot);
  for (int i = 0; i < 5; ++i) CHECK(loop.drive().track_mmps == kStand);
  CHECK(loop.driving.mode == Mode::halted);
  CHECK(loop.driving.halt == Halt::start);
  loop.idle();
  CHECK(loop.driving.mode == Mode::ready);
  CHECK(loop.drive().track_mmps[kRight] > 0);
  CHECK(loop.driving.mode == Mode::driving);
}

TEST_CASE("Silence stops the robot after 0.5 s, not before, and it goes on after the dead-man was let go") {
  Loop loop;
  loop.make_ready();
  loop.reach(200);
  // The newest wish is 10 ms old in the turn that took it. 48 turns later it is 0.49 s old: in time.
  for (int i = 0; i < 48; ++i) {
    const Order order = loop.turn();
    CHECK_FALSE(order.stop);
    CHECK(order.track_mmps[kLeft] == 200);
  }
  loop.now_s += 0.01;  // the next turn comes after 0.51 s
  const Order halt = loop.turn();
  CHECK(halt.stop);
  CHECK(halt.track_mmps == kStand);
  CHECK(loop.driving.mode == Mode::halted);
  CHECK(loop.driving.halt == Halt::silence);
  CHECK_FALSE(loop.turn().stop);  // once: each hrt_stop() takes the flippers' angle anew

  for (int i = 0; i < 10; ++i) CHECK(loop.drive().track_mmps == kStand);  // the link is back, the key still held
  CHECK(loop.driving.mode == Mode::halted);
  loop.idle();
  CHECK(loop.drive().track_mmps[kLeft] == Approx(10));  // from rest, by the ramp
}

TEST_CASE("A console that leaves stops the robot at once") {
  Loop loop;
  loop.make_ready();
  loop.reach(200);
  leave(loop.seat, 1);
  CHECK(loop.turn().stop);
}

TEST_CASE("A robot that was lost and found stands until the dead-man was let go") {
  Loop loop;
  loop.make_ready();
  loop.reach(200);
  loop.robot_open = false;
  CHECK(loop.drive().track_mmps == kStand);
  CHECK(loop.driving.mode == Mode::no_robot);
  loop.robot_open = true;
  CHECK(loop.drive().track_mmps == kStand);
  CHECK(loop.driving.halt == Halt::robot_lost);
  CHECK(loop.drive().track_mmps == kStand);
  loop.idle();
  CHECK(loop.drive().track_mmps != kStand);
}

TEST_CASE("Under another console it stands until that one's dead-man was let go") {
  Loop loop;
  loop.make_ready();
  loop.reach(200);
  loop.now_s += 3;  // but the loop did not run: it was held up as long
  Wish other = wish_of(2, 1, true, 200);
  REQUIRE(admit(loop.seat, other, loop.now_s, 2) == Admission::newest);
  const Order order = loop.turn();
  CHECK(order.stop);
  CHECK(order.track_mmps == kStand);
  CHECK(loop.driving.mode == Mode::halted);
}

TEST_CASE("The emergency stop latches") {
  Loop loop;
  loop.make_ready();
  loop.reach(200);
  Wish emergency = wish_of(1, 0, true, 200);
  emergency.emergency_stop = true;
  const Order order = loop.turn(emergency);
  CHECK(order.stop);
  CHECK(order.track_mmps == kStand);
  CHECK(loop.driving.mode == Mode::emergency_stop);

  // Neither a console that forgot it, nor silence, nor a robot opened anew releases it.
  loop.idle();
  loop.drive();
  loop.now_s += 10;
  loop.turn();
  loop.robot_open = false;
  loop.turn();
  loop.robot_open = true;
  loop.idle();
  CHECK(loop.driving.mode == Mode::emergency_stop);

  Wish release = wish_of(1, 0, true, 200);
  release.release_emergency = true;
  loop.turn(release);
  CHECK(loop.driving.mode == Mode::emergency_stop);  // not while the dead-man is held
  release.deadman = false;
  CHECK(loop.turn(release).track_mmps == kStand);
  CHECK(loop.driving.mode == Mode::halted);
  loop.idle();
  CHECK(loop.drive().track_mmps != kStand);
}

TEST_CASE("An emergency stop of a console without the robot counts, its release does not") {
  Loop loop;
  loop.make_ready();
  loop.reach(200);
  loop.emergency_pressed = true;  // how the control process passes on what a second console sent
  CHECK(loop.drive().stop);
  CHECK(loop.driving.mode == Mode::emergency_stop);

  // A console that takes over cannot release with its first wish, which may be one from long ago.
  leave(loop.seat, 1);
  Wish release = wish_of(2, 1);
  release.release_emergency = true;
  loop.sequence = 0;
  loop.turn(release);
  CHECK(loop.driving.mode == Mode::emergency_stop);
  loop.turn(release);
  CHECK(loop.driving.mode == Mode::halted);
}

TEST_CASE("Speeds are cut and follow the ramps, through rest where the direction changes") {
  Loop loop;
  loop.make_ready();
  CHECK(loop.drive(1000).track_mmps[kLeft] == Approx(10));
  CHECK(loop.drive(1000).track_mmps[kLeft] == Approx(20));
  for (int i = 0; i < 100; ++i) loop.drive(1000);
  CHECK(loop.driving.track_mmps[kLeft] == 300);
  CHECK(loop.drive(-1000).track_mmps[kLeft] == Approx(280));
  for (int i = 0; i < 14; ++i) loop.drive(-1000);
  CHECK(loop.driving.track_mmps[kLeft] == Approx(0).margin(1e-9));
  CHECK(loop.drive(-1000).track_mmps[kLeft] == Approx(-10));
  CHECK(loop.idle().track_mmps[kLeft] == Approx(0).margin(1e-9));  // let go: down to 0 within one step of 20
  CHECK(loop.driving.mode == Mode::ready);
}

TEST_CASE("Wishes made on an old view halt the robot, though they come without a gap") {
  Loop loop;
  loop.limits.view_s = 1;
  loop.make_ready();
  loop.reach(200);
  loop.view_age_s = 1;
  CHECK_FALSE(loop.drive().stop);
  loop.view_age_s = 1.01;
  CHECK(loop.drive().stop);
  CHECK(loop.driving.halt == Halt::late);
  loop.idle();
  CHECK(loop.driving.mode == Mode::halted);  // let go of, says a wish that is as old
  loop.view_age_s = 0.5;
  CHECK(loop.drive().track_mmps == kStand);
  loop.idle();
  CHECK(loop.drive().track_mmps != kStand);
}

TEST_CASE("A console that has seen nothing yet cannot drive, nor can what a dead one left in the network") {
  Loop loop;
  loop.view_age_s = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 5; ++i) {
    loop.idle();
    CHECK(loop.drive().track_mmps == kStand);
  }
  CHECK(loop.driving.mode == Mode::halted);
  CHECK(loop.driving.halt == Halt::start);
}

TEST_CASE("A posture is carried out once") {
  Loop loop;
  loop.make_ready();
  Wish posture = wish_of(1, 0);
  posture.flipper_order = 1;
  posture.flipper_deg = {58, 58, -20, -20};
  const Order order = loop.turn(posture);
  CHECK(order.move_flippers);
  CHECK(order.flipper_deg == posture.flipper_deg);
  CHECK_FALSE(loop.turn(posture).move_flippers);  // it is in every wish
  CHECK(loop.driving.flipper_order == 1);

  // Ordered during silence: it arrives with the first wish afterwards, and is passed over.
  loop.now_s += 1;
  CHECK(loop.turn().stop);
  posture.flipper_order = 2;
  CHECK_FALSE(loop.turn(posture).move_flippers);
  CHECK(loop.driving.mode == Mode::ready);
  CHECK_FALSE(loop.turn(posture).move_flippers);
  posture.flipper_order = 3;
  CHECK(loop.turn(posture).move_flippers);
}
