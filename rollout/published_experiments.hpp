// The published evaluation's 12 experiments (SSRR 2008, Table I): seven steps, five trenches, each with its outcome in
// the published simulation and in reality. docs/table1.md says what is known, and what is inferred or chosen.
//
// Thread safety: pure functions; any number at once.
#pragma once

#include <span>
#include <string>

#include "rollout/roll_out.hpp"

namespace kenaf::rollout {

enum class Obstacle { step, trench };

struct PublishedExperiment {
  Obstacle obstacle;
  int size_mm;           // height of the step, width of the trench
  bool simulated, real;  // published outcomes: whether it was passed
};
// Steps first, each from small to large.
std::span<const PublishedExperiment> published_experiments();
// The shipped manoeuvre: "step-300-flippers", "trench-350".
std::string manoeuvre_name(const PublishedExperiment& experiment);

// Kenaf without its batteries: its centre of mass, flippers straight out, lies 15 mm further back.
physics::RobotDescription robot_of_the_experiments();

// The manoeuvre of the experiments, without noise, at an obstacle of any size from 1 mm to 10 m: at the published sizes
// the same bits as the shipped manoeuvre in its shipped world.
RollOut attempt(Obstacle obstacle, double size_m, const physics::RobotDescription& robot, double time_step_s);

}  // namespace kenaf::rollout
