#include "physics/dynamics/belt.hpp"

#include <algorithm>
#include <cmath>

namespace kenaf::physics {
namespace {

// Tracks that once pulled against each other must not do so for ever: a belt that rolls brings unloaded rubber into
// contact, and rubber creeps. After this distance or time, 1/e of an old friction impulse is left to start from.
constexpr double kRenewal_m = 0.02;
constexpr double kCreep_s = 0.5;

double most_friction_ns(const Belt& belt) {
  return belt.dry_friction_ns + belt.rolling_resistance * std::max(belt.load_ns, 0.0);
}

double impulse_to_hold(const Belt& belt) {
  return belt.moving_mass_kg * (belt.motor.target - belt.start_mps) + belt.viscous_ns * belt.motor.target -
         belt.push_ns;
}

}  // namespace

void start_step(Belt& belt, double time_step_s) {
  // exp(-h (|u| / 20 mm + 1 / 0.5 s)). Friction at its limit is given by the motion and starts whole.
  constexpr double kSlid = 0.999;  // of the limit
  belt.warm_start_share = std::exp(-time_step_s * (std::abs(belt.speed_mps) / kRenewal_m + 1 / kCreep_s));
  if (std::abs(belt.friction_impulse_ns) < kSlid * most_friction_ns(belt))
    belt.friction_impulse_ns *= belt.warm_start_share;
  belt.start_mps = belt.speed_mps;
  belt.viscous_ns = belt.viscous_nspm * time_step_s;
  begin_anew(belt);
}

void begin_anew(Belt& belt) {
  belt.load_ns = 0;
  belt.push_ns = belt.friction_impulse_ns;
  belt.mobility_per_kg = 0;
  belt.base_mps = belt.motor.target;
  if (belt.motor.holds()) return;
  const YieldingDrive motor = yielding(belt.motor);
  belt.mobility_per_kg = 1 / (belt.moving_mass_kg + belt.viscous_ns + motor.inertia);
  belt.base_mps = belt.mobility_per_kg * (belt.moving_mass_kg * belt.start_mps + motor.momentum);
}

double solve_friction(Belt& belt) {
  // The impulse that stops the belt, within its limit; against a motor that holds, all of it. With a limit of 0 too if
  // there is an impulse, of the last step or of an earlier iteration: that one has to go. The load is a sum of changes,
  // which rounding may leave below 0.
  const double most_ns = most_friction_ns(belt), before_ns = belt.friction_impulse_ns;
  if (most_ns <= 0 && before_ns == 0) return 0;
  const double speed_mps = belt.solved_mps();
  double wanted_ns = before_ns;
  if (belt.mobility_per_kg > 0)
    wanted_ns -= speed_mps / belt.mobility_per_kg;
  else if (speed_mps != 0)
    wanted_ns = -std::copysign(most_ns, speed_mps);
  belt.friction_impulse_ns = std::clamp(wanted_ns, -most_ns, most_ns);
  const double change_ns = belt.friction_impulse_ns - before_ns;
  belt.push_ns += change_ns;
  return change_ns * change_ns * belt.mobility_per_kg * belt.mobility_per_kg;
}

bool settle_motor(Belt& belt) {
  return settle(belt.motor, belt.solved_mps(), impulse_to_hold(belt));
}

void finish_step(Belt& belt) {
  belt.speed_mps = belt.solved_mps();
  belt.motor_impulse_ns = given_impulse(belt.motor, belt.speed_mps, impulse_to_hold(belt));
}

}  // namespace kenaf::physics
