#include "physics/dynamics/drive.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/dynamics/battery.hpp"

namespace kenaf::physics {
namespace {

constexpr double kTurning_mps = 0.01;  // above this speed the motor's own friction is full
constexpr double kAnyImpulse_ns = std::numeric_limits<double>::infinity();

}  // namespace

TrackDrive::TrackDrive(robot::Track side, const TrackDriveDescription& drive, const Effects& effects)
    : drive_(drive),
      lag_s_(effects.drive_lag_s),
      droop_mpspn_(effects.drive_droop_mpspn),
      dry_friction_n_(effects.drive_coulomb_n +
                      (side == robot::kLeft ? effects.drive_coulomb_left_n : effects.drive_coulomb_right_n)),
      viscous_nspm_(effects.drive_viscous_nspm),
      rolling_resistance_(effects.rolling_resistance) {
  drive_.max_force_n *= effects.drive_torque_scale;
}

void TrackDrive::prescribe(Belt& belt, double speed_mps) {
  // A motor of any strength on a belt without mass and friction.
  turn_at(speed_mps);
  belt.speed_mps = speed_mps;
  belt.motor = {.target = speed_mps, .low = -kAnyImpulse_ns, .high = kAnyImpulse_ns};
  belt.moving_mass_kg = belt.dry_friction_ns = belt.viscous_nspm = belt.rolling_resistance = 0;
}

void TrackDrive::before_step(Belt& belt, double commanded_mps, double voltage_share, double time_step_s) {
  double target = std::clamp(commanded_mps, -drive_.max_speed_mps, drive_.max_speed_mps);
  // Both lags are exact for a constant command, 1 - exp(-h / tau), so the step size has no influence.
  if (lag_s_ > 0) {
    lagged_mps_ -= std::expm1(-time_step_s / lag_s_) * (target - lagged_mps_);
    target = lagged_mps_;
  }
  const double share = drive_.time_constant_s > 0 ? -std::expm1(-time_step_s / drive_.time_constant_s) : 1;
  reference_mps_ += share * (target - reference_mps_);

  // Limits by the torque-speed line: F_max s when braking, F_max (s - |u| / u_max) when driving.
  const double u = belt.speed_mps;
  const double braking_n = drive_.max_force_n * voltage_share;
  const double driving_n = drive_.max_force_n * std::max(0.0, voltage_share - std::abs(u) / drive_.max_speed_mps);
  belt.moving_mass_kg = drive_.moving_mass_kg;
  belt.motor.target = reference_mps_;
  belt.motor.softness = droop_mpspn_ / time_step_s;
  belt.motor.high = (u > 0 ? driving_n : braking_n) * time_step_s;
  belt.motor.low = -(u < 0 ? driving_n : braking_n) * time_step_s;
  belt.dry_friction_ns = dry_friction_n_ * time_step_s;
  belt.viscous_nspm = viscous_nspm_;
  belt.rolling_resistance = rolling_resistance_;
}

double TrackDrive::current_a(const Belt& belt, double time_step_s) const {
  return drive_.amperes_per_newton * std::abs(belt.motor_impulse_ns) / time_step_s +
         drive_.idle_amperes * std::min(1.0, std::abs(belt.speed_mps) / kTurning_mps);
}

double TrackDrive::battery_current_a(const Belt& belt, double voltage_share, double time_step_s) const {
  // Current for the force, and idle current, which needs no voltage but that of turning.
  const double force_n = std::abs(belt.motor_impulse_ns) / time_step_s;
  const double speed_share = belt.speed_mps / drive_.max_speed_mps;
  const double idle_a = drive_.idle_amperes * std::min(1.0, std::abs(belt.speed_mps) / kTurning_mps);
  return physics::battery_current_a(drive_.amperes_per_newton * force_n, force_n / drive_.max_force_n,
                                    std::copysign(speed_share, belt.motor_impulse_ns * belt.speed_mps), voltage_share) +
         physics::battery_current_a(idle_a, 0, std::abs(speed_share), voltage_share);
}

}  // namespace kenaf::physics
