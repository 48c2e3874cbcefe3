// A scripted operator: actions at the keyboard, step by step, and what he waits to see. For tests, training, and
// replaying a noted drive. docs/operator.md explains every line.
//
//   # comment                        nothing
//   2.5 w                            presses key w once, 2.5 s after the script began
//   press 3                          presses a key once; "press + 2": twice
//   hold w for 1.5                   holds a key for so many seconds
//   hold w until x_mm > 940 within 8    ... until he sees that; gives up after 8 s of robot time
//   wait 0.5
//   wait until mode is ready within 5
//   say at the step                  prints a line
//
// He holds a key as a keyboard does: pressed, then repeated after 0.4 s, 25 times a second. If the console shows that
// the robot halted and waits, he notices after a second, releases for half a second, and continues. His own seconds are
// wall-clock time; `within` counts robot time, so that a slow simulation does not make him give up, and wall-clock
// time, 15 s at least, while there is no robot that has one.
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
// False if the quantity was not measured.
bool holds(const Condition& condition, const Status& status, const Desk& desk);

struct Step {
  enum class Kind { press, hold, wait, say } kind;
  int line;
  std::string text{};  // the key, or the text to print
  int times = 1;
  double seconds = 0;  // press: not before; otherwise: duration, unless there is a condition
  std::optional<Condition> until{};
  double within_s = 0;
};
using Script = std::vector<Step>;

// Throws std::runtime_error naming line and error.
Script read_script(std::string_view text);

// Plays a script. Times are seconds of one steady clock, beginning at the first call of turn().
class Player {
 public:
  explicit Player(Script script) : script_(std::move(script)) {}

  struct Turn {
    std::vector<Action> pressed{};
    std::vector<std::string> said{};
    bool finished = false;
    std::string failed{};  // line and the condition waited for in vain; also finished
  };
  // `newest`: null before the first status, and again when none arrives: then `silent_s` applies.
  Turn turn(double now_s, const Status* newest, double silent_s, const Desk& desk);

 private:
  void press_held(Action action, double now_s, const Status* newest, Turn& turn);
  void begin_step(double now_s);

  Script script_;
  std::size_t step_ = 0;
  double script_began_s_ = -1, step_began_s_ = 0;
  std::optional<double> step_began_robot_s_;
  std::optional<double> no_robot_since_s_;  // in this step, wall clock
  std::optional<double> next_press_s_;      // of the held key
  std::optional<double> halt_seen_s_;
};

}  // namespace kenaf::teleop
