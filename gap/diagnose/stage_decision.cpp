#include "gap/diagnose/stage_decision.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "gap/diagnose/cells.hpp"
#include "gap/diagnose/isolability.hpp"
#include "gap/diagnose/significance.hpp"
#include "gap/parallel.hpp"

namespace kenaf::gap {
namespace {

// At the angle below which two effects cannot be told apart, the one that is not there leaves this share of what the
// other one accounts for.
const double kAlike = std::pow(std::sin(kToldApart_deg / 180 * std::numbers::pi), 2);
// Of what a gap has beyond numbers that are a little off, so much must a model take off before the simulation's open
// shapes are taken around it (chosen): around one that does not fit, the simulation may leave anything open.
constexpr double kFits = 0.5;
// Vuong's test: standard errors by which the best model must be better than a rival over manoeuvres (one-sided 95 %),
// from as many manoeuvres on.
constexpr double kBetter_sigma = 1.64;
constexpr std::size_t kFewestGroups = 4;
// Rivals that are tried by simulation, for each effect, and how often each.
constexpr std::size_t kMostRivals = 4;
constexpr int kRivalRounds = 2;

// Squared length of what is left, in noise alone.
double squared(const StageData& data, const GroupVectors& rest) {
  return std::pow(length_in_noise(data, rest), 2);
}

// Whether what a model leaves is more than noise and spread of repeats leave.
struct Chance {
  double p_cells = 1;      // that noise leaves as much, in as many places
  double p_effect = 1;     // that in noise some effect would explain as much as a given one does
  double improvement = 0;  // what that one explains, in noise alone
};

// `with`: the model with one effect more, if there is one.
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
  chance.p_effect = p_of_largest_square((chance.improvement - settings.rival_evidence) / test.inflation, visible);
  return chance;
}

// In many places at once, or so large that somebody would see it.
bool is_gap(const Chance& chance, const StageData& data, const DecisionSettings& settings) {
  const double negligible = settings.negligible * settings.negligible * static_cast<double>(bin_count(data));
  return chance.p_cells <= settings.false_alarm / 2 ||
         (chance.p_effect <= settings.false_alarm / 2 && chance.improvement >= negligible);
}

// Fitted again, all of them, in other data.
void fit_again(std::vector<Model>& models, const StageData& data, const EffectCurves& curves, unsigned threads) {
  for_each_job(models.size(), threads, [&](std::size_t i) {
    const bool exact = models[i].exact;
    models[i] = fit_model(data, curves, effects_of(models[i]), {}, models[i].likelihood.discrepancies);
    models[i].exact = exact;
  });
  std::ranges::stable_sort(models, {}, [](const Model& model) { return model.deviance(); });
}

// The best set of effects, each of which gains what evidence asks for, as long as there is a gap.
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

Model without_effect(const StageData& data, const StandingModel& standing, std::size_t place) {
  EffectSet others = effects_of(standing.model);
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(place));
  if (others.empty()) return nominal_model(data);
  return fit_model(data, standing.curves, others, {}, standing.model.likelihood.discrepancies);
}

// As it simulates at `settings`. `like`: another model of as many effects, with whose discrepancies the estimate
// begins.
Model simulated_model(const StageData& data, const EffectCurves& curves, const Simulate& simulate,
                      const Settings& settings, const Model& like) {
  Model model{{}, simulate(std::vector<Settings>{settings}, Fidelity::every_run).front(), true, {}};
  for (const Setting& setting : settings)
    model.places.push_back(at_value(curves.curves, setting.candidate, setting.value));
  model.likelihood = likelihood_of(data, rest_of(data, model), like.likelihood.discrepancies);
  return model;
}

// Without effects that gain too little where they stand, the weakest first.
StandingModel without_weak_effects(const StageData& data, const EffectCurves& curves, const Simulate& simulate,
                                   StandingModel best, const DecisionSettings& settings) {
  while (best.model.places.size() > 1) {
    std::vector<Model> without;
    for (std::size_t i = 0; i < best.model.places.size(); ++i) without.push_back(without_effect(data, best, i));
    const Model& weakest = *std::ranges::min_element(without, {}, [](const Model& model) { return model.deviance(); });
    if (weakest.deviance() - best.model.deviance() >= settings.evidence) break;
    best = fit_side_by_side(data, curves, simulate,
                            simulated_model(data, curves, simulate, settings_of(weakest.places), weakest));
  }
  return best;
}

