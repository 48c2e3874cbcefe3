// The console's side is tested without terminal, clock and sockets. A key drives 0.6 s after it was pressed and 0.2 s
// after each repeat, speeds and directions add up to the wish, and nothing drives without the dead-man; a gamepad
// speaks by the kernel's layout, and its dead-man counts only once it was pressed anew. The emergency stop stays
// pressed until it is released, and the release is asked for until the latch is gone. A nudge starts from the angles
// sent last, after a halt from those the robot holds, and never from one that nobody knows; round trip and losses
// follow from the numbers in the datagrams.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstring>
#include <string>
#include <vector>

#include "teleop/desk.hpp"
#include "teleop/gamepad.hpp"
#include "teleop/keys.hpp"
#include "teleop/link_health.hpp"
#include "tests/support/process.hpp"

using namespace kenaf;
using namespace kenaf::teleop;

namespace {

Status status_in(Mode mode) {
  Status status{};
  status.session = 1;
  status.sequence = 1;
  status.mode = mode;
  status.halt = Halt::start;
  return status;
}

js_event event(unsigned type, unsigned number, int value) {
  // as the kernel writes it: u32 time, s16 value, u8 type, u8 number
  const unsigned char bytes[8] = {0,
                                  0,
                                  0,
                                  0,
                                  static_cast<unsigned char>(value & 0xff),
                                  static_cast<unsigned char>(value >> 8 & 0xff),
                                  static_cast<unsigned char>(type),
                                  static_cast<unsigned char>(number)};
  js_event out;
  static_assert(sizeof out == sizeof bytes);
  std::memcpy(&out, bytes, sizeof out);
  return out;
}

constexpr unsigned kButton = 1, kAxis = 2, kInitial = 0x80;

}  // namespace

TEST_CASE("A key is held by its repeats") {
  DriveKey key;
  CHECK_FALSE(key.held(10));
  key.press(Action::forward, 10);
  CHECK(key.held(10.59) == Action::forward);
  CHECK_FALSE(key.held(10.61));

  key.press(Action::forward, 20);
  key.press(Action::forward, 20.5);  // the first repeat
  CHECK(key.held(20.69) == Action::forward);
  key.press(Action::forward, 20.54);
  CHECK(key.held(20.73) == Action::forward);
  CHECK_FALSE(key.held(20.75));

  key.press(Action::forward, 30);
  key.press(Action::turn_left, 30.1);
  CHECK(key.held(30.69) == Action::turn_left);  // a press of its own, not a repeat
  key.let_go();
  CHECK_FALSE(key.held(30.2));
}

TEST_CASE("Keys have the meaning that the screen says, emergency needs no shift, its release does") {
  CHECK(action_of_key("w") == Action::forward);
  CHECK(action_of_key("up") == Action::forward);
  CHECK(action_of_key("page_down") == Action::backward_right);
  CHECK(action_of_key("e") == Action::emergency_stop);
  CHECK(action_of_key("E") == Action::emergency_stop);
  CHECK(action_of_key("X") == Action::release_emergency);
  CHECK_FALSE(action_of_key("x"));
  CHECK_FALSE(action_of_key("?"));
  CHECK_FALSE(action_of_key(""));
}

TEST_CASE("Keys and speed make the wish") {
  Desk desk;  // 200 mm/s
  CHECK_FALSE(desk.wish(10).deadman);
  desk.act(Action::forward, 10, nullptr);
  CHECK(desk.wish(10.1).deadman);
  CHECK(desk.wish(10.1).track_mmps == std::array{200.0, 200.0});
  desk.act(Action::faster, 10.1, nullptr);
  CHECK(desk.wish(10.1).track_mmps == std::array{300.0, 300.0});
  CHECK_FALSE(desk.wish(10.7).deadman);
  CHECK(desk.wish(10.7).track_mmps == std::array{0.0, 0.0});

  for (int i = 0; i < 9; ++i) desk.act(Action::faster, 11, nullptr);
  CHECK(desk.speed_mmps() == 400);
  for (int i = 0; i < 9; ++i) desk.act(Action::slower, 11, nullptr);
  CHECK(desk.speed_mmps() == 50);
  desk.act(Action::slower, 11, nullptr);
  desk.act(Action::faster, 11, nullptr);
  CHECK(desk.speed_mmps() == 100);

  desk.act(Action::turn_left, 12, nullptr);  // left: counter-clockwise, so the right track goes forward
  CHECK(desk.wish(12).track_mmps[kLeft] == Approx(-80));
  CHECK(desk.wish(12).track_mmps[kRight] == Approx(80));
  desk.act(Action::stand, 12, nullptr);
  CHECK_FALSE(desk.wish(12).deadman);
}

