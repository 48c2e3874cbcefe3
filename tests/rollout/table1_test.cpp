// The published evaluation's 12 experiments, simulated, as a user runs them: by manoeuvre and shipped world.
#include <catch2/catch.hpp>

#include "rollout/published_experiments.hpp"

using namespace kenaf;
using rollout::PublishedExperiment;

namespace {

void check_row(const physics::RobotDescription& robot, double time_step_s, bool PublishedExperiment::*row) {
  for (const PublishedExperiment& experiment : rollout::published_experiments()) {
    const rollout::Manoeuvre manoeuvre = rollout::load_manoeuvre(rollout::manoeuvre_name(experiment));
    std::vector<std::string> unsupported;
    const auto world = physics::load_world(manoeuvre.world, unsupported);
    const auto run =
        rollout::roll_out(robot, world, manoeuvre, {.physics = {.time_step_s = time_step_s}, .noise_scale = 0});
    INFO(manoeuvre.name << " ended at x = " << run.end.X_WB.p.x() << ", z = " << run.end.X_WB.p.z());
    CHECK(run.fault.empty());
    CHECK(run.succeeded == experiment.*row);
  }
}

}  // namespace

TEST_CASE("Table I, simulated row: 12 of 12") {
  check_row(rollout::robot_of_the_experiments(), 0.001, &PublishedExperiment::simulated);
}

TEST_CASE("Table I, simulated row, at half the time step: no other outcome") {
  check_row(rollout::robot_of_the_experiments(), 0.0005, &PublishedExperiment::simulated);
}

TEST_CASE("Table I, real row: 12 of 12 with the body's centre of mass further ahead") {
  physics::RobotDescription robot = rollout::robot_of_the_experiments();
  physics::set_effect(robot.effects, "com_forward:offset_m=0.07");
  check_row(robot, 0.001, &PublishedExperiment::real);
}

TEST_CASE("An obstacle of a published size is the shipped one, to the last bit") {
  const physics::RobotDescription robot = rollout::robot_of_the_experiments();
  for (const std::size_t i : {1u, 8u}) {  // a low step, a narrow trench
    const PublishedExperiment experiment = rollout::published_experiments()[i];
    const rollout::Manoeuvre manoeuvre = rollout::load_manoeuvre(rollout::manoeuvre_name(experiment));
    std::vector<std::string> unsupported;
    const auto shipped = rollout::roll_out(robot, physics::load_world(manoeuvre.world, unsupported), manoeuvre,
                                           {.physics = {}, .noise_scale = 0});
    const auto same = rollout::attempt(experiment.obstacle, experiment.size_mm * 1e-3, robot, 0.001);
    CHECK(same.steps == shipped.steps);
    CHECK(same.end.X_WB.p == shipped.end.X_WB.p);
    CHECK(same.succeeded == shipped.succeeded);
  }
}
