#include "gap/challenge/look_alike.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gap/challenge/judge.hpp"
#include "gap/diagnose/diagnosis.hpp"

namespace kenaf::gap {

LookAlike look_alike(ComparedRuns& runs, const NoiseFloor& floor, const Shift& hidden,
                     std::span<const std::string> without) {
  Predictor& predictor = runs.predictor;
  EffectCurves curves = scan_effects(candidate_curves(runs.observations, without), hidden, floor, predictor);
  const double all = squared_length(curves.gap);
  SearchSettings settings;
  settings.exact_rounds = 0;
  const Coherence coherence(runs.features, predictor.repeats(), DiagnosisOptions().stretch_s);
  const Simulator simulator{[&](EffectCurves& to, std::span<const NewPoint> points, Fidelity) {
                              add_points(to, points, Fidelity::coarse, predictor);
                            },
                            {},
                            {}};
  const Model nearest = search_singles(curves, coherence, simulator, settings).front();
  const EffectCurve& curve = curves.curves[nearest.places.front().curve];
  const double sine = all > 0 ? std::sqrt(std::clamp(nearest.left / all, 0.0, 1.0)) : 1;
  return {reported_name(std::string(curve.effect->name), std::string(curve.parameter->name)),
          std::asin(sine) * 180 / std::numbers::pi};
}

}  // namespace kenaf::gap