TEST_CASE("Space stands: flippers under way are ordered to stay where they are, and none is where none was ordered") {
  Desk desk;
  Status status{};
  status.mode = Mode::ready;
  status.fields = kHasFlippers;
  status.flipper_deg = {10, 20, 30, 181};
  desk.act(Action::stand, 10, &status);
  CHECK(desk.flipper_order() == 0);
  desk.act(Action::posture_2, 10, &status);
  desk.act(Action::stand, 10, &status);
  CHECK(desk.flipper_order() == 2);
  CHECK(desk.wish(10).flipper_deg == std::array{10.0, 20.0, 30.0, 180.0});  // 180: as far as it may be ordered
  CHECK(desk.posture() == "held");
  // what was not measured is not ordered
  status.fields = 0;
  desk.act(Action::stand, 10, &status);
  CHECK(desk.flipper_order() == 2);
}

TEST_CASE("A gamepad's sticks go before keys, and never beyond the speed") {
  Desk desk;
  desk.act(Action::forward, 10, nullptr);
  desk.set_sticks({.deadman = true, .forward = -0.5, .turn = 0});
  CHECK(desk.wish(10.1).track_mmps == std::array{-100.0, -100.0});
  desk.set_sticks({.deadman = true, .forward = 1, .turn = 1});
  // 1 - 0.8 and 1 + 0.8, divided by the larger: 1/9 and 1
  CHECK(desk.wish(10.1).track_mmps[kLeft] == Approx(200.0 / 9));
  CHECK(desk.wish(10.1).track_mmps[kRight] == Approx(200));
  desk.set_sticks({.deadman = false, .forward = 1, .turn = 1});
  CHECK(desk.wish(10.7).track_mmps == std::array{0.0, 0.0});
}

TEST_CASE("The emergency stop stays pressed until it is released") {
  Desk desk;
  desk.act(Action::forward, 10, nullptr);
  desk.act(Action::emergency_stop, 10.1, nullptr);
  desk.act(Action::forward, 10.2, nullptr);
  CHECK(desk.wish(10.2).emergency_stop);
  CHECK_FALSE(desk.wish(10.2).deadman);
  desk.hear(status_in(Mode::emergency_stop));
  CHECK(desk.wish(100).emergency_stop);

  desk.act(Action::release_emergency, 101, nullptr);
  CHECK_FALSE(desk.wish(101).emergency_stop);
  CHECK(desk.wish(101).release_emergency);
  desk.hear(status_in(Mode::emergency_stop));
  CHECK(desk.wish(102).release_emergency);  // it may have been lost
  desk.hear(status_in(Mode::halted));
  CHECK_FALSE(desk.wish(103).release_emergency);
}

TEST_CASE("Postures are ordered as they are, and nudges start from known angles") {
  Desk desk;
  Status status = status_in(Mode::ready);
  status.fields = kHasFlippers;
  status.flipper_deg = {10, 20, 30, 40};
  status.commanded_flipper_deg = {11, 0, 0, 0};
  status.flippers_commanded = 0b0001;
  desk.act(Action::front_left_up, 10, nullptr);
  CHECK(desk.wish(10).flipper_order == 0);  // nobody knows where they are

  desk.hear(status);
  desk.act(Action::front_left_up, 10, &status);
  desk.act(Action::rear_down, 10, &status);  // the status is old: it goes on from what was sent
  CHECK(desk.wish(10).flipper_order == 2);
  CHECK(desk.wish(10).flipper_deg == std::array{14.0, 20.0, 27.0, 37.0});
  desk.act(Action::posture_3, 10, &status);
  CHECK(desk.wish(10).flipper_deg == std::array{58.0, 58.0, -20.0, -20.0});
  CHECK(desk.wish(10).flipper_order == 3);

  // A halt on the way: the flippers stayed at 40, 40, 0, 0, and a nudge of one must not send the others on.
  status.mode = Mode::halted;
  desk.hear(status);
  status.mode = Mode::ready;
  status.commanded_flipper_deg = {40, 40, 0, 0};
  status.flippers_commanded = 0b1111;
  desk.hear(status);
  desk.act(Action::rear_right_up, 20, &status);
  CHECK(desk.wish(20).flipper_deg == std::array{40.0, 40.0, 0.0, 3.0});
}

