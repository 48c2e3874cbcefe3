#include "gap/diagnose/prepared_stage.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "gap/diagnose/baseline.hpp"
#include "gap/diagnose/candidates_that_matter.hpp"
#include "gap/diagnose/number_shapes.hpp"
#include "gap/diagnose/same_parts.hpp"
#include "gap/diagnose/stage_candidates.hpp"

namespace kenaf::gap::diagnose {
namespace {

// First points of each candidate that may act in the stage.
EffectCurves first_look(const StageData& data, std::span<const candidates::Candidate> candidates,
                        std::span<const std::size_t> possible, const Simulate& simulate) {
  EffectCurves curves = empty_curves(data, candidates);
  add_first_look(curves, data, possible, simulate);
  return curves;
}

// After the first look, curves over the whole range of the candidates that can matter.
void follow_those_that_matter(EffectCurves& curves, const StageData& data, std::span<const std::size_t> possible,
                              const Simulate& simulate) {
  const std::vector<std::size_t> matter =
      candidates_that_matter(data, curves, possible, nominal_model(data).likelihood.discrepancies);
  add_spread(curves, data, matter, simulate);
  follow_bends(curves, data, matter, simulate);
}

}  // namespace

bool has_baseline(const std::vector<StageFeatures>& features) {
  return std::ranges::any_of(features, [](const StageFeatures& run) { return run.baseline_runs.size() > 0; });
}

Variation varied(const PreparedStage& stage, const Predictor& predictor, const Settings& settings) {
  Variation variation = predictor.unvaried();
  variation.robot = with_settings(std::move(variation.robot), stage.candidates, settings);
  return variation;
}

std::vector<OpenShapes> open_around(const PreparedStage& stage, Predictor& predictor, const Settings& settings) {
  return open_shapes(*stage.input.features, predictor, stage.input.passage, varied(stage, predictor, settings),
                     kOpenStart_m, kOpenStart_rad);
}

StageData data_in(const PreparedStage& stage, const NoiseFloor& floor) {
  return stage_data(stage.input.passage, *stage.input.features, *stage.input.repeats, stage.residuals, floor);
}

Simulate simulator_of(const PreparedStage& stage, Predictor& predictor) {
  return [&stage, &predictor](std::span<const Settings> asked, Fidelity fidelity) {
    std::vector<Variation> variations;
    for (const Settings& settings : asked) variations.push_back(varied(stage, predictor, settings));
    std::vector<GroupVectors> shifts;
    for (const Shift& shift : predictor.shifts(variations, stage.input.passage, fidelity))
      shifts.push_back(mean_of_groups(stage.nominal.data, shift));
    return shifts;
  };
}

PreparedStage prepare_stage(const StageInput& input, std::span<const candidates::Candidate> candidates,
                            Predictor& predictor) {
  const std::vector<StageFeatures>& features = *input.features;
  PreparedStage stage{input, candidates, {}, {}, {}, {}, {}};
  for (std::size_t r = 0; r < features.size(); ++r)
    stage.residuals.push_back(features[r].measured - predictor.nominal(input.passage)[r]);
  if (std::ranges::all_of(features, [](const StageFeatures& run) { return run.bins.empty(); })) return stage;
  const bool drives_measured =
      std::ranges::all_of(input.observations->runs, [](const Observation& run) { return run.measured.has_value(); });
  stage.possible = candidates_of(input.passage, candidates, drives_measured);

  // noise, and the simulation's open shapes around the nominal model
  NoiseFloor& floor = stage.nominal.floor;
  std::vector<OpenShapes> open = open_around(stage, predictor, {});
  if (has_baseline(features)) add_other_ways(open, features, predictor.nominal(input.passage));
  // a sensor's feature is its difference from the body's motion, whose noise nothing states
  const bool as_stated = input.passage != Passage::body_to_sensor;
  floor = noise_floor(features, stage.residuals, *input.same_command_sequence, open,
                      as_stated ? std::span<const double>(input.stated_noise) : std::span<const double>());
  stage.nominal.data = data_in(stage, floor);

  // a first look at all candidates; errors of the description's numbers are the same in a baseline
  const Simulate simulate = simulator_of(stage, predictor);
  stage.curves = first_look(stage.nominal.data, candidates, stage.possible, simulate);
  std::ranges::copy_if(stage.possible, std::back_inserter(stage.visible),
                       [&](std::size_t c) { return stage.curves.curves[c].visible > 1; });
  if (!has_baseline(features)) floor.number_shapes = number_shapes(stage.nominal.data, stage.curves, stage.possible);
  stage.nominal.shapes_of_all_numbers = floor.number_shapes;
  stage.nominal.data = data_in(stage, floor);

  // curves over the whole range of those that can matter
  const std::vector<std::size_t> distinct =
      without_same_parts(stage.nominal.data, candidates, stage.possible, simulate);
  forget_all_but(stage.curves, distinct);
  follow_those_that_matter(stage.curves, stage.nominal.data, distinct, simulate);
  return stage;
}

}  // namespace kenaf::gap::diagnose
