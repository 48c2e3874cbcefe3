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