TEST_CASE("A nudge does nothing while the angle of one flipper is not known") {
  Desk desk;
  Status status = status_in(Mode::ready);
  status.flippers_commanded = 0b0111;
  status.commanded_flipper_deg = {40, 40, 10, 0};
  desk.act(Action::front_up, 10, &status);  // the order names all four: the fourth would be sent to 0
  CHECK(desk.wish(10).flipper_order == 0);
  status.flippers_commanded = 0b1111;
  desk.act(Action::front_up, 10, &status);
  CHECK(desk.wish(10).flipper_deg == std::array{43.0, 43.0, 10.0, 0.0});
  status = status_in(Mode::ready);
  desk.act(Action::rear_up, 10, &status);  // from what was sent
  CHECK(desk.wish(10).flipper_order == 2);
}

TEST_CASE("A gamepad is read by the kernel's events") {
  GamepadState pad;
  CHECK_FALSE(pad.take(event(kButton | kInitial, 4, 1)));
  CHECK_FALSE(pad.sticks().deadman);  // held since before it was plugged in
  pad.take(event(kButton, 4, 0));
  pad.take(event(kButton, 4, 1));
  CHECK(pad.sticks().deadman);

  pad.take(event(kAxis, 1, -32767));  // the stick pushed away: the kernel's y points to the operator
  CHECK(pad.sticks().forward == Approx(1));
  pad.take(event(kAxis, 3, 32767));  // to the right: a turn to the right is negative
  CHECK(pad.sticks().turn == Approx(-1));
  pad.take(event(kAxis, 1, 3000));  // within what a stick rests at: 3000 / 32767 = 0.09
  CHECK(pad.sticks().forward == 0);
  pad.take(event(kAxis, 1, -32768));
  CHECK(pad.sticks().forward == Approx(1));

  CHECK(pad.take(event(kButton, 1, 1)) == Action::emergency_stop);
  CHECK_FALSE(pad.take(event(kButton, 1, 0)));
  CHECK_FALSE(pad.take(event(kButton | kInitial, 7, 1)));
  CHECK_FALSE(pad.take(event(kButton, 200, 1)));
  pad.take(event(kAxis, 7, -32767));
  CHECK(pad.cross() == Action::front_up);
  pad.take(event(kAxis, 7, 0));
  CHECK_FALSE(pad.cross());
}

TEST_CASE("A gamepad that was let go of while dead-man and cross are held does nothing until they are pressed anew") {
  GamepadState pad;
  pad.take(event(kButton, 4, 1));
  pad.take(event(kAxis, 1, -32767));
  pad.take(event(kAxis, 7, -32767));
  REQUIRE(pad.sticks().deadman);
  pad.let_go();
  CHECK_FALSE(pad.sticks().deadman);
  CHECK_FALSE(pad.cross());
  // the stick moves on, and the kernel may tell everything anew: both are still held
  pad.take(event(kAxis, 1, -30000));
  pad.take(event(kButton | kInitial, 4, 1));
  pad.take(event(kAxis | kInitial, 7, -32767));
  CHECK_FALSE(pad.sticks().deadman);
  CHECK_FALSE(pad.cross());
  pad.take(event(kButton, 4, 0));
  pad.take(event(kButton, 4, 1));
  CHECK(pad.sticks().deadman);
  CHECK(pad.sticks().forward > 0.9);  // where it is, 30000 / 32767
  pad.take(event(kAxis, 7, 0));
  pad.take(event(kAxis, 7, -32767));
  CHECK(pad.cross() == Action::front_up);
}

TEST_CASE("After dropped events what was let go of is let go of, and the emergency stop is not lost") {
  GamepadState pad;
  pad.take(event(kButton, 4, 1));
  pad.take(event(kAxis, 7, -32767));
  REQUIRE(pad.sticks().deadman);
  REQUIRE(pad.cross() == Action::front_up);
  // the kernel tells everything anew: the dead-man and A are still held, and so is the cross
  CHECK_FALSE(pad.take(event(kButton | kInitial, 0, 1)));
  CHECK_FALSE(pad.take(event(kButton | kInitial, 4, 1)));
  pad.take(event(kAxis | kInitial, 7, -32767));
  CHECK(pad.sticks().deadman);
  CHECK(pad.cross() == Action::front_up);
  // and once more: both were let go of, and B is pressed
  CHECK_FALSE(pad.take(event(kButton | kInitial, 4, 0)));
  pad.take(event(kAxis | kInitial, 7, 0));
  CHECK_FALSE(pad.sticks().deadman);
  CHECK_FALSE(pad.cross());
  CHECK(pad.take(event(kButton | kInitial, 1, 1)) == Action::emergency_stop);
  CHECK_FALSE(pad.take(event(kButton | kInitial, 1, 0)));
}

