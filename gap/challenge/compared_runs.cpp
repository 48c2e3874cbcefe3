#include "gap/challenge/compared_runs.hpp"

#include "gap/diagnose/diagnosis.hpp"
#include "gap/diagnose/repeats.hpp"

namespace kenaf::gap {
namespace {

constexpr std::size_t kMostRuns = 100;  // all runs of a case

std::vector<FeatureMap> features_of(const Observations& observations) {
  std::vector<FeatureMap> features;
  for (const Observation& run : observations.runs)
    features.emplace_back(run.run, DiagnosisOptions().span_s, observations.not_simulated);
  return features;
}

}  // namespace

ComparedRuns::ComparedRuns(const std::filesystem::path& dataset, unsigned threads, const std::atomic<bool>* stop)
    : observations(observe(dataset, "", "", kMostRuns)),
      features(features_of(observations)),
      predictor(observations, features, repeats_of(observations), threads, stop),
      same_orders(same_orders_of(observations)) {
  predictor.simulate_nominal();
  for (std::size_t r = 0; r < features.size(); ++r)
    residuals.push_back(features[r].measured() - predictor.nominal()[r]);
}

NoiseFloor floor_around(ComparedRuns& runs, const Variation& model) {
  return noise_floor(runs.features, runs.residuals, runs.same_orders,
                     open_shapes(runs.features, runs.predictor, model, kOpenStart_m, kOpenStart_rad));
}

double rms_of_repeats(const ComparedRuns& runs, const NoiseFloor& floor,
                      const std::vector<Eigen::VectorXd>& residuals) {
  return rms_of_repeats(floor, runs.features, deviations_from_repeats(runs.features, residuals, runs.same_orders),
                        runs.same_orders);
}

}  // namespace kenaf::gap
