// A gamepad by Linux' joystick interface (/dev/input/js*, the kernel's Documentation/input/joydev/joystick-api.rst):
// plugged in and out at any time. Axes and buttons are those of the kernel's xpad driver.
//
//   left shoulder (LB)   dead-man: hold it to drive        left stick up/down, right stick left/right   drive, turn
//   A  flat   X  climb front   Y  over the edge   right stick pressed  climb rear
//   cross up/down  front flippers    cross right/left  rear flippers up/down    (while the cross is held)
//   RB  faster   back  slower        B  emergency stop   start  releases it
#pragma once

#include <linux/joystick.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "desk.hpp"

namespace kenaf::teleop {

// What the gamepad's events add up to. A dead-man that is held when the gamepad is plugged in counts only once it
// was let go and pressed. The kernel tells where everything is when the device is opened, and again where it had to
// drop events because nobody read them: then a dead-man or a cross that is let go of counts, and a pressed emergency
// stop does.
class GamepadState {
 public:
  // The action of a button that was pressed, if it has one.
  std::optional<Action> take(const js_event& event);
  const Sticks& sticks() const { return sticks_; }
  std::optional<Action> cross() const { return cross_; }  // of the cross while it is held

 private:
  Sticks sticks_;
  std::optional<Action> cross_;
};

// The device: found, opened, read, and looked for again after it went. Thread safety: belongs to one thread.
class Gamepad {
 public:
  // `path`: the device; "" takes the first /dev/input/js*; "none" never looks.
  explicit Gamepad(std::string path);
  ~Gamepad();
  Gamepad(const Gamepad&) = delete;
  Gamepad& operator=(const Gamepad&) = delete;

  // What came since the last call. Without a device it looks for one, at most once a second; one that went leaves its
  // sticks at rest and the dead-man let go.
  std::vector<Action> read(double now_s);
  const Sticks& sticks() const { return state_.sticks(); }
  const std::string& name() const { return name_; }  // "" where there is none

 private:
  void open();
  void close();

  const std::string path_;
  int descriptor_ = -1;
  double look_again_s_ = 0, cross_again_s_ = 0;
  std::string name_;
  GamepadState state_;
};

}  // namespace kenaf::teleop
