// The gap split along the way from command to sensor, on logs whose flaw is known.
#include "gap/diagnose/stages.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <random>

#include "gap/diagnose/channels.hpp"
#include "tests/gap/made_run.hpp"

using namespace kenaf;
using namespace kenaf::gap;

namespace {

// A robot that weaves: yaw = 0.5 sin t, its rate 0.5 cos t.
struct Flaw {
  double gyro_scale = 1, belt_offset_mps = 0, drift_mps = 0;  // the last one of the body alone
  double yaw_noise_rad = 5e-4;
};

runs::Run weaving(const Flaw& flaw, bool noisy, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const auto noise = [&](double sigma) { return noisy ? sigma * normal(random) : 0; };
  const auto belt = [&](double) { return 0.3 + flaw.belt_offset_mps + noise(2e-3); };
  return test::made_run(
      10, 0.05,
      {{"track_left_mps", belt},
       {"track_right_mps", belt},
       {"x_m", [&](double t_s) { return (0.3 + flaw.belt_offset_mps + flaw.drift_mps) * t_s + noise(1e-3); }},
       {"yaw_rad", [&](double t_s) { return 0.5 * std::sin(t_s) + noise(flaw.yaw_noise_rad); }},
       {"pitch_rad", [&](double) { return noise(5e-4); }},
       {"roll_rad", [&](double) { return noise(5e-4); }},
       {"gyro_x_radps", [&](double) { return noise(5e-3); }},
       {"gyro_y_radps", [&](double) { return noise(5e-3); }},
       {"gyro_z_radps", [&](double t_s) { return flaw.gyro_scale * 0.5 * std::cos(t_s) + noise(5e-3); }}});
}

// Four runs of two manoeuvres, simulated by a model without flaw; driven by the measured belts it has their offset.
std::vector<StageGap> stages(const Flaw& flaw) {
  Observations observations;
  std::vector<FeatureMap> features;
  std::vector<Eigen::VectorXd> residuals, measured_drives;
  Flaw of_belts;
  of_belts.belt_offset_mps = flaw.belt_offset_mps;
  std::vector<OpenShapes> open;
  for (std::uint64_t r = 0; r < 4; ++r) {
    observations.runs.emplace_back();
    observations.runs.back().run = weaving(flaw, true, r);
    features.emplace_back(observations.runs.back().run, 0.25);
    residuals.push_back(features[r].measured() - features[r].of(weaving({}, false, 0)));
    measured_drives.push_back(features[r].of(weaving(of_belts, false, 0)));
    const auto bins = std::ssize(features[r].bins());
    open.push_back({Eigen::MatrixXd::Zero(bins, 1), Eigen::VectorXd::Zero(bins)});
  }
  const std::vector<std::vector<std::size_t>> repeats{{0, 1}, {2, 3}};
  return stage_gaps(features, noise_floor(features, residuals, repeats, open), Coherence(features, repeats, 1),
                    residuals, measured_drives, observations);
}

std::vector<bool> gaps(const Flaw& flaw) {
  std::vector<bool> found;
  for (const StageGap& stage : stages(flaw)) {
    REQUIRE(stage.bins > 0);
    found.push_back(stage.chance > kStageChance);
  }
  return found;
}

}  // namespace

TEST_CASE("Without a flaw no passage has a gap") {
  CHECK(gaps({}) == std::vector<bool>{false, false, false});
}

TEST_CASE("A gyro whose scale is wrong shows between body and sensor, and where the body is compared with it") {
  // also the body's simulated gyro differs, so only the belts are without a gap
  const std::vector<StageGap> found = stages({.gyro_scale = 1.1});
  CHECK(found[0].chance < kStageChance);
  CHECK(found[2].passage == Passage::body_to_sensor);
  CHECK(found[2].chance > kStageChance);
}

TEST_CASE("Belts that run at another speed are a gap of the drives alone, once the body is driven as they did") {
  CHECK(gaps({.belt_offset_mps = 0.03}) == std::vector<bool>{true, false, false});
}

TEST_CASE("A body that drifts on belts that run as told is a gap of the body alone") {
  CHECK(gaps({.drift_mps = 0.03}) == std::vector<bool>{false, true, false});
}

TEST_CASE("A noisy yaw is no flaw of the gyro that is compared with it") {
  // 0.02 rad of a sample, 0.009 of a bin, are 0.025 rad/s of a rate over half a second: ten times the gyro's bin
  CHECK(gaps({.yaw_noise_rad = 0.02}) == std::vector<bool>{false, false, false});
}

TEST_CASE("A passage that was not measured has no bins") {
  Observations observations;
  observations.runs.emplace_back();
  observations.runs[0].run = test::made_run(1, 0.05, {{"x_m", [](double) { return 0.0; }}});
  const FeatureMap map(observations.runs[0].run, 0.25);
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(4);
  const NoiseFloor floor = noise_floor({map}, {none}, {{0}}, {{Eigen::MatrixXd::Zero(4, 1), none}});
  for (const StageGap& stage :
       stage_gaps({map}, floor, Coherence({map}, {{0}}, 1), {none}, {Eigen::VectorXd()}, observations))
    CHECK(stage.bins == 0);
}
