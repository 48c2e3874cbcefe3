// What a manoeuvre may do to the robot that drives it, and how manoeuvres are put in order by that: a tool that exists
// so that robots do not break proposes the gentlest one that does what is wanted.
//
// All of it is as simulated. How hard a landing is depends on give that nobody has measured, so the figures put
// manoeuvres in order; they are no guarantee.
//
// Thread safety: values and pure functions.
#pragma once

#include "physics/robot_description.hpp"
#include "physics/world_description.hpp"
#include "rollout/roll_out.hpp"

namespace kenaf::gap::diagnose {

struct Risk {
  double largest_tilt_rad = 0;  // between the body's z axis and up, 0 to pi
  // The largest drop of the body's centre within 0.5 s, without what it lost by driving the way its nose or its tail
  // points: down a slope on its tracks nothing falls.
  double fall_m = 0;
  // The largest upward acceleration of the body's centre, a mean over 40 ms, gravity not counted; standing: 0. What is
  // shorter depends on the stiffness of contacts, which nobody knows.
  double impact_mps2 = 0;
  double current_share = 0;  // largest current of any motor over that of the same motor stalled; 0 without currents
  bool stuck = false;        // it did not end where the manoeuvre's own measure wants it, or its operator gave up
  bool fails = false;        // it turned over (beyond 90 degrees), or the simulation had a fault

  bool operator==(const Risk&) const = default;
};

// The worse of both in each figure.
Risk worst_of(const Risk& a, const Risk& b);

// By how much a manoeuvre asks of a robot, gentlest first.
enum class Gentleness {
  flat_driving,    // on level ground, flippers stay where they are: at worst it drives against a wall
  flat_flippers,   // on level ground, flippers move
  low_obstacle,    // over obstacles, none of what makes the next class
  falls_or_tilts,  // beyond one of the limits below, let fall on purpose, or stuck on an obstacle
  fails,           // Risk::fails
};

// Beyond one of these a manoeuvre is no gentle one (all chosen, so that the ramp of 20 degrees and a step of 50 mm are
// gentle, a trench of 300 mm is not).
inline constexpr double kLargeTilt_rad = 0.44;       // 25 degrees: stairs have 23
inline constexpr double kFall_m = 0.03;              // half the radius of a track's end wheel
inline constexpr double kImpact_mps2 = 2 * 9.80665;  // presses three times as hard as standing

// The robot as its motion is judged: with exact posture and current sensors, whatever it carries, and none of the
// effects on sensors, which move nothing. It moves as `robot` does.
physics::RobotDescription with_exact_sensors(physics::RobotDescription robot);

// Of `manoeuvre` driven by with_exact_sensors(), without noise, rows of 10 ms. `nominal`: whose motors' stall currents
// count.
Risk risk_of(const rollout::RollOut& roll_out, const rollout::Manoeuvre& manoeuvre,
             const physics::RobotDescription& nominal);

// Level planes and nothing else.
bool is_level(const physics::WorldDescription& world);
// Whether flippers are told to go elsewhere than where they are at the start.
bool moves_flippers(const rollout::Manoeuvre& manoeuvre);
Gentleness gentleness(const rollout::Manoeuvre& manoeuvre, bool level_ground, const Risk& risk);

}  // namespace kenaf::gap::diagnose
