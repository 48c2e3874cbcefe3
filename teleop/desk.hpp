// Combines the operator's inputs: from keys and gamepad to the wish that is sent. Plain state and functions; the caller
// passes the time, seconds of one steady clock.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "keys.hpp"
#include "link.hpp"
#include "postures.hpp"

namespace kenaf::teleop {

// The sticks of a gamepad: -1 to 1, forward and left positive.
struct Sticks {
  bool deadman = false;
  double forward = 0, turn = 0;
};

class Desk {
 public:
  explicit Desk(const KeyTiming& timing = {}, double speed_mmps = 200);

  // An action of keyboard, gamepad or script. `newest`: the control process' newest status, null before the first:
  // postures and nudges start from the last ordered flipper angles.
  void act(Action action, double now_s, const Status* newest);
  void set_sticks(const Sticks& sticks) { sticks_ = sticks; }
  // Must get every status: a halt discards earlier flipper orders, and a released latch needs no release any more.
  void hear(const Status& status);

  // The sender fills session, sequence and newest_status.
  Wish wish(double now_s) const;

  double speed_mmps() const { return speed_mmps_; }
  const std::string& posture() const { return posture_; }  // name of the last one ordered, or "by hand"
  std::uint32_t flipper_order() const { return flipper_order_; }
  bool emergency_pressed() const { return emergency_; }
  bool wants_to_quit() const { return quit_; }

 private:
  void nudge(unsigned flippers, double by_deg, const Status& newest);  // bit i: flipper i
  void hold_flippers(const Status& newest);
  void order_flippers(const std::array<double, kFlipperCount>& deg, std::string name);

  DriveKey key_;
  Sticks sticks_;
  double speed_mmps_;
  std::optional<std::array<double, kFlipperCount>> ordered_deg_;  // unless a halt came since then
  std::array<double, kFlipperCount> sent_deg_{};
  std::uint32_t flipper_order_ = 0;
  std::string posture_ = "not chosen";
  bool emergency_ = false, releasing_ = false, quit_ = false;
};

}  // namespace kenaf::teleop
