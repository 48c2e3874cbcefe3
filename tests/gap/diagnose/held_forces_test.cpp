// Forces that a standing robot holds: open until the first command to move, and only in the motors' currents.
#include "gap/diagnose/held_forces.hpp"

#include <catch2/catch.hpp>

#include "gap/diagnose/channels.hpp"
#include "tests/gap/made_run.hpp"

using namespace kenaf::gap;
using namespace kenaf::gap::diagnose;

namespace {

// 2 s of a robot that holds 1.5 A until it moves, and needs 0.5 A then.
StageFeatures held_until(double moves_s) {
  const auto run = test::made_run(2, 0.125,
                                  {{"flipper_rl_a", [&](double t_s) { return t_s < moves_s ? 1.5 : 0.5; }},
                                   {"battery_v", [](double) { return 24.0; }}});
  StageFeatures features = stage_features(Passage::command_to_drive, FeatureMap(run, 0.25), run);
  features.at_rest_s = moves_s;
  return features;
}

std::vector<std::size_t> channels_of(const StageFeatures& run) {
  return {run.bins.front().channel, run.bins.back().channel};
}

}  // namespace

TEST_CASE("What a flipper holds is open while the robot stands, as far as what it was measured to hold") {
  const StageFeatures run = held_until(1);
  const std::vector<std::size_t> currents = motor_currents(channels_of(run));
  REQUIRE(currents == std::vector<std::size_t>{run.bins.front().channel});

  // four bins of 0.25 s before the command, and none after it; the voltage is not held
  const Eigen::MatrixXd shapes = held_forces(run, currents);
  REQUIRE(shapes.cols() == 1);
  for (Eigen::Index b = 0; b < shapes.rows(); ++b) {
    const Bin& bin = run.bins[static_cast<std::size_t>(b)];
    CHECK(shapes(b, 0) == Approx(bin.channel == currents[0] && bin.span < 4 ? 1.5 : 0));
  }
}

TEST_CASE("A bin in which the robot begins to move is open for its part at rest") {
  const StageFeatures run = held_until(0.375);
  const Eigen::MatrixXd shapes = held_forces(run, motor_currents(channels_of(run)));
  // one whole bin at 1.5 A and half of one that averages 1 A: (1.5 + 0.5) / 1.5 = 1.333 A held
  CHECK(shapes(0, 0) == Approx(4 / 3.0));
  CHECK(shapes(1, 0) == Approx(2 / 3.0));
  CHECK(shapes(2, 0) == 0);
}

TEST_CASE("A robot that moves from the start holds nothing") {
  const StageFeatures run = held_until(0);
  CHECK(held_forces(run, motor_currents(channels_of(run))).isZero());
}
