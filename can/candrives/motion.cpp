#include "can/candrives/motion.hpp"

#include <algorithm>
#include <cmath>

#include "can/candrives/drive_objects.hpp"

namespace kenaf::candrives {

using canopen::DriveMode;
using canopen::MappedObject;

namespace {

constexpr double kNoWindow = 0xffffffff;
constexpr std::uint16_t kControlRelative = 1 << 6;  // profile position: relative to the previous target
constexpr std::uint16_t kStatusOfMode = 1 << 12;    // bit 12, whose meaning depends on the mode

}  // namespace

void Motion::reset(const Measured& motor, std::int64_t offset) {
  offset_ = offset;
  controlword_ = 0;
  begin(motor);
}

void Motion::begin(const Measured& motor) {
  demand_ = {motor.position, 0};
  internal_limit_ = acknowledged_ = cyclic_target_ = false;
  set_point_.reset();
  next_set_point_.reset();
  homing_.abandon();
}

void Motion::set_mode(DriveMode mode, const Measured& motor) {
  if (mode == mode_) return;
  const double speed = demand_.velocity;
  begin(motor);
  demand_.velocity = speed;  // the new mode continues from it
  mode_ = mode;
}

void Motion::on_controlword(std::uint16_t controlword, bool enabled, const Measured& motor) {
  const bool was_set = (controlword_ & canopen::kControlNewSetPoint) != 0;
  const bool is_set = (controlword & canopen::kControlNewSetPoint) != 0;
  controlword_ = controlword;
  if (!is_set) acknowledged_ = false;
  if (!enabled || was_set == is_set) return;
  if (mode_ == DriveMode::profile_position && is_set) take_set_point();
  if (mode_ != DriveMode::homing) return;
  if (is_set) {
    homing_.start(
        {static_cast<std::int64_t>(number(object::homing_method)), velocity(object::homing_speed_switch),
         velocity(object::homing_speed_zero), acceleration(object::homing_acceleration), scale_.homing_max_lag},
        motor.position);
  } else if (homing_.is_moving()) {
    homing_.abandon();
  }
}

void Motion::take_set_point() {
  double target = number(object::target_position) - static_cast<double>(offset_);
  if ((controlword_ & kControlRelative) != 0) {
    target =
        number(object::target_position) + (next_set_point_ ? *next_set_point_ : set_point_.value_or(demand_.position));
  }
  internal_limit_ = false;
  target = clipped_target(target);
  if ((controlword_ & canopen::kControlChangeAtOnce) != 0 || !set_point_) {
    set_point_ = target;
    next_set_point_.reset();
  } else if (!next_set_point_) {
    next_set_point_ = target;
  } else {
    return;  // both places are taken: not acknowledged
  }
  acknowledged_ = true;
}

void Motion::on_target_position() {
  cyclic_left_s_ = number(object::interpolation_period) * std::pow(10.0, number(object::interpolation_exponent));
  cyclic_target_ = true;
}

// ---- the modes ----

void Motion::operate(const Measured& motor, double step_s) {
  if (mode_ != DriveMode::profile_position) internal_limit_ = false;  // there it belongs to the set-point
  switch (mode_) {
    case DriveMode::profile_position:
      return operate_profile_position(step_s);
    case DriveMode::profile_velocity:
      return operate_profile_velocity(step_s);
    case DriveMode::cyclic_position:
      return operate_cyclic_position(step_s);
    case DriveMode::cyclic_velocity:
      return operate_cyclic_velocity(step_s);
    case DriveMode::homing:
      return operate_homing(motor, step_s);
  }
}

void Motion::operate_profile_position(double step_s) {
  if (halted() || !set_point_) return ramp_to_velocity(demand_, 0, profile_ramps(), step_s);
  const double max_speed = std::min(velocity(object::profile_velocity), velocity(object::max_profile_velocity));
  if (!move_to_position(demand_, *set_point_, max_speed, profile_ramps(), step_s)) return;
  set_point_ = next_set_point_;
  next_set_point_.reset();
}

void Motion::operate_profile_velocity(double step_s) {
  const double target = halted() ? 0 : clipped_velocity(velocity(object::target_velocity));
  const auto range = limits();
  if (!range || target == 0) return ramp_to_velocity(demand_, target, profile_ramps(), step_s);
  const double end = target > 0 ? range->max : range->min;
  if ((end - demand_.position) * target <= 0) {  // already beyond it
    internal_limit_ = true;
    return ramp_to_velocity(demand_, 0, profile_ramps(), step_s);
  }
  if (move_to_position(demand_, end, std::abs(target), profile_ramps(), step_s)) internal_limit_ = true;
}

// Moves in even steps to each target within the interpolation period; a late target is followed as fast as allowed.
void Motion::operate_cyclic_position(double step_s) {
  if (!cyclic_target_) return ramp_to_velocity(demand_, 0, profile_ramps(), step_s);
  const double target = clipped_target(number(object::target_position) - static_cast<double>(offset_));
  const double wanted = (target - demand_.position) / std::max(cyclic_left_s_, step_s);
  demand_.velocity = clipped_velocity(wanted);
  demand_.position += demand_.velocity * step_s;
  cyclic_left_s_ -= step_s;
}

void Motion::operate_cyclic_velocity(double step_s) {
  demand_.velocity = clipped_velocity(velocity(object::target_velocity));
  const auto range = limits();
  const double after = demand_.position + demand_.velocity * step_s;
  const bool leaves =
      range && ((after > range->max && demand_.velocity > 0) || (after < range->min && demand_.velocity < 0));
  if (leaves) {
    internal_limit_ = true;
    demand_.velocity = 0;
  }
  demand_.position += demand_.velocity * step_s;
}

void Motion::operate_homing(const Measured& motor, double step_s) {
  if (halted() && homing_.is_moving()) homing_.abandon();
  const auto before = homing_.phase();
  homing_.step(demand_, motor.position, motor.negative_switch, motor.positive_switch, step_s);
  if (homing_.phase() == before || homing_.phase() != Homing::Phase::attained) return;
  offset_ = scale_.home_offset_direction * static_cast<std::int64_t>(number(object::home_offset)) -
            std::llround(homing_.home());
}

bool Motion::slow_down(SlowDown ramp, double step_s) {
  const double deceleration =
      acceleration(ramp == SlowDown::profile_ramp ? object::profile_deceleration : object::quick_stop_deceleration);
  ramp_to_velocity(demand_, 0, {deceleration, deceleration}, step_s);
  return demand_.velocity == 0;
}

// ---- what the objects say ----

std::int32_t Motion::position(const Measured& motor) const {
  const std::int64_t counts = std::llround(motor.position) + offset_;
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(counts));
}

