// The published evaluation's 12 experiments, simulated, as a user runs them: by manoeuvre and shipped world.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

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

// At the pitch at which the front flippers let go of the step's face the edge must be under the straight run of the
// belts. It reaches to the axle of the end wheels, and the belly is one wheel's radius below that: in the body's frame
// (length / 2 - radius, height of the track - radius), turned by the pitch, and the edge is at x = 1 m.
TEST_CASE("The operator of the steps goes on where the robot's belts have reached over the edge") {
  const physics::RobotDescription robot = physics::load_robot("kenaf");
  const std::vector<rollout::Phase> phases = rollout::load_manoeuvre("step-300-flippers").phases;
  const auto hook = std::ranges::find(phases, "hook", &rollout::Phase::name);
  REQUIRE(hook != phases.end());
  const double axle_x_m = robot.track.front().length_m / 2 - robot.track.front().end_radius_m,
               belly_z_m = robot.track.front().p_BT_m.z() - robot.track.front().end_radius_m,
               nose_up_rad = -std::prev(hook)->end.pitch_below_rad.value();
  const double x_m = 1 - (axle_x_m * std::cos(nose_up_rad) - belly_z_m * std::sin(nose_up_rad));
  REQUIRE(hook->give_up);
  CHECK(hook->give_up->pitch_below_rad == -nose_up_rad);
  CHECK(hook->give_up->x_below_m.value() == Approx(x_m).margin(0.005));  // the file has two decimals
}

TEST_CASE("He gives up at the step of 350 mm, and not at that of 300 mm") {
  for (const double height_m : {0.3, 0.35}) {
    const auto run = rollout::attempt(rollout::Obstacle::step, height_m, rollout::robot_of_the_experiments(), 0.001);
    INFO(height_m << " m, ended at x = " << run.end.X_WB.p.x());
    CHECK(run.gave_up == (height_m > 0.3));
  }
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
