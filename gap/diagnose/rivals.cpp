#include "gap/diagnose/rivals.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gap/diagnose/isolability.hpp"
#include "gap/parallel.hpp"

namespace kenaf::gap::diagnose {
namespace {

// At the angle below which two effects cannot be distinguished, the wrong one leaves this share of the squares that the
// right one explains: sin^2 of the angle.
const double kAlike = std::pow(std::sin(kDistinguishable_deg / 180 * std::numbers::pi), 2);
// Vuong's test: standard errors by which the best model must beat a rival over manoeuvres (one-sided 95 %), and the
// minimum number of manoeuvres.
constexpr double kBetter_sigma = 1.64;
constexpr std::size_t kFewestGroups = 4;
// Rivals simulated for each effect, and simulations of each.
constexpr std::size_t kMostRivals = 4;
constexpr int kRivalRounds = 2;

// Whether `best` is significantly better than `rival` over groups of repeats (Vuong 1989).
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

// The comparison of one effect of the best model with its rivals.
struct Contest {
  const StageData& data;
  const Model& best;
  std::size_t place;    // of the effect
  double accounted;     // squares that it explains
  EffectCurves curves;  // of the other effects together, of rivals alone
  // The best model's shift minus their sum: the interaction is assumed to be the same with a rival.
  GroupVectors beyond;
  const DecisionSettings& settings;
};

Contest contest_of(const StageData& data, const EffectCurves& alone, const StandingModel& standing, std::size_t place,
                   const Model& without, const DecisionSettings& settings) {
  const Model& best = standing.model;
  const double accounted = squares_in_noise(data, rest_of(data, without)) - squares_in_noise(data, rest_of(data, best));
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
  if (squares_in_noise(data, rest_of(data, model)) - squares_in_noise(data, rest_of(data, best)) < kAlike * accounted)
    return true;
  return !is_borne_out(data, best, model);
}

Model fitted_in(const Contest& contest, const EffectSet& set, const GroupVectors& beyond) {
  return fit_model(contest.data, contest.curves, set, beyond, contest.best.likelihood.discrepancies);
}

// Models with a rival in the effect's place that may fit as well, from curves; best first.
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

// Whether a rival substitutes for the effect: the fit is as good without the effect, or the effect gains nothing in
// addition to the rival. Otherwise the rival explains something else.
bool takes_its_place(const Contest& contest, const Model& rival) {
  if (rival.deviance() - contest.best.deviance() < contest.settings.rival_evidence) return true;
  EffectSet both = effects_of(rival);
  both.push_back(contest.best.places[contest.place].curve);
  return rival.deviance() - fitted_in(contest, both, contest.beyond).deviance() < contest.settings.evidence;
}

}  // namespace

std::vector<Settings> rivals_of(const StageData& data, const EffectCurves& curves, const StandingModel& standing,
                                std::size_t place, const Model& without, const Simulate& simulate,
                                const DecisionSettings& settings) {
  const Contest contest = contest_of(data, curves, standing, place, without, settings);
  std::vector<Settings> rivals{settings_of(contest.best.places)};
  for (Model fitted : rivals_on_curves(contest)) {
    if (!takes_its_place(contest, fitted)) continue;
    // simulates it, and again at its refit with the interaction that the sum of curves lacked
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

}  // namespace kenaf::gap::diagnose
