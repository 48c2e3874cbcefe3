#include "physics/drive.hpp"

#include <algorithm>
#include <cmath>

namespace kenaf::physics {
namespace {

constexpr double kTurning_mps = 0.01;  // from here on the motor's own friction is full

}  // namespace

void TrackDrive::before_step(Belt& belt, const TrackDriveDescription& drive, double commanded_mps, double time_step_s) {
  const double target = std::clamp(commanded_mps, -drive.max_speed_mps, drive.max_speed_mps);
  // exact for a constant command, so the step size changes nothing
  const double share = drive.time_constant_s > 0 ? -std::expm1(-time_step_s / drive.time_constant_s) : 1;
  reference_mps += share * (target - reference_mps);
  const double u = belt.speed_mps;
  const double driving_n = drive.max_force_n * std::max(0.0, 1 - std::abs(u) / drive.max_speed_mps);
  belt.target_mps = reference_mps;
  belt.max_impulse_ns = (u > 0 ? driving_n : drive.max_force_n) * time_step_s;
  belt.min_impulse_ns = -(u < 0 ? driving_n : drive.max_force_n) * time_step_s;
}

double track_current_a(const TrackDriveDescription& drive, const Belt& belt, double time_step_s) {
  return drive.amperes_per_newton * std::abs(belt.motor_impulse_ns) / time_step_s +
         drive.idle_amperes * std::min(1.0, std::abs(belt.speed_mps) / kTurning_mps);
}

}  // namespace kenaf::physics
