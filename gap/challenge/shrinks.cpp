#include "gap/challenge/shrinks.hpp"

#include "gap/diagnose/evidence.hpp"
#include "gap/diagnose/noise_floor.hpp"
#include "gap/diagnose/observation.hpp"
#include "gap/diagnose/prediction.hpp"

namespace kenaf::gap {
namespace {

using Eigen::VectorXd;

// As a diagnosis has them.
constexpr std::size_t kMostRuns = 60;
constexpr double kSpan_s = 0.25;

std::vector<VectorXd> difference(const std::vector<VectorXd>& a, const std::vector<VectorXd>& b) {
  std::vector<VectorXd> result;
  for (std::size_t r = 0; r < a.size(); ++r) result.push_back(a[r] - b[r]);
  return result;
}

}  // namespace

Shrinks shrinks_on(const std::filesystem::path& dataset, const physics::Effects& told, const physics::Effects& hidden,
                   unsigned threads) {
  const Observations observations = observe(dataset, "", "", kMostRuns);
  std::vector<FeatureMap> features;
  std::vector<VectorXd> measured;
  for (const Observation& run : observations.runs) {
    features.emplace_back(run.run, kSpan_s);
    measured.push_back(features.back().measured());
  }
  Predictor predictor(observations, features, repeats_of(observations), threads);
  predictor.simulate_nominal();
  const std::vector<VectorXd> residuals = difference(measured, predictor.nominal());
  std::vector<Variation> models(2, predictor.unvaried());
  models[0].effects = told;
  models[1].effects = hidden;
  const auto same_orders = same_orders_of(observations);
  const NoiseFloor floor = noise_floor(features, residuals, same_orders,
                                       open_shapes(features, predictor, models[1], kOpenStart_m, kOpenStart_rad));
  const std::vector<Shift> shifts = predictor.shifts(models, Fidelity::every_run);
  Shrinks result;
  result.before = floor.rms(residuals);
  result.floor = floor.from_repeats ? floor.rms(deviations_from_repeats(features, residuals, same_orders)) : 1;
  result.told = shrink(result.before, floor.rms(difference(residuals, shifts[0])), result.floor);
  result.hidden = shrink(result.before, floor.rms(difference(residuals, shifts[1])), result.floor);
  return result;
}

}  // namespace kenaf::gap
