// A gamepad through Linux' joystick interface (/dev/input/js*, the kernel's
// Documentation/input/joydev/joystick-api.rst), plugged in and out at any time. Axes and buttons are those of the
// kernel's xpad driver.
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

// State derived from the gamepad's events. A dead-man held when the gamepad is plugged in counts only after it was
// released and pressed. The kernel reports all positions when the device is opened, and again if it had to drop unread
// events: then releases of dead-man and cross count, and a pressed emergency stop does.
class GamepadState {
 public:
  // Returns the action of a pressed button, if it has one.
  std::optional<Action> take(const js_event& event);
  // From now on dead-man and cross count only after they were released and pressed.
  void let_go();
  const Sticks& sticks() const { return sticks_; }
  std::optional<Action> cross() const { return cross_; }  // of the cross while it is held

 private:
  Sticks sticks_;
  std::optional<Action> cross_;
};

// The device: found, opened, read, and searched for again after it was unplugged. Thread safety: one thread.
class Gamepad {
 public:
  // `path`: the device; "" takes the first /dev/input/js*; "none" never looks.
  explicit Gamepad(std::string path);
  ~Gamepad();
  Gamepad(const Gamepad&) = delete;
  Gamepad& operator=(const Gamepad&) = delete;

  // Returns the actions since the last call. Without a device it searches for one, at most once a second; an unplugged
  // one leaves its sticks at rest and the dead-man released.
  std::vector<Action> read(double now_s);
  // As GamepadState::let_go(): for whoever stands the robot by other means than the gamepad.
  void let_go() { state_.let_go(); }
  const Sticks& sticks() const { return state_.sticks(); }
  const std::string& name() const { return name_; }  // "" if there is none

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