std::uint16_t Motion::statusword_bits(const Measured& motor) const {
  // Bit 10: target reached; bits 12 and 13: by mode, CiA 402-2. Outside of homing, bit 13 is the following error.
  const bool demand_stands = demand_.velocity == 0;
  bool reached = false, mode_bit = false, error = is_outside_window(motor);
  switch (mode_) {
    case DriveMode::profile_position:
      // Bit 12: the set-point is acknowledged. Reached: none is under way and the motor is within the position window.
      reached = demand_stands && (halted() || !set_point_) &&
                std::abs(motor.position - demand_.position) <= number(object::position_window);
      mode_bit = acknowledged_ || next_set_point_.has_value();
      break;
    case DriveMode::profile_velocity: {
      // Bit 12: speed is zero, that is, below the threshold. Reached: at the target, ramp and motor.
      const double target = halted() ? 0 : velocity(object::target_velocity);
      reached = demand_.velocity == target && std::abs(motor.velocity - target) <= velocity(object::velocity_window);
      mode_bit = std::abs(motor.velocity) <= velocity(object::velocity_threshold);
      break;
    }
    case DriveMode::homing:
      // Bit 12: homing attained; bit 13: homing error. Reached: it does not move, whether attained or not.
      reached = demand_stands && !homing_.is_moving();
      mode_bit = homing_.phase() == Homing::Phase::attained;
      error = homing_.phase() == Homing::Phase::failed;
      break;
    case DriveMode::cyclic_position:
    case DriveMode::cyclic_velocity:
      // Bit 12: the drive follows the command value.
      mode_bit = true;
      break;
  }
  return static_cast<std::uint16_t>((reached ? canopen::kStatusTargetReached : 0) |
                                    (internal_limit_ ? canopen::kStatusInternalLimit : 0) |
                                    (mode_bit ? kStatusOfMode : 0) | (error ? canopen::kStatusError : 0));
}

bool Motion::is_outside_window(const Measured& motor) const {
  const double window = number(object::following_error_window);
  return canopen::is_position(mode_) && window < kNoWindow && std::abs(motor.position - demand_.position) > window;
}

bool Motion::halted() const {
  return (controlword_ & canopen::kControlHalt) != 0;
}

double Motion::clipped_target(double position) {
  const auto range = limits();
  if (!range || (position >= range->min && position <= range->max)) return position;
  internal_limit_ = true;
  return std::clamp(position, range->min, range->max);
}

double Motion::clipped_velocity(double velocity_wanted) {
  const double max = velocity(object::max_profile_velocity);
  if (std::abs(velocity_wanted) <= max) return velocity_wanted;
  internal_limit_ = true;
  return std::clamp(velocity_wanted, -max, max);
}

std::optional<Motion::Range> Motion::limits() const {
  const double min = number(object::position_limit_min), max = number(object::position_limit_max);
  if (min >= max) return std::nullopt;
  return Range{min - static_cast<double>(offset_), max - static_cast<double>(offset_)};
}

double Motion::number(const MappedObject& at) const {
  return static_cast<double>(objects_->value(at.object));
}

double Motion::velocity(const MappedObject& at) const {
  return number(at) * scale_.counts_per_velocity_unit;
}

double Motion::acceleration(const MappedObject& at) const {
  return number(at) * scale_.counts_per_acceleration_unit;
}

Ramps Motion::profile_ramps() const {
  return {acceleration(object::profile_acceleration), acceleration(object::profile_deceleration)};
}

}  // namespace kenaf::candrives
