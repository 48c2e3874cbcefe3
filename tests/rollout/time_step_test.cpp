// Halving the time step moves no point of a path by more than 5 mm: places at equal times, at 1 ms and at 0.5 ms, with
// the operator's commands each decided anew. The step's own error is of first order, 0.05 mm for each 0.1 m/s; the rest
// of the 5 mm is for where an edge comes free of a belt a sample earlier or later.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "rollout/published_experiments.hpp"

using namespace kenaf;

namespace {

enum class Robot { shipped, of_the_experiments };

rollout::RollOut drive(const std::string& name, Robot which, double time_step_s) {
  const physics::RobotDescription robot =
      which == Robot::of_the_experiments ? rollout::robot_of_the_experiments() : physics::load_robot("kenaf");
  const rollout::Manoeuvre manoeuvre = rollout::load_manoeuvre(name);
  std::vector<std::string> unsupported;
  const physics::WorldDescription world = physics::load_world(manoeuvre.world, unsupported);
  return rollout::roll_out(robot, world, manoeuvre, {.physics = {.time_step_s = time_step_s}, .noise_scale = 0});
}

struct Apart {
  double most_m = 0, at_s = 0;
};

Apart apart(const runs::Run& a, const runs::Run& b) {
  Apart out;
  for (std::size_t row = 0; row < std::min(a.row_count(), b.row_count()); ++row) {
    double square = 0;
    for (const char* column : {"x_m", "y_m", "z_m"})
      square += std::pow(a.column(column)[row] - b.column(column)[row], 2);
    if (std::sqrt(square) > out.most_m) out = {std::sqrt(square), a.column("t_s")[row]};
  }
  return out;
}

void check(Robot robot, std::initializer_list<const char*> manoeuvres) {
  for (const char* name : manoeuvres) {
    const rollout::RollOut whole = drive(name, robot, 0.001), half = drive(name, robot, 0.0005);
    const Apart apart_m = apart(whole.run, half.run);
    INFO(name << ": " << apart_m.most_m * 1e3 << " mm apart at " << apart_m.at_s << " s");
    CHECK(apart_m.most_m < 0.005);
    CHECK(whole.succeeded == half.succeeded);
    CHECK(whole.gave_up == half.gave_up);
    // an operator who watches decides at most one sample earlier or later
    CHECK(half.run.column("t_s").back() == Approx(whole.run.column("t_s").back()).margin(0.011));
  }
}

}  // namespace

TEST_CASE("Half the time step, level ground") {
  check(Robot::shipped, {"straight", "straight-fast", "turn-in-place", "arc", "drop", "flipper-sweep"});
}

TEST_CASE("Half the time step, long runs on level ground") {
  check(Robot::shipped, {"square", "random-speeds", "speed-steps"});
}

TEST_CASE("Half the time step, ramp, stairs, hills and tilted box") {
  check(Robot::shipped, {"ramp", "stairs", "hills", "tilted-box"});
}

TEST_CASE("Half the time step, the steps of Table I") {
  check(Robot::of_the_experiments, {"step-50-flippers", "step-100-flippers", "step-150-flippers", "step-200-flippers",
                                    "step-250-flippers", "step-300-flippers", "step-350-flippers"});
}

TEST_CASE("Half the time step, the trenches of Table I") {
  check(Robot::of_the_experiments, {"trench-100", "trench-200", "trench-300", "trench-350", "trench-400"});
}
