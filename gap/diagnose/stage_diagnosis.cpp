#include "gap/diagnose/stage_diagnosis.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "gap/candidates/robot_numbers.hpp"
#include "gap/diagnose/cells.hpp"
#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/errors_of_values.hpp"
#include "gap/diagnose/judgement.hpp"
#include "gap/diagnose/looks.hpp"
#include "gap/diagnose/number_shapes.hpp"
#include "gap/diagnose/repeats.hpp"
#include "gap/diagnose/shares_of_effects.hpp"

namespace kenaf::gap::diagnose {
namespace {

using Eigen::VectorXd;

std::vector<double> rms_si(const std::vector<StageFeatures>& features, const std::vector<VectorXd>& differences) {
  std::vector<double> squares(diagnosis_channels().size(), 0), bins(squares.size(), 0);
  for (std::size_t r = 0; r < differences.size(); ++r)
    for (std::size_t b = 0; b < features[r].bins.size(); ++b) {
      const double value = differences[r][static_cast<Eigen::Index>(b)];
      squares[features[r].bins[b].channel] += value * value;
      ++bins[features[r].bins[b].channel];
    }
  for (std::size_t c = 0; c < squares.size(); ++c)
    squares[c] = bins[c] > 0 ? std::sqrt(squares[c] / bins[c]) : GapMeasure::kNotMeasured;
  return squares;
}

std::vector<VectorXd> less_shift(std::vector<VectorXd> a, const std::vector<VectorXd>& b) {
  for (std::size_t r = 0; r < a.size(); ++r)
    if (a[r].size() > 0) a[r] -= b[r];
  return a;
}

// Copies the bins of one part of a run from `other`.
void take_part(VectorXd& of_run, const VectorXd& other, const RunPart& part, const StageFeatures& run) {
  for (std::size_t b = 0; b < run.bins.size(); ++b)
    if (const auto i = static_cast<Eigen::Index>(b);
        part.holds((static_cast<double>(run.bins[b].span) + 0.5) * run.span_s))
      of_run[i] = other[i];
}

// Removes keys of numbers that the robot does not have: those of wheels from a robot on tracks, and the reverse.
void keep_those_of(const physics::RobotDescription& robot, std::vector<std::string>& keys) {
  std::erase_if(keys, [&](const std::string& key) {
    return physics::find_effect(key) == nullptr && !candidates::find_robot_number(robot, key);
  });
}

// The best model's residual, regressed on measured quantities.
std::vector<Dependence> left_over_of(const StageInput& input, Predictor& predictor, const Variation& best,
                                     const NoiseFloor& floor) {
  const std::vector<Variation> of_runs(input.observations->runs.size(), best);
  const std::vector<VectorXd> simulated = predictor.features_of_each(of_runs, input.passage);
  std::vector<LeftOverRun> runs;
  for (std::size_t g = 0; g < input.repeats->size(); ++g)
    for (const std::size_t r : (*input.repeats)[g]) {
      const FeatureMap& map = (*input.maps)[r];
      LeftOverRun run{&input.observations->runs[r], &map, map.measured(), simulated[r], {}, g};
      const StageFeatures& stage = (*input.features)[r];
      if (input.passage != Passage::body_to_sensor) run.measured(stage.rows) = stage.measured;
      run.sigma.resize(map.measured().size());
      for (std::size_t b = 0; b < map.bins().size(); ++b) {
        const std::size_t channel = map.bins()[b].channel;
        run.sigma[static_cast<Eigen::Index>(b)] =
            floor.sigma[channel] > 0 ? floor.sigma[channel] : diagnosis_channels()[channel].resolution;
      }
      runs.push_back(std::move(run));
    }
  std::vector<Dependence> found = describe_left_over(runs, input.passage == Passage::command_to_drive);
  for (Dependence& dependence : found) keep_those_of(input.observations->robot, dependence.look_at);
  return found;
}

// Cross-validates the best model by simulating the runs of each fold with the values fitted to the others, and judges
// its names.
void weigh(StageDiagnosis& stage, const PreparedStage& prepared, Predictor& predictor, const StageOptions& options) {
  const StageInput& input = prepared.input;
  const std::vector<StageFeatures>& features = *input.features;
  StageDecision& decision = stage.decision;
  const Model& best = decision.best.model;
  NoiseFloor floor = decision.floor;
  floor.number_shapes = decision.shapes_of_all_numbers;
  const StageView view{&features, input.repeats, &stage.residuals, &floor};

  // simulated residuals of each run with its fold's values; for halved runs the later half has other values
  const auto left_by = [&](const std::vector<std::vector<PlacesOfPart>>& places) {
    const bool any_halves = std::ranges::any_of(places, [](const auto& of_run) { return of_run.size() > 1; });
    std::vector<VectorXd> left(features.size());
    for (const bool later_half : {false, true}) {
      if (later_half && !any_halves) break;
      std::vector<Variation> variations;
      for (const std::vector<PlacesOfPart>& of_run : places)
        variations.push_back(
            varied(prepared, predictor, settings_of((later_half ? of_run.back() : of_run.front()).places)));
      const std::vector<VectorXd> all = less_shift(stage.residuals, predictor.shift_of_each(variations, input.passage));
      for (std::size_t r = 0; r < left.size(); ++r)
        if (later_half)
          take_part(left[r], all[r], places[r].back().part, features[r]);
        else
          left[r] = all[r];
    }
    return left;
  };

  // the folds
  const unsigned threads = options.decision.search.threads;
  const Folds by_manoeuvre = folds_by_manoeuvre(*input.observations, *input.repeats);
  Folds by_repeat = folds_by_repeat(*input.repeats);
  // an effect that one run alone shows can only be held out by halves
  if (!best.places.empty())
    by_repeat = with_halves(std::move(by_repeat),
                            halves_of_runs_alone(view, input.passage, decision.best, options.decision.evidence));
  stage.left = stage.residuals;
  if (!best.places.empty())
    stage.left = left_by(places_held_out(view, input.passage, decision.best, by_repeat, threads));
  // around the model: the nominal robot may fall in only one of two repeats where the real one does not
  Deviations spread = deviations_from_repeats(features, stage.left, *input.same_command_sequence);
  for (std::size_t r = 0; r < features.size(); ++r)
    if (spread.of_runs[r].size() > 0) spread.of_runs[r].array() *= noise_of_difference(features[r]).array();

  // the gap with repeats held out, and with manoeuvres held out if that differs
  stage.gap = measure_gap(view, stage.left, spread, options.seed);
  stage.gap_by_manoeuvre = stage.gap;
  if (!best.places.empty() && by_manoeuvre.size() > 1 && by_manoeuvre != by_repeat)
    stage.gap_by_manoeuvre =
        measure_gap(view, left_by(places_held_out(view, input.passage, decision.best, by_manoeuvre, threads)), spread,
                    options.seed);

  // the shares of each effect, and with them its name
  if (!decision.effects.empty()) {
    const SharesOfEffects shares =
        shares_of_effects(view, input.passage, decision.best, simulator_of(prepared, predictor), by_repeat,
                          by_manoeuvre, options.decision);
    judge(decision, prepared.candidates, shares.of_repeats, shares.of_manoeuvres, options.decision);
  }
}

// Whether only its value keeps an effect from a name.
bool has_doubtful_value(const ModelEffect& effect) {
  constexpr std::array kOfValue{Doubt::end_of_range, Doubt::disagreement, Doubt::trend};
  return !effect.doubts.empty() &&
         std::ranges::all_of(effect.doubts, [&](Doubt doubt) { return std::ranges::count(kOfValue, doubt) > 0; });
}

bool has_name(const StageDecision& decision, std::size_t candidate) {
  return std::ranges::any_of(decision.effects, [&](const ModelEffect& effect) {
    return effect.candidate == candidate && effect.doubts.empty();
  });
}

// Rivals of a replaced effect are also rivals of its replacement.
void add_rivals(StageDecision& decision, std::size_t effect, const StageDecision& before) {
  std::vector<std::size_t>& rivals = decision.effects[effect].rivals;
  for (const Settings& model : before.models_of_rivals[effect]) {
    const std::size_t candidate = model[effect].candidate;
    if (std::ranges::count(rivals, candidate) > 0) continue;
    rivals.push_back(candidate);
    decision.models_of_rivals[effect].push_back(model);
  }
  if (rivals.size() > 1) decision.verdict = Verdict::ambiguous;
}

// Widens intervals for errors of the description's numbers, and takes the names of effects away that such errors could
// be instead.
void allow_for_numbers(StageDiagnosis& stage, const PreparedStage& prepared, Predictor& predictor,
                       const StageOptions& options, const Elsewhere& elsewhere) {
  StageDecision& decision = stage.decision;
  const Model& best = decision.best.model;
  stage.numbers_off =
      numbers_off_of_intervals(decision.data, rest_of(decision.data, best), best.likelihood.discrepancies);
  const double numbers_off = std::max(stage.numbers_off, elsewhere.numbers_off);
  if (decision.effects.empty() || numbers_off == 0) return;
  // effects on the body turn a gyro, too, although they cannot cause its difference from the posture
  std::vector<std::size_t> of_all_stages(prepared.candidates.size());
  std::iota(of_all_stages.begin(), of_all_stages.end(), std::size_t{0});
  const EffectSet valued = effects_of(best);
  const NumbersOff numbers{.candidates = numbers_but(prepared.candidates, of_all_stages, valued),
                           .sigma = numbers_off,
                           .also_before = has_baseline(*prepared.input.features),
                           .also_without = !places_with_name(decision).empty()};
  const std::vector<ErrorOfValue> errors =
      errors_of_values(decision.data, decision.best, numbers, simulator_of(prepared, predictor), options.seed);
  for (std::size_t e = 0; e < decision.effects.size(); ++e) {
    ModelEffect& effect = decision.effects[e];
    effect.value.value = widened(effect.value.value, errors[e].half_width(), prepared.candidates[effect.candidate]);
    effect.sure_from = errors[e].four_sigma();
  }
  doubt_uncertain_values(decision, prepared.candidates);
}

// A significant but invisibly small difference without a name is no gap.
void drop_invisible_gap(StageDiagnosis& stage, const DecisionSettings& settings) {
  const double seen = stage.gap.before * stage.gap.before - stage.gap.floor * stage.gap.floor;
  if (stage.decision.verdict == Verdict::unknown && seen < settings.negligible * settings.negligible)
    stage.decision.verdict = Verdict::none;
}

}  // namespace

StageDiagnosis diagnose_stage(const PreparedStage& prepared, Predictor& predictor, const StageOptions& options,
                              const Elsewhere& elsewhere) {
  const StageInput& input = prepared.input;
  const std::span<const candidates::Candidate> candidates = prepared.candidates;
  const std::vector<StageFeatures>& features = *input.features;
  StageDiagnosis stage;
  stage.passage = input.passage;
  stage.residuals = prepared.residuals;
  if (prepared.nominal.data.groups.empty()) return stage;
  stage.nominal_floor = prepared.nominal.floor;
  stage.refuted = elsewhere.refuted;

  // the decision
  const Simulate simulate = simulator_of(prepared, predictor);
  std::vector<Settings> looks;
  const Around around = [&](const Settings& settings, std::span<const std::size_t> valued) {
    const Settings& looked_at = nearest_look(looks, settings, candidates);
    StageAround result{with_open_shapes(stage.nominal_floor, open_around(prepared, predictor, looked_at)), {}, {}};
    const auto shapes = has_baseline(features) ? number_shapes_of_change : number_shapes_around;
    const auto shapes_but = [&](std::span<const std::size_t> these) {
      return shapes(prepared.nominal.data, candidates, prepared.visible, looked_at, these, simulate);
    };
    result.floor.number_shapes = shapes_but(valued);
    result.shapes_of_all_numbers = shapes_but({});
    result.data = data_in(prepared, result.floor);
    return result;
  };
  const Deviations deviations = deviations_from_repeats(features, stage.residuals, *input.same_command_sequence);
  const GapTest test{inflation_from_repeats(features, stage.nominal_floor, deviations, options.stretch_s),
                     options.stretch_s};
  stage.decision = decide_stage(prepared.nominal, prepared.curves, simulate, around, test, options.decision, elsewhere);
  weigh(stage, prepared, predictor, options);
  const auto decided_again = [&](const OtherModel& other) {
    StageDiagnosis again = stage;
    again.decision = decide_again(stage.decision, other, simulate, around, test, options.decision, elsewhere);
    weigh(again, prepared, predictor, options);
    return again;
  };

  // among rivals, one whose value is not in doubt
  const auto rival_with_name = [&]() -> std::optional<StageDiagnosis> {
    for (std::size_t e = 0; e < stage.decision.effects.size(); ++e) {
      if (!has_doubtful_value(stage.decision.effects[e])) continue;
      const std::vector<std::size_t>& rivals = stage.decision.effects[e].rivals;
      for (std::size_t r = kItself + 1; r < rivals.size(); ++r) {
        StageDiagnosis again = decided_again(with_rival(stage.decision, e, r));
        if (!has_name(again.decision, rivals[r])) continue;
        add_rivals(again.decision, e, stage.decision);
        return again;
      }
    }
    return std::nullopt;
  };
  if (std::optional<StageDiagnosis> again = rival_with_name()) stage = std::move(*again);

  // without effects that are no causes: they take shares from others, and bend their values
  const auto with_alone = [&](const std::vector<std::size_t>& kept, std::size_t at_least_names) {
    if (kept.empty() || kept.size() == stage.decision.effects.size()) return;
    StageDiagnosis alone = decided_again(with_effects_alone(stage.decision, kept));
    if (places_with_name(alone.decision).size() >= at_least_names) stage = std::move(alone);
  };
  const std::size_t names = places_with_name(stage.decision).size();
  if (const std::vector<std::size_t> tried = places_to_try(stage.decision); tried != places_to_keep(stage.decision))
    with_alone(tried, names + 1);

  // only effects with a name and their look-alikes: a name that holds beside an effect without one alone may be half of
  // what the two do together, as a gain of both tracks and an asymmetry that cancels it on one of them
  const auto only_names = [&] {
    bool any_dropped = false;
    for (;; any_dropped = true) {
      const std::vector<std::size_t> kept = places_to_keep(stage.decision);
      if (places_with_name(stage.decision).empty() || kept.size() == stage.decision.effects.size()) return any_dropped;
      with_alone(kept, 0);
    }
  };
  do {
    only_names();
    allow_for_numbers(stage, prepared, predictor, options, elsewhere);
  } while (only_names());
  doubt_unless_simulated(stage.decision, stage.gap.explains.value, stage.gap_by_manoeuvre.explains.value,
                         options.decision);
  const StageDecision& decision = stage.decision;
  const Model& best = decision.best.model;

  drop_invisible_gap(stage, options.decision);

  // the residual, in words
  if (decision.verdict != Verdict::none && !decision.complete && input.passage != Passage::body_to_sensor)
    stage.left_over =
        left_over_of(input, predictor, varied(prepared, predictor, settings_of(best.places)), decision.floor);

  // where the gap is, and the share of each effect alone
  stage.before_si = rms_si(features, stage.residuals);
  stage.after_si = rms_si(features, stage.left);
  const Coherence coherence(features, *input.repeats, options.stretch_s);
  stage.where = locate(*input.observations, features, stage.nominal_floor, *input.repeats, coherence, stage.residuals);
  stage.where_left = locate(*input.observations, features, decision.floor, *input.repeats, coherence, stage.left);
  stage.isolability = isolability(decision.data, decision.best.curves);
  const double before = squares_in_noise(decision.data, residuals_of(decision.data));
  for (const Model& single : decision.singles) {
    const double after = squares_in_noise(decision.data, rest_of(decision.data, single));
    stage.ranking.push_back({single.places.front().curve, single.places.front().value,
                             decision.nominal_deviance - single.deviance(), before > 0 ? 1 - after / before : 0});
  }
  return stage;
}

}  // namespace kenaf::gap::diagnose