// The value at an end of the range, of an effect that would go on there.
bool is_at_bound(const StageData& data, const StandingModel& standing, std::size_t place, double margin) {
  constexpr double kAtBound = 1e-3, kInside = 0.9;  // of the range, of the way from the present value
  const OnCurve& at = standing.model.places[place];
  const Candidate& candidate = standing.curves.candidates[at.curve];
  const double same = kAtBound * (candidate.max - candidate.min);
  const auto is_end = [&](double end) { return end != candidate.neutral && std::abs(at.value - end) < same; };
  if (!is_end(candidate.min) && !is_end(candidate.max)) return false;
  // one that does no more by then fits as well inside
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

// Whether manoeuvres bear out that `best` is better than `rival` (Vuong 1989, over groups of repeats).
bool is_borne_out(const StageData& data, const Model& best, const Model& rival) {
  const std::vector<double> a = deviance_of_groups(data, rest_of(data, best), best.likelihood.discrepancies),
                            b = deviance_of_groups(data, rest_of(data, rival), rival.likelihood.discrepancies);
  if (a.size() < kFewestGroups) return true;
  double sum = 0, squares = 0;
  for (std::size_t g = 0; g < a.size(); ++g) sum += b[g] - a[g], squares += (b[g] - a[g]) * (b[g] - a[g]);
  const auto count = static_cast<double>(a.size());
  const double variance = std::max(0.0, squares - sum * sum / count) / (count - 1) * count;
  return sum > kBetter_sigma * std::sqrt(variance);
}

// What rivals of one effect of the best model are measured by.
struct Contest {
  const StageData& data;
  const Model& best;
  std::size_t place;    // of the effect
  double accounted;     // squares that it takes off
  EffectCurves curves;  // of the others where they stand, of rivals as they are alone
  // What the best model shifts beyond their sum: what effects do to each other they do with a rival, too.
  GroupVectors beyond;
  const DecisionSettings& settings;
};

Contest contest_of(const StageData& data, const EffectCurves& alone, const StandingModel& standing, std::size_t place,
                   const Model& without, const DecisionSettings& settings) {
  const Model& best = standing.model;
  const double accounted = squared(data, rest_of(data, without)) - squared(data, rest_of(data, best));
  Contest contest{data, best, place, accounted, alone, {}, settings};
  for (std::size_t p = 0; p < best.places.size(); ++p)
    if (const std::size_t c = best.places[p].curve; p != place) contest.curves.curves[c] = standing.curves.curves[c];
  contest.curves.shifts = standing.curves.shifts;
  Model on_curves = best;
  for (OnCurve& at : on_curves.places) at = at_value(contest.curves.curves, at.curve, at.value);
  contest.beyond = beyond_curves(contest.curves, on_curves);
  return contest;
}

bool is_rival(const Contest& contest, const Model& model) {
  const auto& [data, best, place, accounted, curves, beyond, settings] = contest;
  if (model.deviance() - best.deviance() < settings.rival_evidence) return true;
  if (squared(data, rest_of(data, model)) - squared(data, rest_of(data, best)) < kAlike * accounted) return true;
  return !is_borne_out(data, best, model);
}

Model fitted_in(const Contest& contest, const EffectSet& set, const GroupVectors& beyond) {
  return fit_model(contest.data, contest.curves, set, beyond, contest.best.likelihood.discrepancies);
}

// Models with a rival in the effect's place that may do as well, by curves; best first.
std::vector<Model> rivals_on_curves(const Contest& contest) {
  const auto& [data, best, place, accounted, curves, beyond, settings] = contest;
  std::vector<EffectSet> sets;
  for (std::size_t c = 0; c < curves.curves.size(); ++c) {
    if (has_effect(best, c) || curves.curves[c].visible <= 1 || curves.curves[c].points.size() < 2) continue;
    sets.push_back(effects_of(best));
    sets.back()[place] = c;
  }
  std::vector<Model> models(sets.size());
  for_each_job(sets.size(), settings.search.threads,
               [&](std::size_t i) { models[i] = fitted_in(contest, sets[i], contest.beyond); });
  std::erase_if(models, [&](const Model& model) {
    return !is_rival(contest, model) &&
           model.deviance() - contest.best.deviance() > 3 * contest.settings.rival_evidence;
  });
  std::ranges::stable_sort(models, {}, [](const Model& model) { return model.deviance(); });
  if (models.size() > kMostRivals) models.resize(kMostRivals);
  return models;
}

// Whether a rival takes the effect's place, so that without the effect all is as well, or beside it the effect gains
// nothing; one that does otherwise explains something else.
bool takes_its_place(const Contest& contest, const Model& rival) {
  if (rival.deviance() - contest.best.deviance() < contest.settings.rival_evidence) return true;
  EffectSet both = effects_of(rival);
  both.push_back(contest.best.places[contest.place].curve);
  return rival.deviance() - fitted_in(contest, both, contest.beyond).deviance() < contest.settings.evidence;
}

// Models with a rival in the place of one effect, the best model itself first. `without`: the best one without the
// effect.
std::vector<Settings> rivals_of(const StageData& data, const EffectCurves& curves, const StandingModel& standing,
                                std::size_t place, const Model& without, const Simulate& simulate,
                                const DecisionSettings& settings) {
  const Contest contest = contest_of(data, curves, standing, place, without, settings);
  std::vector<Settings> rivals{settings_of(contest.best.places)};
  for (Model fitted : rivals_on_curves(contest)) {
    if (!takes_its_place(contest, fitted)) continue;
    // by simulation, and by another one where it fits with what the sum of curves lacked
    for (int round = 0; round < kRivalRounds; ++round) {
      const Settings asked = settings_of(fitted.places);
      const Model simulated = simulated_model(data, contest.curves, simulate, asked, fitted);
      if (is_rival(contest, simulated)) {
        rivals.push_back(asked);
        break;
      }
      fitted = fitted_in(contest, effects_of(fitted), beyond_curves(contest.curves, simulated));
      if (!is_rival(contest, fitted)) break;
    }
  }
  return rivals;
}

// Values, evidence and rivals of the best model's effects.
void describe_effects(StageDecision& d, const EffectCurves& curves, const Simulate& simulate,
                      const DecisionSettings& settings) {
  d.effects.clear();
  d.models_of_rivals.clear();
  const std::vector<EffectValue> values = effect_values(d.data, d.best);
  for (std::size_t i = 0; i < d.best.model.places.size(); ++i) {
    const Model without = without_effect(d.data, d.best, i);
    const double evidence = without.deviance() - d.best.model.deviance();
    NamedEffect effect{d.best.model.places[i].curve, values[i], evidence, {}, {}, false, {}, {}};
    effect.ordinarily_off =
        curves.candidates[effect.candidate].whole * d.best.model.likelihood.discrepancies.numbers_off;
    effect.at_bound = is_at_bound(d.data, d.best, i, settings.rival_evidence);
    d.models_of_rivals.push_back(rivals_of(d.data, curves, d.best, i, without, simulate, settings));
    for (const Settings& model : d.models_of_rivals.back()) effect.rivals.push_back(model[i].candidate);
    d.effects.push_back(std::move(effect));
  }
}

// The best model's effects, of rivals the one that another stage names, and what is left.
void describe(StageDecision& d, const EffectCurves& curves, const Simulate& simulate, const GapTest& test,
              const DecisionSettings& settings, std::span<const NamedElsewhere> elsewhere) {
  describe_effects(d, curves, simulate, settings);
  for (std::size_t i = 0; i < d.effects.size(); ++i) {
    const std::optional<std::size_t> rival = settled_elsewhere(d, i, curves.candidates, elsewhere);
    if (!rival || *rival == 0) continue;
    const Settings settled = d.models_of_rivals[i][*rival];
    d.best =
        fit_side_by_side(d.data, curves, simulate, simulated_model(d.data, curves, simulate, settled, d.best.model));
    describe_effects(d, curves, simulate, settings);
    break;
  }
  for (std::size_t i = 0; i < d.effects.size(); ++i) {
    if (settled_elsewhere(d, i, curves.candidates, elsewhere) != 0) continue;
    d.effects[i].rivals.resize(1);
    d.models_of_rivals[i].resize(1);
  }
  d.p_left = cell_energy(d.data, rest_of(d.data, d.best.model), test.stretch_s).p_of_noise(test.inflation);
  d.complete = d.p_left > settings.surprise;
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
                                             std::span<const Candidate> candidates,
                                             std::span<const NamedElsewhere> elsewhere) {
  const NamedEffect& chosen = decision.effects[effect];
  const Interval& own = chosen.value.value;
  const double change = std::abs(own.value - candidates[chosen.candidate].present);
  for (std::size_t r = 0; r < decision.models_of_rivals[effect].size(); ++r)
    for (const NamedElsewhere& other : elsewhere) {
      const Setting& rival = decision.models_of_rivals[effect][r][effect];
      if (rival.candidate != other.candidate) continue;
      // a rival is known as well as the effect that it stands for, in parts of what it changes
      const double half =
          (own.to - own.from) / 2 / change * std::abs(rival.value - candidates[rival.candidate].present);
      const double apart = std::abs(rival.value - other.value.value);
      if (apart <= half + (other.value.to - other.value.from) / 2) return r;
    }
  return std::nullopt;
}

StageDecision decide_stage(const StageAround& nominal, const EffectCurves& known, const Simulate& simulate,
                           const Around& around, const GapTest& test, const DecisionSettings& settings,
                           std::span<const NamedElsewhere> elsewhere) {
  EffectCurves curves = known;
  StageDecision d;
  take(d, nominal);
  const Model without = nominal_model(d.data);
  d.nominal_deviance = without.deviance();
  d.best = {without, curves};
  d.singles = search_singles(d.data, curves, without.likelihood.discrepancies, simulate, settings.search);
  d.best.curves = curves;

  // what is beyond chance
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

  // what the simulation leaves open is taken around a model that fits, no longer around the nominal one
  const auto left_by = [&](const Model& model) {
    return squared(d.data, without_shared_shapes(d.data, rest_of(d.data, model), model.likelihood.discrepancies));
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

  // effects as long as each gains evidence, fitted where they stand
  Model chosen = take_effects(d.data, curves, d.singles, simulate, test, settings);
  if (chosen.places.size() > 1 && look_around(chosen))
    chosen.likelihood = likelihood_of(d.data, rest_of(d.data, chosen), chosen.likelihood.discrepancies);
  d.nominal_deviance = nominal_model(d.data).deviance();
  d.best = without_weak_effects(d.data, curves, simulate, fit_side_by_side(d.data, curves, simulate, std::move(chosen)),
                                settings);
  describe(d, curves, simulate, test, settings, elsewhere);
  return d;
}

StageDecision with_effects_alone(StageDecision decided, std::span<const std::size_t> places, const EffectCurves& curves,
                                 const Simulate& simulate, const Around& around, const GapTest& test,
                                 const DecisionSettings& settings, std::span<const NamedElsewhere> elsewhere) {
  StageDecision d = std::move(decided);
  const Settings all = settings_of(d.best.model.places);
  Settings kept;
  std::vector<std::size_t> candidates;
  for (const std::size_t place : places) {
    kept.push_back(all[place]);
    candidates.push_back(all[place].candidate);
  }
  take(d, around(all, candidates));
  d.nominal_deviance = nominal_model(d.data).deviance();
  d.best = fit_side_by_side(d.data, curves, simulate, simulated_model(d.data, curves, simulate, kept, d.best.model));
  describe(d, curves, simulate, test, settings, elsewhere);
  return d;
}

}  // namespace kenaf::gap
