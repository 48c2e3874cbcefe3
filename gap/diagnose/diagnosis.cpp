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
  Predictor predictor(d.observations, d.features, repeats_of(d.observations), options.jobs);

  const std::vector<VectorXd> residuals = residuals_of(d.features, predictor.nominal());
  d.floor = noise_floor(d.features, residuals, predictor.repeats(),
                        open_shapes(d.features, predictor, predictor.unvaried(), kStart_m, kStart_rad));
  const NoiseFloor nominal_floor = d.floor;
  const double inflation = inflation_from_repeats(
      d.features, d.floor, deviations_from_repeats(d.features, residuals, predictor.repeats()), options.stretch_s);
  const Coherence coherence(d.features, predictor.repeats(), options.stretch_s);

  d.curves = scan_effects(candidate_curves(d.observations, options.without), residuals, d.floor, predictor);
  const Simulator simulator{
      [&](EffectCurves& curves, std::span<const NewPoint> points, Fidelity fidelity) {
        add_points(curves, points, fidelity, predictor);
      },
      [&](std::span<const std::vector<NewPoint>> asked, Fidelity fidelity) {
        std::vector<Variation> variations;
        for (const std::vector<NewPoint>& effects : asked) variations.push_back(varied(d.curves, effects, predictor));
        return predictor.shifts(variations, fidelity);
      },
      [&](std::span<const NewPoint> effects) {
        d.floor = with_open_shapes(nominal_floor, open_shapes(d.features, predictor, varied(d.curves, effects, predictor),
                                                              kStart_m, kStart_rad));
        return d.floor.whiteners;
      }};
  d.decision = decide(d.curves, coherence, inflation, simulator, options.decision, options.seed);
  d.roll_outs = predictor.roll_outs();
  return d;
}

}  // namespace kenaf::gap
