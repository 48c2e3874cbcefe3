#include "gap/diagnose/stage_decision.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "gap/diagnose/cells.hpp"
#include "gap/diagnose/rivals.hpp"
#include "gap/diagnose/significance.hpp"
#include "gap/parallel.hpp"

namespace kenaf::gap::diagnose {
namespace {

// Open shapes (noise_floor.hpp) come from simulations of a robot: of the nominal one, or of one with the effects of a
// model if that explains at least this share of the gap beyond numbers' errors (chosen). Those of a model that does not
// fit would be arbitrary.
constexpr double kFits = 0.5;

// Tests of a model's residual against noise and spread of repeats.
struct Chance {
  double p_cells = 1;      // p value of the residual energy in all cells
  double p_effect = 1;     // p value of the improvement by one more effect, the best of many
  double improvement = 0;  // squares that this effect explains, in units of noise
};

// `with`: the model with one more effect, if any.
Chance chance_of(const StageData& data, const Model& model, const Model* with, const EffectCurves& curves,
                 const GapTest& test, const DecisionSettings& settings) {
  Chance chance;
  chance.p_cells = cell_energy(data, rest_of(data, model), test.stretch_s).p_of_noise(test.inflation);
  if (with == nullptr) return chance;
  const auto left_by = [&](const Model& of) {
    return likelihood_with(data, rest_of(data, of), no_discrepancy()).chi_squared;
  };
  chance.improvement = left_by(model) - left_by(*with);
  const auto visible = static_cast<double>(
      std::ranges::count_if(curves.curves, [](const EffectCurve& curve) { return curve.visible > 1; }));
  // the margin of rival_evidence, 3 sigma, is for details of the simulator: half a time step moves every sensor by half
  // a millisecond, which is significant in little noise, and was taken for a delay of the posture sensor
  chance.p_effect = p_of_largest_square((chance.improvement - settings.rival_evidence) / test.inflation, visible);
  return chance;
}

// A significant excess in many cells, or an improvement by one effect that is significant and also large enough to be
// visible. Each test has half of the probability of a false alarm.
bool is_gap(const Chance& chance, const StageData& data, const DecisionSettings& settings) {
  const double negligible = settings.negligible * settings.negligible * static_cast<double>(bin_count(data));
  return chance.p_cells <= settings.false_alarm / 2 ||
         (chance.p_effect <= settings.false_alarm / 2 && chance.improvement >= negligible);
}

// Refits all models to other data.
void fit_again(std::vector<Model>& models, const StageData& data, const EffectCurves& curves, unsigned threads) {
  for_each_job(models.size(), threads, [&](std::size_t i) {
    const bool exact = models[i].exact;
    models[i] = fit_model(data, curves, effects_of(models[i]), {}, models[i].likelihood.discrepancies);
    models[i].exact = exact;
  });
  std::ranges::stable_sort(models, {}, [](const Model& model) { return model.deviance(); });
}

// The best set of effects, each with sufficient evidence, as long as there is a gap.
Model take_effects(const StageData& data, EffectCurves& curves, const std::vector<Model>& singles,
                   const Simulate& simulate, const GapTest& test, const DecisionSettings& settings) {
  Model best = singles.front();
  while (best.places.size() < settings.most_effects) {
    std::vector<EffectSet> sets = best.places.size() == 1 ? all_pairs(curves) : with_one_more(curves, effects_of(best));
    const std::vector<Model> more =
        search_sets(data, curves, best, settings.evidence / 2, simulate, settings.search, std::move(sets));
    if (more.empty() || best.deviance() - more.front().deviance() < settings.evidence) break;
    if (!is_gap(chance_of(data, best, &more.front(), curves, test, settings), data, settings)) break;
    best = more.front();
  }
  return best;
}

// Removes effects with insufficient evidence in addition to the others, weakest first.
StandingModel without_weak_effects(const StageData& data, const EffectCurves& curves, const Simulate& simulate,
                                   StandingModel best, const DecisionSettings& settings) {
  while (best.model.places.size() > 1) {
    std::vector<Model> without;
    for (std::size_t i = 0; i < best.model.places.size(); ++i) without.push_back(fit_without(data, best, {{i}}));
    const Model& weakest = *std::ranges::min_element(without, {}, [](const Model& model) { return model.deviance(); });
    if (weakest.deviance() - best.model.deviance() >= settings.evidence) break;
    best = fit_side_by_side(data, curves, simulate,
                            simulated_model(data, curves, simulate, settings_of(weakest.places), weakest));
  }
  return best;
}

// Whether the value is at an end of the range and would go beyond it.
bool is_at_bound(const StageData& data, const StandingModel& standing, std::size_t place, double margin) {
  constexpr double kAtBound = 1e-3;  // share of the range: a value closer to an end than this is at the end
  constexpr double kInside = 0.9;    // share of the way from the present value to the end: a value inside
  const OnCurve& at = standing.model.places[place];
  const candidates::Candidate& candidate = standing.curves.candidates[at.curve];
  const double same = kAtBound * (candidate.max - candidate.min);
  const auto is_end = [&](double end) { return end != candidate.neutral && std::abs(at.value - end) < same; };
  if (!is_end(candidate.min) && !is_end(candidate.max)) return false;
  // an effect that has saturated fits as well at a value inside the range
  std::vector<OnCurve> inside = standing.model.places;
  inside[place] =
      at_value(standing.curves.curves, at.curve, candidate.present + kInside * (at.value - candidate.present));
  Model model = standing.model;
  const GroupVectors beyond = beyond_curves(standing.curves, standing.model);
  model.shift = shift_of(standing.curves, inside);
  for (std::size_t g = 0; g < beyond.size(); ++g) model.shift[g] += beyond[g];
  return likelihood_with(data, rest_of(data, model), model.likelihood.discrepancies).deviance >
         standing.model.deviance() + margin;
}

// Sets values, evidence and rivals of the best model's effects.
void describe_effects(StageDecision& d, const EffectCurves& curves, const Simulate& simulate,
                      const DecisionSettings& settings) {
  d.effects.clear();
  d.models_of_rivals.clear();
  const std::vector<EffectValue> values = effect_values(d.data, d.best, settings.rival_evidence);
  for (std::size_t i = 0; i < d.best.model.places.size(); ++i) {
    const Model without = fit_without(d.data, d.best, {{i}});
    const double evidence = without.deviance() - d.best.model.deviance();
    ModelEffect effect{d.best.model.places[i].curve, values[i], evidence, {}, {}, false, {}, {}};
    effect.ordinarily_off =
        curves.candidates[effect.candidate].whole * d.best.model.likelihood.discrepancies.numbers_off;
    effect.at_bound = is_at_bound(d.data, d.best, i, settings.rival_evidence);
    d.models_of_rivals.push_back(rivals_of(d.data, curves, d.best, i, without, simulate, settings));
    for (const Settings& model : d.models_of_rivals.back()) effect.rivals.push_back(model[i].candidate);
    d.effects.push_back(std::move(effect));
  }
}

// Without what other stages refute: no search finds it.
EffectCurves not_refuted(EffectCurves curves, const Elsewhere& elsewhere) {
  std::vector<std::size_t> kept;
  for (const EffectCurve& curve : curves.curves)
    if (!elsewhere.refutes(curve.candidate)) kept.push_back(curve.candidate);
  forget_all_but(curves, kept);
  return curves;
}

// Describes the best model's effects with their rivals, none where another stage names the effect, and the residual. At
// most one effect is replaced by a rival, which another stage names: afterwards the model has other values and rivals,
// about which other stages have found nothing yet (settle_by_other_stages() asks them again).
void describe(StageDecision& d, const EffectCurves& curves, const Simulate& simulate, const GapTest& test,
              const DecisionSettings& settings, const Elsewhere& elsewhere) {
  describe_effects(d, curves, simulate, settings);
  for (std::size_t i = 0; i < d.effects.size(); ++i) {
    const std::optional<std::size_t> rival = settled_elsewhere(d, i, curves.candidates, elsewhere.named);
    if (!rival || *rival == kItself) continue;
    const Settings settled = d.models_of_rivals[i][*rival];
    d.best =
        fit_side_by_side(d.data, curves, simulate, simulated_model(d.data, curves, simulate, settled, d.best.model));
    describe_effects(d, curves, simulate, settings);
    break;
  }
  for (std::size_t i = 0; i < d.effects.size(); ++i) {
    if (settled_elsewhere(d, i, curves.candidates, elsewhere.named) != kItself) continue;
    d.effects[i].is_named_elsewhere = true;
    d.effects[i].rivals.resize(kItself + 1);
    d.models_of_rivals[i].resize(kItself + 1);
  }
  d.p_left = cell_energy(d.data, rest_of(d.data, d.best.model), test.stretch_s).p_of_noise(test.inflation);
  d.complete = d.p_left > settings.false_incomplete;
}

void take(StageDecision& d, StageAround there) {
  d.floor = std::move(there.floor);
  d.data = std::move(there.data);
  d.shapes_of_all_numbers = std::move(there.shapes_of_all_numbers);
}

}  // namespace

std::string_view verdict_name(Verdict verdict) {
  constexpr std::string_view kNames[] = {"none", "named", "ambiguous", "unknown"};
  return kNames[static_cast<std::size_t>(verdict)];
}

std::optional<std::size_t> settled_elsewhere(const StageDecision& decision, std::size_t effect,
                                             std::span<const candidates::Candidate> candidates,
                                             std::span<const NamedElsewhere> elsewhere) {
  const ModelEffect& chosen = decision.effects[effect];
  const Interval& own = chosen.value.value;
  const double change = std::abs(own.value - candidates[chosen.candidate].present);
  for (std::size_t r = 0; r < decision.models_of_rivals[effect].size(); ++r)
    for (const NamedElsewhere& other : elsewhere) {
      const Setting& rival = decision.models_of_rivals[effect][r][effect];
      if (rival.candidate != other.candidate) continue;
      // a rival has the relative uncertainty of the effect that it replaces
      const double half =
          (own.to - own.from) / 2 / change * std::abs(rival.value - candidates[rival.candidate].present);
      const double apart = std::abs(rival.value - other.value.value);
      if (apart <= half + (other.value.to - other.value.from) / 2) return r;
    }
  return std::nullopt;
}

StageDecision decide_stage(const StageAround& nominal, const EffectCurves& known, const Simulate& simulate,
                           const Around& around, const GapTest& test, const DecisionSettings& settings,
                           const Elsewhere& elsewhere) {
  // the nominal model and the best single effects
  StageDecision d;
  d.curves = not_refuted(known, elsewhere);
  EffectCurves& curves = d.curves;
  take(d, nominal);
  const Model without = nominal_model(d.data);
  d.nominal_deviance = without.deviance();
  d.best = {without, curves};
  d.singles = search_singles(d.data, curves, without.likelihood.discrepancies, simulate, settings.search);
  d.best.curves = curves;

  // whether the gap is beyond chance
  const auto has_gap = [&] {
    const Chance chance = chance_of(d.data, nominal_model(d.data), d.singles.empty() ? nullptr : &d.singles.front(),
                                    curves, test, settings);
    d.p_left = chance.p_cells;
    d.p_gap = std::min(1.0, 2 * std::min(chance.p_effect, chance.p_cells));
    return is_gap(chance, d.data, settings);
  };
  if (!has_gap()) return d;
  d.verdict = Verdict::unknown;
  if (d.singles.empty() || d.nominal_deviance - d.singles.front().deviance() < settings.evidence) return d;

  // open shapes of the robot with a model that fits, instead of those of the nominal one
  const auto left_by = [&](const Model& model) {
    return squares_in_noise(d.data,
                            without_shared_shapes(d.data, rest_of(d.data, model), model.likelihood.discrepancies));
  };
  const auto look_around = [&](const Model& model) {
    if (left_by(model) > (1 - kFits) * left_by(nominal_model(d.data))) return false;
    take(d, around(settings_of(model.places), effects_of(model)));
    return true;
  };
  if (look_around(d.singles.front())) {
    fit_again(d.singles, d.data, curves, settings.search.threads);
    d.nominal_deviance = nominal_model(d.data).deviance();
    if (!has_gap()) {
      d.verdict = Verdict::none;
      return d;
    }
  }

  // adds effects while each gains evidence, then refits them together
  Model chosen = take_effects(d.data, curves, d.singles, simulate, test, settings);
  if (chosen.places.size() > 1 && look_around(chosen)) {
    fit_again(d.singles, d.data, curves, settings.search.threads);
    chosen.likelihood = likelihood_of(d.data, rest_of(d.data, chosen), chosen.likelihood.discrepancies);
  }
  d.nominal_deviance = nominal_model(d.data).deviance();
  d.best = without_weak_effects(d.data, curves, simulate, fit_side_by_side(d.data, curves, simulate, std::move(chosen)),
                                settings);
  describe(d, curves, simulate, test, settings, elsewhere);
  return d;
}

bool is_misfit_of_kinds(Doubt doubt) {
  return doubt == Doubt::leaves_much || doubt == Doubt::kinds_differ;
}

OtherModel with_effects_alone(const StageDecision& decided, std::span<const std::size_t> places) {
  OtherModel other{{}, settings_of(decided.best.model.places)};
  for (const std::size_t place : places) other.model.push_back(other.around[place]);
  return other;
}

OtherModel with_rival(const StageDecision& decided, std::size_t effect, std::size_t rival) {
  const Settings& model = decided.models_of_rivals[effect][rival];
  return {model, model};
}

StageDecision decide_again(StageDecision decided, const OtherModel& other, const Simulate& simulate,
                           const Around& around, const GapTest& test, const DecisionSettings& settings,
                           const Elsewhere& elsewhere) {
  StageDecision d = std::move(decided);
  std::vector<std::size_t> candidates;
  for (const Setting& setting : other.model) candidates.push_back(setting.candidate);
  take(d, around(other.around, candidates));
  d.nominal_deviance = nominal_model(d.data).deviance();
  fit_again(d.singles, d.data, d.curves, settings.search.threads);
  d.best = fit_side_by_side(d.data, d.curves, simulate,
                            simulated_model(d.data, d.curves, simulate, other.model, d.best.model));
  describe(d, d.curves, simulate, test, settings, elsewhere);
  return d;
}

}  // namespace kenaf::gap::diagnose
