#include "driving.hpp"

#include <algorithm>
#include <cmath>

namespace kenaf::teleop {

namespace {

bool is_standing(Mode mode) {
  return mode != Mode::ready && mode != Mode::driving;
}

// Ramps towards `target`, through 0 if the direction changes.
double ramp(double speed, double target, double dt_s, const DrivingLimits& limits) {
  const bool speeds_up = speed * target >= 0 && std::abs(target) > std::abs(speed);
  const double step = (speeds_up ? limits.speed_up_mmps2 : limits.slow_down_mmps2) * dt_s;
  if (speed * target < 0) target = 0;
  return speed + std::clamp(target - speed, -step, step);
}

void next_mode(Driving& driving, const Situation& now, const Wish* wish, const DrivingLimits& limits) {
  const auto halt = [&](Halt why) {
    driving.mode = Mode::halted;
    driving.halt = why;
  };
  // The state before this turn; a wish of another session takes the robot over.
  const bool was_standing = is_standing(driving.mode);
  const bool another_console = wish != nullptr && wish->session != driving.session;
  if (another_console) driving.session = wish->session;

  // In order of priority: the latching emergency stop, the robot's link, a new console, the wish.
  if (now.emergency_pressed) {
    driving.mode = Mode::emergency_stop;
  } else if (driving.mode == Mode::emergency_stop) {
    if (wish != nullptr && wish->release_emergency && !wish->deadman && !another_console) halt(Halt::emergency);
  } else if (!now.robot_open) {
    driving.mode = Mode::no_robot;
  } else if (driving.mode == Mode::no_robot) {
    halt(driving.had_robot ? Halt::robot_lost : Halt::start);
  } else if (another_console) {
    halt(Halt::start);
    // No valid wish: the console is silent, or the operator's view was too old. A standing robot keeps its earlier
    // reason, unless the view is too old now.
  } else if (wish == nullptr) {
    const bool is_silent = !now.seat.wish || now.now_s - now.seat.heard_s > limits.silence_s;
    const bool is_late = !is_silent && std::isfinite(now.view_age_s);
    if (!was_standing || is_late) halt(is_silent ? Halt::silence : Halt::late);
    // A valid wish: a halt ends only with the dead-man released; from ready on the dead-man decides.
  } else if (!was_standing || !wish->deadman) {
    driving.mode = wish->deadman ? Mode::driving : Mode::ready;
  }
}

}  // namespace

Order decide(Driving& driving, const Situation& now, const DrivingLimits& limits) {
  const bool is_fresh = now.seat.wish && now.now_s - now.seat.heard_s <= limits.silence_s;
  const Wish* const wish = is_fresh && now.view_age_s <= limits.view_s ? &*now.seat.wish : nullptr;
  const Mode before = driving.mode;
  next_mode(driving, now, wish, limits);
  driving.had_robot |= now.robot_open;

  Order order{.stop = false, .move_flippers = false, .flipper_deg = {}, .track_mmps = {}};
  if (is_standing(driving.mode)) {
    order.stop = !is_standing(before);
    driving.track_mmps = {};
    if (now.seat.wish) driving.flipper_order = now.seat.wish->flipper_order;  // skipped
    return order;
  }
  if (is_standing(before)) driving.flipper_order = wish->flipper_order;
  if (wish->flipper_order != driving.flipper_order) {
    driving.flipper_order = wish->flipper_order;
    order.move_flippers = true;
    order.flipper_deg = wish->flipper_deg;
  }
  for (std::size_t i = 0; i < kTrackCount; ++i) {
    const double wanted = wish->deadman ? wish->track_mmps[i] : 0;
    const double target = std::clamp(wanted, -limits.max_track_mmps, limits.max_track_mmps);
    driving.track_mmps[i] = ramp(driving.track_mmps[i], target, now.robot_dt_s, limits);
  }
  order.track_mmps = driving.track_mmps;
  return order;
}

}  // namespace kenaf::teleop
