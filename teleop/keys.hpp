// The meaning of each key, and the dead-man of a keyboard.
//
// A terminal reports that a key was pressed and, while it is held, repeats it; it never reports its release. So a
// driving key counts as held for `first_s` after it was pressed, which bridges the keyboard's initial delay, and for
// `repeat_s` after each repeat. With the defaults a robot stops at most 0.6 s after a short press and 0.2 s after the
// release of a held key (plus the link). A keyboard that starts repeating later than 0.6 s, or repeats less than five
// times a second, makes the robot stutter but never run on.
#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace kenaf::teleop {

enum class Action : unsigned char {
  forward,
  backward,
  turn_left,
  turn_right,  // these drive while they are held
  forward_left,
  forward_right,
  backward_left,
  backward_right,
  stand,
  emergency_stop,
  release_emergency,
  faster,
  slower,
  posture_1,
  posture_2,
  posture_3,
  posture_4,
  posture_5,
  posture_6,
  front_left_up,
  front_left_down,
  front_right_up,
  front_right_down,
  rear_left_up,
  rear_left_down,
  rear_right_up,
  rear_right_down,
  front_up,
  front_down,
  rear_up,
  rear_down,
  quit,
};
bool drives(Action action);

// Keys by name: a printable character itself, otherwise "space", "up", "down", "left", "right", "home", "end",
// "page_up", "page_down", "ctrl_c". nullopt: the key has no meaning.
std::optional<Action> action_of_key(std::string_view key);

struct KeyTiming {
  double first_s = 0.6;
  double repeat_s = 0.2;
};

// The key that drives. Times are seconds of one steady clock.
class DriveKey {
 public:
  explicit DriveKey(const KeyTiming& timing = {}) : timing_(timing) {}

  // A driving key arrived. The same key within its hold time is its repeat; another one replaces it, since a keyboard
  // repeats only the last key pressed.
  void press(Action action, double now_s);
  void let_go() { held_.reset(); }
  std::optional<Action> held(double now_s) const;

 private:
  KeyTiming timing_;
  std::optional<Action> held_;
  double until_s_ = 0;
};

}  // namespace kenaf::teleop
