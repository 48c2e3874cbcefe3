#include "gap/diagnose/diagnosis.hpp"

#include <cmath>

namespace kenaf::gap {
namespace {

using Eigen::VectorXd;

// Of the start pose, where the log has no rows at rest to average (chosen: as good as motion capture).
constexpr double kStart_m = 0.001, kStart_rad = 0.002;

std::vector<VectorXd> residuals_of(const std::vector<FeatureMap>& features, const std::vector<VectorXd>& nominal) {
  std::vector<VectorXd> residuals;
  for (std::size_t r = 0; r < features.size(); ++r) residuals.push_back(features[r].measured() - nominal[r]);
  return residuals;
}

}  // namespace

Diagnosis diagnose(const std::filesystem::path& folder, const DiagnosisOptions& options) {
  Diagnosis d;
  d.observations = observe(folder, options.robot, options.world);
  for (const Observation& run : d.observations.runs) d.features.emplace_back(run.run, options.span_s);
  Predictor predictor(d.observations, d.features, options.jobs);

  const std::vector<VectorXd> nominal = predictor.predict({predictor.nominal()}).front();
  const std::vector<VectorXd> residuals = residuals_of(d.features, nominal);
  d.floor = noise_floor(d.observations, d.features, residuals, open_shapes(d.features, nominal, predictor, kStart_m, kStart_rad));
  const auto groups = repeats_of(d.observations);
  const double inflation = inflation_from_repeats(
      d.features, d.floor, deviations_from_repeats(d.features, residuals, groups), options.stretch_s);
  const Coherence coherence(d.features, groups, options.stretch_s);

  d.curves = scan_effects(candidate_curves(d.observations, options.without), residuals, nominal, d.floor, predictor);
  const Simulator simulator{
      [&](EffectCurves& curves, std::span<const NewPoint> points) {
        add_points(curves, points, nominal, d.floor, predictor);
      },
      [&](std::span<const std::vector<OnCurve>> asked) {
        std::vector<Variation> variations;
        for (const std::vector<OnCurve>& places : asked) {
          variations.push_back(predictor.nominal());
          for (const OnCurve& place : places)
            variations.back().effects.*d.curves.curves[place.curve].parameter->value = place.value;
        }
        auto shifts = predictor.predict(variations);
        for (auto& shift : shifts)
          for (std::size_t r = 0; r < shift.size(); ++r) shift[r] = d.floor.whiteners[r](shift[r] - nominal[r]);
        return shifts;
      }};
  d.decision = decide(d.curves, coherence, inflation, simulator, options.decision, options.seed);
  d.roll_outs = predictor.roll_outs();
  return d;
}

}  // namespace kenaf::gap
