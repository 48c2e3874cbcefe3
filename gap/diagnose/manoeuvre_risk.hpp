// The risk of a manoeuvre for the robot that drives it, and the order of manoeuvres by risk: the tool proposes the
// gentlest manoeuvre that serves the purpose.
//
// All figures are simulated. The force of a landing depends on unknown compliance, so the figures rank manoeuvres; they
// are no guarantee.
//
// Thread safety: values and pure functions.
#pragma once

#include "physics/robot_description.hpp"
#include "physics/world_description.hpp"
#include "rollout/roll_out.hpp"

namespace kenaf::gap::diagnose {

struct Risk {
  double largest_tilt_rad = 0;  // between the body's z axis and up, 0 to pi
  // The largest drop of the body's centre within 0.5 s, excluding height lost by driving along its longitudinal axis: a
  // robot on its tracks on a slope does not fall.
  double fall_m = 0;
  // The largest upward acceleration of the body's centre, averaged over 40 ms, without gravity; standing: 0. Shorter
  // peaks depend on the unknown contact stiffness.
  double impact_mps2 = 0;
  double current_share = 0;  // largest ratio of a motor's current to its stall current; 0 without currents
  bool stuck = false;        // it missed the manoeuvre's own goal, or its operator gave up
  bool fails = false;        // it turned over (beyond 90 degrees), or the simulation had a fault

  bool operator==(const Risk&) const = default;
};

// The worse of both for each figure.
Risk worst_of(const Risk& a, const Risk& b);

// Classes of manoeuvres by the demands on the robot, gentlest first.
enum class Gentleness {
  flat_driving,    // on level ground with fixed flippers: at worst it drives against a wall
  flat_flippers,   // on level ground, flippers move
  low_obstacle,    // over obstacles, without anything of the next class
  falls_or_tilts,  // beyond one of the limits below, dropped on purpose, or stuck on an obstacle
  fails,           // Risk::fails
};

// Limits of a gentle manoeuvre (all chosen, so that the ramp of 20 degrees and a step of 50 mm are gentle, a trench of
// 300 mm is not).
inline constexpr double kLargeTilt_rad = 0.44;       // 25 degrees: stairs have 23
inline constexpr double kFall_m = 0.03;              // half the radius of a track's end wheel
inline constexpr double kImpact_mps2 = 2 * 9.80665;  // three times the contact force of standing

// The robot for rating its motion: with exact posture and current sensors and without effects on sensors, which do not
// change the motion. Moves like `robot`.
physics::RobotDescription with_exact_sensors(physics::RobotDescription robot);

// `roll_out`: of `manoeuvre`, driven by with_exact_sensors(), without noise, in rows of 10 ms. `nominal`: provides the
// stall currents.
Risk risk_of(const rollout::RollOut& roll_out, const rollout::Manoeuvre& manoeuvre,
             const physics::RobotDescription& nominal);

// Whether it has level planes only.
bool is_level(const physics::WorldDescription& world);
// Whether flippers are commanded away from their start angles.
bool moves_flippers(const rollout::Manoeuvre& manoeuvre);
Gentleness gentleness(const rollout::Manoeuvre& manoeuvre, bool level_ground, const Risk& risk);

}  // namespace kenaf::gap::diagnose
