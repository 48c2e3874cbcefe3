// Where a gap is, on a run that parts from its model at a known time.
#include "gap/diagnose/where.hpp"

#include <catch2/catch.hpp>

#include "gap/diagnose/channels.hpp"
#include "tests/gap/made_run.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::diagnose;

TEST_CASE("Before a gap begins there is none, whatever offset its channel may have") {
  // Stands for 5 s, then drives, 5 mm higher than the model says. An offset of any size is open: with the mean taken
  // off, 2.5 mm are missing before 5 s and 2.5 mm too much after, as far as chance goes the same.
  constexpr double kSigma_m = 1e-3, kOffset_m = 0.1;
  const auto drives = [](double t_s) { return t_s < 5 ? 0 : 0.3; };
  Observations observations;
  observations.runs.emplace_back();
  Observation& only = observations.runs.back();
  const auto above = [](double t_s) { return t_s < 5 ? 0 : 0.005; };
  only.run =
      test::made_run(10, 0.05, {{"cmd_track_left_mps", drives}, {"cmd_track_right_mps", drives}, {"z_m", above}});
  const std::vector<StageFeatures> features{
      stage_features(Passage::drive_to_body, FeatureMap(only.run, 0.25), only.run)};
  const auto bins = std::ssize(features[0].bins);
  const Eigen::VectorXd sigma = Eigen::VectorXd::Constant(bins, kSigma_m);
  const NoiseFloor floor{std::vector<double>(diagnosis_channels().size(), kSigma_m),
                         {sigma},
                         {Whitener(sigma, Eigen::MatrixXd::Constant(bins, 1, kOffset_m))},
                         true};
  const std::vector<std::vector<std::size_t>> repeats{{0}};
  const GapPlaces places =
      locate(observations, features, floor, repeats, Coherence(features, repeats, 1), {features[0].measured});
  double standing = 0, going = 0;
  for (const PhaseGap& phase : places.phases) (phase.to_s <= 5 ? standing : going) += phase.share;
  CHECK(standing == Approx(0).margin(1e-12));
  CHECK(going == Approx(0.99));  // all but the last 0.05 of 5 s, in which there is no row
}

TEST_CASE("A gap belongs to the phase in which it is, not to the next one in the same interval") {
  // Told to stop at 3 s and settled at 3.3 s; the model is 10 mm off from 3.0 to 3.25 s alone. The interval from 3 to
  // 4 s has this gap; 0.7 of it is the robot standing.
  constexpr double kSigma_m = 1e-3;
  const auto drives = [](double t_s) { return t_s < 2.995 ? 0.3 : 0; };
  const auto off = [](double t_s) { return t_s > 2.99 && t_s < 3.25 ? 0.01 : 0; };
  Observations observations;
  observations.runs.emplace_back();
  Observation& only = observations.runs.back();
  only.run = test::made_run(6, 0.05, {{"cmd_track_left_mps", drives}, {"cmd_track_right_mps", drives}, {"z_m", off}});
  const std::vector<StageFeatures> features{
      stage_features(Passage::drive_to_body, FeatureMap(only.run, 0.25), only.run)};
  const Eigen::VectorXd sigma = Eigen::VectorXd::Constant(std::ssize(features[0].bins), kSigma_m);
  const NoiseFloor floor{std::vector<double>(diagnosis_channels().size(), kSigma_m),
                         {sigma},
                         {Whitener(sigma, Eigen::MatrixXd(sigma.size(), 0))},
                         true};
  const std::vector<std::vector<std::size_t>> repeats{{0}};
  const GapPlaces places =
      locate(observations, features, floor, repeats, Coherence(features, repeats, 1), {features[0].measured});
  for (const PhaseGap& phase : places.phases) {
    INFO(phase.phase);
    CHECK(phase.share == Approx(phase.phase == "slow down" ? 1 : 0).margin(1e-9));
  }
}
