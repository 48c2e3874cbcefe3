// A script stands in for the operator and is turned by hand every 10 ms. A held key is pressed as a keyboard does, at
// once, after 0.4 s, then every 40 ms, and is let go at the end; `within` counts the robot's time, and silence has a
// limit of its own. After a halt the operator notices, lets go and presses again, and he sees nothing that was not
// measured. Lines that make no sense are refused with their number.
#include "teleop/script.hpp"

#include <catch2/catch.hpp>
#include <utility>
#include <vector>

using namespace kenaf::teleop;

namespace {

Status status_at(double robot_time_s, Mode mode = Mode::ready) {
  Status status{};
  status.session = 1;
  status.sequence = 1;
  status.mode = mode;
  status.halt = Halt::silence;
  status.robot_time_s = robot_time_s;
  status.fields = kHasPose | kHasPosture;
  return status;
}

std::string refusal(std::string_view text) {
  try {
    read_script(text);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("Every line is read") {
  const Script script = read_script(
      "# what an operator does\n\n2.5 w\npress + 2\r\nhold w for 1.5\n  hold s until x_mm > -940.5 within 8\nwait 0.5\n"
      "wait until mode is ready within 5\nsay at  the step");
  REQUIRE(script.size() == 7);
  CHECK(script[0].seconds == 2.5);
  CHECK(script[1].times == 2);
  CHECK(script[2].kind == Step::Kind::hold);
  CHECK(script[3].until->number == -940.5);
  CHECK(script[3].within_s == 8);
  CHECK(script[3].line == 6);
  CHECK(script[5].until->word == "ready");
  CHECK(script[6].text == "at  the step");
  CHECK(read_script("").empty());
}

TEST_CASE("What is none is refused with its line") {
  CHECK(refusal("press w\njump\n") == "line 2: 'jump' is neither press, hold, wait or say nor a time");
  CHECK(refusal("press y") == "line 1: the key 'y' has no meaning");
  CHECK(refusal("hold 3 for 1") == "line 1: the key '3' cannot be held");
  CHECK(refusal("hold w") == "line 1: 'for' or 'until' is missing");
  CHECK(refusal("hold w until z_mm > 1") == "line 1: 'within' is missing");
  CHECK(refusal("wait until height > 1 within 2") == "line 1: there is no value 'height'");
  CHECK(refusal("wait until mode is happy within 2") == "line 1: there is no mode 'happy'");
  CHECK(refusal("wait until x_mm >= 1 within 2") == "line 1: '>=' is neither '<' nor '>'");
  CHECK(refusal("wait nan") == "line 1: 'nan' is not a number (a time)");
  CHECK(refusal("wait 1 2") == "line 1: '2' is unexpected");
  CHECK(refusal("wait -1") == "line 1: a time of -1 s: 0 to 3600");
  CHECK(refusal("press w 0") == "line 1: a key is pressed 1 to 1000 times");
}

TEST_CASE("A held key repeats as a keyboard's, and is let go") {
  Player player(read_script("hold w for 0.6\n"));
  const Desk desk;
  std::vector<double> pressed_s;
  double now_s = 50;
  for (int i = 0; i < 100; ++i, now_s = 50 + 0.01 * i) {
    const Player::Turn turn = player.turn(now_s, nullptr, 0, desk);
    for (const Action action : turn.pressed) {
      if (action == Action::forward) pressed_s.push_back(now_s - 50);
    }
    if (!turn.finished) continue;
    CHECK(turn.pressed == std::vector{Action::stand});
    CHECK(turn.failed.empty());
    break;
  }
  CHECK(now_s == Approx(50.6).margin(0.011));
  REQUIRE(pressed_s.size() == 6);  // 0, 0.4, 0.44, 0.48, 0.52, 0.56
  CHECK(pressed_s[1] == Approx(0.4).margin(0.011));
  CHECK(pressed_s[5] == Approx(0.56).margin(0.031));  // turns of 10 ms round each period up
}

TEST_CASE("Conditions are asked of the newest status, within counts the robot's time") {
  const Desk desk;
  Player player(read_script("wait until nose_up_deg > 20 within 2\nsay up\n"));
  CHECK_FALSE(player.turn(0, nullptr, 0, desk).finished);
  Status status = status_at(100);
  CHECK_FALSE(player.turn(9, &status, 0, desk).finished);
  status = status_at(101.9);
  CHECK_FALSE(player.turn(500, &status, 0, desk).finished);  // ages on the wall: the simulation is slow
  status.posture_deg[1] = -20.5;                             // pitch is positive nose down
  const Player::Turn done = player.turn(501, &status, 0, desk);
  CHECK(done.finished);
  CHECK(done.said == std::vector<std::string>{"up"});

  Player late(read_script("\nwait until nose_up_deg > 20 within 2\n"));
  status = status_at(100);
  late.turn(0, &status, 0, desk);
  status = status_at(102.1);
  CHECK(late.turn(1, &status, 0, desk).failed ==
        "line 2: 'nose_up_deg > 20' was not seen within 2 s of the robot's time");

  Player alone(read_script("wait until mode is ready within 2\n"));
  CHECK(alone.turn(0, nullptr, 0, desk).failed.empty());
  CHECK(alone.turn(15.1, nullptr, 0, desk).failed == "line 1: no message from the robot for 15 s");
}

TEST_CASE("Flippers are there only once the control process has heard of them") {
  Desk desk;
  const Condition there{"flipper_off_deg", '<', 5, {}};
  Status status = status_at(1);
  status.fields = kHasFlippers;
  CHECK(holds(there, status, desk));
  desk.act(Action::posture_2, 0, &status);
  CHECK_FALSE(holds(there, status, desk));  // order 1 is on its way
  status.flipper_order = 1;
  status.flippers_commanded = 0b1111;
  status.flipper_deg = {20, 0, 0, 0};
  CHECK_FALSE(holds(there, status, desk));
  status.flipper_deg = {4, 0, 0, 0};
  CHECK(holds(there, status, desk));
}

TEST_CASE("Of what was not measured no condition holds") {
  const Desk desk;
  Status status = status_at(1);
  const auto holds_beside_zero = [&](const std::string& name) {
    return holds({name, '<', 1, {}}, status, desk) || holds({name, '>', -1, {}}, status, desk);
  };
  using Field = std::pair<const char*, std::uint32_t>;
  for (const auto& [name, field] :
       {Field{"x_mm", kHasPose}, Field{"x_mm", kHasEncoders}, Field{"y_mm", kHasEncoders}, Field{"z_mm", kHasPose},
        Field{"nose_up_deg", kHasPosture}, Field{"roll_deg", kHasPosture}, Field{"yaw_deg", kHasEncoders},
        Field{"track_mmps", kHasEncoders}, Field{"flipper_off_deg", kHasFlippers}, Field{"battery_v", kHasBattery}}) {
    INFO(name);
    status.fields = ~std::uint32_t{0} & ~field;
    if (std::string_view(name) == "x_mm" || std::string_view(name) == "y_mm") status.fields = 0;  // either will do
    CHECK_FALSE(holds_beside_zero(name));
    status.fields = field;
    CHECK(holds_beside_zero(name));
  }
  status.fields = 0;
  CHECK(holds({"time_s", '>', 0.5, {}}, status, desk));
}

TEST_CASE("After a halt he notices, lets go, and presses again") {
  const Desk desk;
  Player player(read_script("hold w for 10\n"));
  Status status = status_at(1, Mode::driving);
  double last_press_s = 0, pressed_again_s = 0;
  for (int i = 0; i < 400; ++i) {
    const double now_s = 0.01 * i;
    if (i == 100) status.mode = Mode::halted;                                // seen from 1 s on
    if (now_s > 1 && now_s > last_press_s + 0.4) status.mode = Mode::ready;  // the control process saw the key let go
    const Player::Turn turn = player.turn(now_s, &status, 0, desk);
    if (turn.pressed.empty()) continue;
    if (now_s > 1 && now_s > last_press_s + 0.3) pressed_again_s = now_s;
    last_press_s = now_s;
    if (pressed_again_s > 0) break;
  }
  CHECK(pressed_again_s == Approx(2.4).margin(0.05));  // a second to notice, then until the robot is ready
}

TEST_CASE("A condition after a press is asked once the press has been acted on") {
  Desk desk;
  Player player(read_script("press 3\nwait until flipper_off_deg < 5 within 5\nsay there\n"));
  Status status = status_at(1);
  status.fields = kHasFlippers;  // all at 0, as ordered so far: nothing
  const Player::Turn pressed = player.turn(0, &status, 0, desk);
  CHECK(pressed.pressed == std::vector{Action::posture_3});
  CHECK_FALSE(pressed.finished);
  for (const Action action : pressed.pressed) desk.act(action, 0, &status);
  CHECK_FALSE(player.turn(0.01, &status, 0, desk).finished);  // the order is on its way
  status.flipper_order = 1;
  status.flippers_commanded = 0b0011;  // of a robot with front flippers
  status.commanded_flipper_deg = {60, 60, -30, -30};
  CHECK_FALSE(player.turn(0.02, &status, 0, desk).finished);
  status.flipper_deg = {58, 57, 0, 0};
  const Player::Turn done = player.turn(0.03, &status, 0, desk);
  CHECK(done.finished);
  CHECK(done.said == std::vector<std::string>{"there"});
}

TEST_CASE("Presses one after another take a turn each, and the last one ends the script with it") {
  const Desk desk;
  Player player(read_script("press + 2\nhold w for 0\npress -\n"));
  CHECK(player.turn(0, nullptr, 0, desk).pressed == std::vector{Action::faster, Action::faster});
  CHECK(player.turn(0.01, nullptr, 0, desk).pressed == std::vector{Action::stand});
  const Player::Turn last = player.turn(0.02, nullptr, 0, desk);
  CHECK(last.pressed == std::vector{Action::slower});
  CHECK(last.finished);
}

TEST_CASE("Where there is no robot its time stands, and the wall's ends the wait") {
  const Desk desk;
  Status none = status_at(0, Mode::no_robot);
  none.message = text_of("HRT_E_LINK: nobody is there");
  for (const auto& [within_s, limit_s] : {std::pair{"20", 20.0}, {"5", 15.0}}) {
    Player player(read_script(std::string("wait until mode is ready within ") + within_s));
    CHECK_FALSE(player.turn(0, &none, 0, desk).finished);
    CHECK_FALSE(player.turn(limit_s, &none, 0, desk).finished);
    const Player::Turn turn = player.turn(limit_s + 0.1, &none, 0, desk);
    CHECK(turn.finished);
    CHECK(turn.failed == "line 1: 'mode is ready' was not seen, and there was no robot for " +
                             std::to_string(static_cast<int>(limit_s)) + " s: HRT_E_LINK: nobody is there");
  }
  // One that comes has its own time, from then on, and so has one that is opened anew.
  Player player(read_script("wait until mode is ready within 5"));
  player.turn(0, &none, 0, desk);
  const Status halted = status_at(4.9, Mode::halted), anew = status_at(0.1, Mode::halted);
  CHECK_FALSE(player.turn(14, &halted, 0, desk).finished);
  CHECK_FALSE(player.turn(40, &anew, 0, desk).finished);
  const Status late = status_at(5.2, Mode::halted);
  CHECK(player.turn(41, &late, 0, desk).failed ==
        "line 1: 'mode is ready' was not seen within 5 s of the robot's time");
}