TEST_CASE("A gamepad that is unplugged while it drives lets go of the dead-man, plugged in again it counts anew") {
  // A pipe with a name gives the same bytes, and the same end, as a device that is unplugged.
  const support::TemporaryFolder folder;
  const std::string path = folder.path() / "js0";
  REQUIRE(::mkfifo(path.c_str(), 0600) == 0);
  Gamepad pad(path);
  const auto plug_in = [&] { return ::open(path.c_str(), O_RDWR | O_CLOEXEC); };
  const auto send = [](int device, const js_event& what) { return ::write(device, &what, sizeof what) == sizeof what; };

  int device = plug_in();
  REQUIRE(send(device, event(kButton, 4, 1)));
  REQUIRE(send(device, event(kAxis, 1, -32767)));
  REQUIRE(send(device, event(kButton, 0, 1)));
  REQUIRE(send(device, event(kAxis, 6, 32767)));
  CHECK(pad.read(10) == std::vector{Action::posture_2, Action::rear_up});
  CHECK(pad.name() == path);
  CHECK(pad.sticks().deadman);
  CHECK(pad.read(10.02).empty());
  CHECK(pad.read(10.06) == std::vector{Action::rear_up});  // the cross is held: as a key that repeats

  ::close(device);
  pad.read(10.1);
  CHECK_FALSE(pad.sticks().deadman);
  CHECK(pad.sticks().forward == 0);
  CHECK(pad.name().empty());

  device = plug_in();
  REQUIRE(send(device, event(kButton | kInitial, 4, 1)));
  pad.read(10.5);
  CHECK(pad.name().empty());  // looked for once a second
  pad.read(11.2);
  CHECK(pad.name() == path);
  CHECK_FALSE(pad.sticks().deadman);
  ::close(device);
}

TEST_CASE("A device that is none, or goes, leaves the dead-man let go") {
  Gamepad missing("/nonexistent/js0");
  CHECK(missing.read(10).empty());
  CHECK(missing.name().empty());
  Gamepad empty("/dev/null");  // opens, and is at its end as an unplugged one
  CHECK(empty.read(10).empty());
  CHECK(empty.name().empty());
  CHECK_FALSE(empty.sticks().deadman);
}

TEST_CASE("The round trip leaves out the time that the control process kept the wish") {
  LinkHealth health;
  Status status = status_in(Mode::ready);
  CHECK_FALSE(health.silence_s(10));
  health.sent(1, 10);
  health.sent(2, 10.05);
  status.newest_wish = 2;
  status.wish_age_s = 0.04;
  CHECK(health.heard(status, 10.29));
  CHECK(*health.round_trip_s() == Approx(0.2));  // 10.29 - 10.05 - 0.04
  CHECK(*health.silence_s(11) == Approx(0.71));
  CHECK_FALSE(health.heard(status, 10.3));  // the same again

  status.sequence = 2;  // no newer wish arrived: nothing new is known of the round trip
  status.wish_age_s = 1;
  CHECK(health.heard(status, 12));
  CHECK(*health.round_trip_s() == Approx(0.2));
  status.sequence = 3;
  status.newest_wish = 999;  // one that was never sent
  CHECK(health.heard(status, 12.1));
  CHECK(*health.round_trip_s() == Approx(0.2));
}

TEST_CASE("Statuses of a control process that was started again count, late ones of before do not") {
  LinkHealth health;
  Status status = status_in(Mode::ready);
  for (std::uint32_t i = 1; i <= 50; ++i) {
    health.sent(i, 10 + 0.05 * i);
    status.sequence = status.newest_wish = status.wishes_received = i;
    REQUIRE(health.heard(status, 10.01 + 0.05 * i));
  }
  status.sequence = status.newest_wish = 49;
  CHECK_FALSE(health.heard(status, 15));

  health.sent(51, 20);
  status.sequence = status.wishes_received = 1;
  status.newest_wish = 51;
  CHECK(health.heard(status, 20.1));
  CHECK(health.newest_status() == 1);
  CHECK(*health.round_trip_s() == Approx(0.1));
  CHECK(health.loss_up_percent() == 0);
  CHECK(health.loss_down_percent() == 0);
  CHECK_FALSE(health.heard(status, 20.2));  // the same again
  status.sequence = 2;
  CHECK(health.heard(status, 20.2));
}

TEST_CASE("Losses are counted over the last seconds") {
  LinkHealth health;
  Status status = status_in(Mode::ready);
  for (std::uint32_t i = 1; i <= 101; ++i) {
    health.sent(i, 10 + 0.02 * i);
    status.sequence = i;
    status.newest_wish = i;
    if (i % 10 != 0) ++status.wishes_received;            // each tenth wish is lost on the way up
    if (i % 5 != 0) health.heard(status, 10 + 0.02 * i);  // each fifth status on the way down
  }
  CHECK(health.loss_up_percent() == Approx(10));
  CHECK(health.loss_down_percent() == Approx(20));
}
