#include "rollout/published_experiments.hpp"

#include <fmt/format.h>

#include "physics/standard_worlds.hpp"

namespace kenaf::rollout {
namespace {

constexpr PublishedExperiment kExperiments[] = {
    {Obstacle::step, 50, true, true},    {Obstacle::step, 100, true, true},    {Obstacle::step, 150, true, true},
    {Obstacle::step, 200, true, true},   {Obstacle::step, 250, true, true},    {Obstacle::step, 300, true, true},
    {Obstacle::step, 350, false, false}, {Obstacle::trench, 100, true, true},  {Obstacle::trench, 200, true, true},
    {Obstacle::trench, 300, true, true}, {Obstacle::trench, 350, true, false}, {Obstacle::trench, 400, false, false}};

}  // namespace

std::span<const PublishedExperiment> published_experiments() {
  return kExperiments;
}

std::string manoeuvre_name(const PublishedExperiment& experiment) {
  return experiment.obstacle == Obstacle::step ? fmt::format("step-{}-flippers", experiment.size_mm)
                                               : fmt::format("trench-{}", experiment.size_mm);
}

physics::RobotDescription robot_of_the_experiments() {
  physics::RobotDescription robot = physics::load_robot("kenaf");
  // The centre of mass of the whole robot 15 mm behind its centre; flippers straight out balance each other.
  robot.body.p_BBcm_m.x() = -0.015 * robot.total_mass_kg() / robot.body.mass_kg;
  return robot;
}

RollOut attempt(Obstacle obstacle, double size_m, const physics::RobotDescription& robot, double time_step_s) {
  const bool step = obstacle == Obstacle::step;
  Manoeuvre manoeuvre = load_manoeuvre(step ? "step-300-flippers" : "trench-300");
  // The robot must end up as much higher as the step is.
  if (step) *manoeuvre.success->z_above_m += size_m - 0.3;
  return roll_out(robot, step ? physics::step_world(size_m) : physics::trench_world(size_m), manoeuvre,
                  {.physics = {.time_step_s = time_step_s}, .noise_scale = 0});
}

}  // namespace kenaf::rollout
