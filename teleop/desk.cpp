#include "desk.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kenaf::teleop {

namespace {

constexpr std::array<double, 6> kSpeeds_mmps{50, 100, 150, 200, 300, 400};
constexpr double kTurnShare = 0.8;  // share of the speed, for a turn in place: tracks slip and tear up the ground
constexpr double kArcShare = 0.4;   // share of the speed, for the inner track of an arc

double next_speed(double speed_mmps) {
  const auto next = std::ranges::upper_bound(kSpeeds_mmps, speed_mmps);
  return next == kSpeeds_mmps.end() ? kSpeeds_mmps.back() : *next;
}

double speed_before(double speed_mmps) {
  const auto here = std::ranges::lower_bound(kSpeeds_mmps, speed_mmps);
  return here == kSpeeds_mmps.begin() ? kSpeeds_mmps.front() : *(here - 1);
}

// Shares of the speed: left, right.
std::array<double, kTrackCount> shares_of(Action action) {
  switch (action) {
    case Action::forward:
      return {1, 1};
    case Action::backward:
      return {-1, -1};
    case Action::turn_left:
      return {-kTurnShare, kTurnShare};
    case Action::turn_right:
      return {kTurnShare, -kTurnShare};
    case Action::forward_left:
      return {kArcShare, 1};
    case Action::forward_right:
      return {1, kArcShare};
    case Action::backward_left:
      return {-kArcShare, -1};
    case Action::backward_right:
      return {-1, -kArcShare};
    default:
      return {0, 0};
  }
}

// Both tracks within the speed, in the ratio requested by the sticks.
std::array<double, kTrackCount> shares_of(const Sticks& sticks) {
  const double turn = kTurnShare * sticks.turn;
  const double left = sticks.forward - turn, right = sticks.forward + turn;
  const double larger = std::max({1.0, std::abs(left), std::abs(right)});
  return {left / larger, right / larger};
}

}  // namespace

Desk::Desk(const KeyTiming& timing, double speed_mmps) : key_(timing), speed_mmps_(speed_mmps) {}

void Desk::act(Action action, double now_s, const Status* newest) {
  if (drives(action)) return key_.press(action, now_s);
  if (action >= Action::posture_1 && action <= Action::posture_6) {
    const Posture& posture = kPostures[static_cast<std::size_t>(action) - static_cast<std::size_t>(Action::posture_1)];
    return order_flippers(posture.flipper_deg, std::string(posture.name));
  }
  if (action >= Action::front_left_up && action <= Action::rear_right_down) {
    if (newest == nullptr) return;  // the flippers' positions are unknown
    const auto index = static_cast<std::size_t>(action) - static_cast<std::size_t>(Action::front_left_up);
    return nudge(1u << (index / 2), index % 2 == 0 ? kNudge_deg : -kNudge_deg, *newest);
  }
  constexpr unsigned kFront = 1u << kFrontLeft | 1u << kFrontRight, kRear = 1u << kRearLeft | 1u << kRearRight;
  switch (action) {
    case Action::front_up:
    case Action::front_down:
      if (newest != nullptr) nudge(kFront, action == Action::front_up ? kNudge_deg : -kNudge_deg, *newest);
      break;
    case Action::rear_up:
    case Action::rear_down:
      if (newest != nullptr) nudge(kRear, action == Action::rear_up ? kNudge_deg : -kNudge_deg, *newest);
      break;
    case Action::stand:
      key_.let_go();
      if (newest != nullptr) hold_flippers(*newest);
      break;
    case Action::emergency_stop:
      key_.let_go();
      emergency_ = true;
      releasing_ = false;
      break;
    case Action::release_emergency:
      emergency_ = false;
      releasing_ = true;
      break;
    case Action::faster:
      speed_mmps_ = next_speed(speed_mmps_);
      break;
    case Action::slower:
      speed_mmps_ = speed_before(speed_mmps_);
      break;
    case Action::quit:
      key_.let_go();
      quit_ = true;
      break;
    default:
      break;
  }
}

// Where they are now: an order under way ends here.
void Desk::hold_flippers(const Status& newest) {
  if (!ordered_deg_ || (newest.fields & kHasFlippers) == 0) return;
  std::array<double, kFlipperCount> deg = newest.flipper_deg;
  for (double& each : deg) each = std::clamp(each, -kMaxNudged_deg, kMaxNudged_deg);
  order_flippers(deg, "held");
}

void Desk::nudge(unsigned flippers, double by_deg, const Status& newest) {
  constexpr unsigned kAll = (1u << kFlipperCount) - 1;
  const bool all_commanded = (newest.flippers_commanded & kAll) == kAll;
  // the order names all four: a flipper at an unknown angle would be sent to 0
  if (!ordered_deg_ && !all_commanded && (newest.fields & kHasFlippers) == 0) return;
  std::array<double, kFlipperCount> deg{};
  for (std::size_t i = 0; i < kFlipperCount; ++i) {
    const bool was_commanded = (newest.flippers_commanded >> i & 1) != 0;
    deg[i] = ordered_deg_    ? (*ordered_deg_)[i]
             : was_commanded ? newest.commanded_flipper_deg[i]
                             : newest.flipper_deg[i];
    if ((flippers >> i & 1) != 0) deg[i] = std::clamp(deg[i] + by_deg, -kMaxNudged_deg, kMaxNudged_deg);
  }
  order_flippers(deg, "by hand");
}

void Desk::order_flippers(const std::array<double, kFlipperCount>& deg, std::string name) {
  ordered_deg_ = deg;
  sent_deg_ = deg;
  ++flipper_order_;
  posture_ = std::move(name);
}

void Desk::hear(const Status& status) {
  if (status.mode == Mode::halted || status.mode == Mode::emergency_stop || status.mode == Mode::no_robot) {
    ordered_deg_.reset();
  }
  if (status.mode != Mode::emergency_stop) releasing_ = false;
}

Wish Desk::wish(double now_s) const {
  Wish wish{};
  const std::optional<Action> key = key_.held(now_s);
  wish.emergency_stop = emergency_;
  wish.release_emergency = releasing_ && !emergency_;
  wish.deadman = !emergency_ && (sticks_.deadman || key.has_value());
  const auto shares = sticks_.deadman ? shares_of(sticks_) : key ? shares_of(*key) : std::array{0.0, 0.0};
  for (std::size_t i = 0; i < kTrackCount; ++i) wish.track_mmps[i] = wish.deadman ? shares[i] * speed_mmps_ : 0;
  wish.flipper_order = flipper_order_;
  wish.flipper_deg = sent_deg_;
  return wish;
}

}  // namespace kenaf::teleop
