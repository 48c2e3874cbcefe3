// The published evaluation's 12 experiments, simulated: seven steps, five trenches.
//
// What is known of the published table: trench 350 succeeds in simulation and fails in reality, the other 11 agree. So
// trench 400 fails in both, and 100 to 300 succeed. That the series of steps ends likewise, with the first height that
// fails, is inferred, not read: docs/table1.md.
#include <catch2/catch.hpp>
#include <string_view>

#include "rollout/roll_out.hpp"

using namespace kenaf;

namespace {

struct Experiment {
  const char* manoeuvre;
  bool simulated;
};
constexpr Experiment kTable[] = {{"step-50-flippers", true},   {"step-100-flippers", true}, {"step-150-flippers", true},
                                 {"step-200-flippers", true},  {"step-250-flippers", true}, {"step-300-flippers", true},
                                 {"step-350-flippers", false}, {"trench-100", true},        {"trench-200", true},
                                 {"trench-300", true},         {"trench-350", true},        {"trench-400", false}};

// The batteries were out: the body's share of a centre that lies 15 mm further back for the whole robot.
physics::RobotDescription robot_of_the_experiments() {
  physics::RobotDescription robot = physics::load_robot("kenaf");
  robot.body.p_BBcm_m.x() = -0.015 * robot.total_mass_kg() / robot.body.mass_kg;
  return robot;
}

bool in_reality(const Experiment& experiment) {
  return experiment.simulated && std::string_view(experiment.manoeuvre) != "trench-350";
}

void check_row(const physics::RobotDescription& robot, double time_step_s, bool real) {
  for (const Experiment& experiment : kTable) {
    const rollout::Manoeuvre manoeuvre = rollout::load_manoeuvre(experiment.manoeuvre);
    std::vector<std::string> unsupported;
    const auto world = physics::load_world(manoeuvre.world, unsupported);
    const auto run =
        rollout::roll_out(robot, world, manoeuvre, {.physics = {.time_step_s = time_step_s}, .noise_scale = 0});
    INFO(experiment.manoeuvre << " ended at x = " << run.end.X_WB.p.x() << ", z = " << run.end.X_WB.p.z());
    CHECK(run.fault.empty());
    CHECK(run.succeeded == (real ? in_reality(experiment) : experiment.simulated));
  }
}

}  // namespace

TEST_CASE("Table I, simulated row: 12 of 12") {
  check_row(robot_of_the_experiments(), 0.001, false);
}

TEST_CASE("Table I, simulated row, at half the time step: no other outcome") {
  check_row(robot_of_the_experiments(), 0.0005, false);
}

TEST_CASE("Table I, real row: 12 of 12 with lugs three times as high") {
  physics::RobotDescription robot = robot_of_the_experiments();
  physics::set_effect(robot.effects, "lug_height:scale=3");
  check_row(robot, 0.001, true);
}
