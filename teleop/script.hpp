// An operator on paper: what he does at the keyboard, step by step, and what he waits to see. For tests, for training,
// and to play back what was noted of a drive. docs/operator.md explains every line.
//
//   # comment                        nothing
//   2.5 w                            presses key w once, 2.5 s after the script began
//   press 3                          presses a key once; "press + 2": twice
//   hold w for 1.5                   holds a key for so many seconds
//   hold w until x_mm > 940 within 8    ... until he sees that; gives up where robot time has run on by 8 s
//   wait 0.5
//   wait until mode is ready within 5
//   say at the step                  prints a line
//
// He holds a key as a keyboard does: pressed, then repeated after 0.4 s, 25 times a second. Where the console says that
// the robot halted and waits, he notices it after a second, lets go for half a second, and goes on. His own seconds are
// the wall clock's; `within` counts the robot's time, so that a slow simulation does not make him give up.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "desk.hpp"
#include "link.hpp"

namespace kenaf::teleop {

// "NAME > NUMBER", "NAME < NUMBER" or "mode is WORD".
struct Condition {
  std::string name;
  char comparison;  // '>', '<', or '=' for the mode
  double number;
  std::string word;
};
// False of what was not measured.
bool holds(const Condition& condition, const Status& status, const Desk& desk);

struct Step {
  enum class Kind { press, hold, wait, say } kind;
  int line;
  std::string text{};  // the key, or what is said
  int times = 1;
  double seconds = 0;  // for press: not before; otherwise: for so long, unless there is a condition
  std::optional<Condition> until{};
  double within_s = 0;
};
using Script = std::vector<Step>;

// Throws std::runtime_error that names line and fault.
Script read_script(std::string_view text);

// Plays a script. Times are seconds of one steady clock, beginning at the first call of turn().
class Player {
 public:
  explicit Player(Script script) : script_(std::move(script)) {}

  struct Turn {
    std::vector<Action> pressed{};
    std::vector<std::string> said{};
    bool finished = false;
    std::string failed{};  // line and what was waited for in vain; finished too
  };
  // `newest`: null before the first status, and again where none comes: `silent_s` then.
  Turn turn(double now_s, const Status* newest, double silent_s, const Desk& desk);

 private:
  void press_held(Action action, double now_s, const Status* newest, Turn& turn);
  void begin_step(double now_s);

  Script script_;
  std::size_t step_ = 0;
  double script_began_s_ = -1, step_began_s_ = 0;
  std::optional<double> step_began_robot_s_;
  std::optional<double> next_press_s_;  // of the key that is held
  std::optional<double> halt_seen_s_;
};

}  // namespace kenaf::teleop
