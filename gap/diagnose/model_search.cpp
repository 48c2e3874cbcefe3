#include "gap/diagnose/model_search.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "gap/parallel.hpp"

namespace kenaf::gap::diagnose {
namespace {

// Factors on the distance from the present value at which a curve is simulated on either side of a fit, to capture its
// bend.
constexpr double kBracket = 1.3, kExactBracket = 1.15;
constexpr double kNear = 0.3;       // of the way to one of these
constexpr double kSettled = 0.005;  // of the value: a fit that moves less gains nothing from another point
constexpr int kFitRounds = 2;       // alternating values and discrepancies
constexpr double kMostBehind = 30;  // deviance tolerance of a finalist, if larger than `near`

// The columns of some effects, and curves with the new column numbers.
struct Selection {
  std::vector<EffectCurve> curves;
  std::vector<Eigen::MatrixXd> shifts;
  std::vector<int> column;  // original column of each selected one
};

Selection selected(const EffectCurves& curves, std::span<const std::size_t> effects) {
  Selection selection;
  for (const std::size_t effect : effects) {
    selection.curves.push_back(curves.curves[effect]);
    for (CurvePoint& point : selection.curves.back().points) {
      if (point.column < 0) continue;
      selection.column.push_back(point.column);
      point.column = static_cast<int>(selection.column.size()) - 1;
    }
  }
  for (const Eigen::MatrixXd& group : curves.shifts) selection.shifts.emplace_back(group(Eigen::all, selection.column));
  return selection;
}

OnCurve in_whole(OnCurve place, const Selection& selection, std::span<const std::size_t> effects) {
  place.curve = effects[place.curve];
  for (int& column : place.column)
    if (column >= 0) column = selection.column[static_cast<std::size_t>(column)];
  return place;
}

bool is_visible(const EffectCurve& curve) {
  return curve.visible > 1 && curve.points.size() > 1;
}

// Each of `sets`, fitted on the curves and `beyond`, in their order.
std::vector<Model> fit_all(const StageData& data, const EffectCurves& curves, std::span<const EffectSet> sets,
                           const GroupVectors& beyond, const Discrepancies& start, unsigned threads) {
  std::vector<Model> models(sets.size());
  for_each_job(sets.size(), threads,
               [&](std::size_t i) { models[i] = fit_model(data, curves, sets[i], beyond, start); });
  return models;
}

// The number of leading models close enough to overtake the best one.
std::size_t near_best(std::span<const Model> sorted, double nominal_deviance, const SearchSettings& settings) {
  if (sorted.empty()) return 0;
  const double best = sorted.front().deviance();
  const double limit = best + std::max(kMostBehind, settings.near * (nominal_deviance - best));
  std::size_t count = 0;
  while (count < std::min(settings.finalists, sorted.size()) && sorted[count].deviance() <= limit) ++count;
  return count;
}

// The fitted value and one on either side of it, unless the curve has a point near them.
std::vector<Setting> points_around(const EffectCurves& curves, const OnCurve& place, double bracket, bool exact) {
  const candidates::Candidate& candidate = curves.candidates[place.curve];
  const std::vector<CurvePoint>& points = curves.curves[place.curve].points;
  const double reach = place.value - candidate.present;
  if (reach == 0) return {};
  std::vector<Setting> result;
  for (const double factor : {1.0, 1 / bracket, bracket}) {
    const double value = std::clamp(candidate.present + factor * reach, candidate.min, candidate.max);
    const double near = factor == 1 ? kSettled * std::abs(reach) : kNear * std::abs(reach) * (bracket - 1);
    const bool is_known = std::ranges::any_of(points, [&](const CurvePoint& point) {
      return point.column >= 0 && (point.exact || !exact) && std::abs(point.value - value) <= near;
    });
    if (!is_known) result.push_back({place.curve, value});
  }
  return result;
}

// Keeps a simulated model if it is better than the ones before.
void keep_better(Model& best, const StageData& data, const Model& fitted, GroupVectors shift) {
  Model simulated{fitted.places, std::move(shift), true, {}};
  simulated.likelihood = likelihood_of(data, rest_of(data, simulated), fitted.likelihood.discrepancies);
  if (!best.exact || simulated.deviance() < best.deviance()) best = std::move(simulated);
}

// Whether it is at the end of the known curve, but not of the range.
bool ends_early(const EffectCurves& curves, const OnCurve& place) {
  const candidates::Candidate& candidate = curves.candidates[place.curve];
  const std::vector<CurvePoint>& points = curves.curves[place.curve].points;
  return (place.value <= points.front().value && points.front().value > candidate.min) ||
         (place.value >= points.back().value && points.back().value < candidate.max);
}

// Extends curves over the whole range for effects that fit best at a premature end: one that did not matter beneath the
// nominal discrepancy may matter together with another effect. Returns whether there were any.
bool follow_early_ends(EffectCurves& curves, const StageData& data, std::span<const Model> fitted,
                       const Simulate& simulate) {
  std::set<std::size_t> early;
  for (const Model& model : fitted)
    for (const OnCurve& place : model.places)
      if (ends_early(curves, place)) early.insert(place.curve);
  const std::vector<std::size_t> chosen(early.begin(), early.end());
  add_spread(curves, data, chosen, simulate);
  follow_bends(curves, data, chosen, simulate);
  return !chosen.empty();
}

// A set on its way through the search: fitted on curves, and the best of its simulations.
struct Contender {
  EffectSet set;
  Model fitted, best;
};

// Simulates each contender at its fit, and refits it with the interaction that the sum of curves lacked.
void simulate_sets(std::vector<Contender>& contenders, const StageData& data, const EffectCurves& curves,
                   const Simulate& simulate, Fidelity fidelity, unsigned threads) {
  std::vector<Settings> asked;
  std::vector<EffectSet> sets;
  for (const Contender& contender : contenders) {
    asked.push_back(settings_of(contender.fitted.places));
    sets.push_back(contender.set);
  }
  const std::vector<GroupVectors> shifts = simulate(asked, fidelity);
  std::vector<GroupVectors> beyond;
  for (std::size_t i = 0; i < contenders.size(); ++i) {
    Model& fitted = contenders[i].fitted;
    fitted.shift = shifts[i];
    beyond.push_back(beyond_curves(curves, fitted));
  }
  for_each_job(contenders.size(), threads, [&](std::size_t i) {
    Contender& contender = contenders[i];
    if (fidelity == Fidelity::fine) keep_better(contender.best, data, contender.fitted, shifts[i]);
    contender.fitted = fit_model(data, curves, sets[i], beyond[i], contender.fitted.likelihood.discrepancies);
  });
}

void sort_by_deviance(std::vector<Model>& models) {
  std::ranges::stable_sort(models, {}, [](const Model& model) { return model.deviance(); });
}

}  // namespace

GroupVectors residuals_of(const StageData& data) {
  GroupVectors residuals;
  for (const StageGroup& group : data.groups) residuals.push_back(group.residual);
  return residuals;
}

GroupVectors rest_of(const StageData& data, const Model& model) {
  return less(residuals_of(data), model.shift);
}

bool has_effect(const Model& model, std::size_t candidate) {
  return std::ranges::any_of(model.places, [&](const OnCurve& place) { return place.curve == candidate; });
}

EffectSet effects_of(const Model& model) {
  EffectSet effects;
  for (const OnCurve& place : model.places) effects.push_back(place.curve);
  return effects;
}

Model nominal_model(const StageData& data) {
  Model model{{}, {}, true, {}};
  for (const StageGroup& group : data.groups) model.shift.push_back(Eigen::VectorXd::Zero(group.residual.size()));
  model.likelihood = likelihood_of(data, residuals_of(data), no_discrepancy());
  return model;
}

Model simulated_model(const StageData& data, const EffectCurves& curves, const Simulate& simulate,
                      const Settings& settings, const Model& like) {
  Model model{{}, simulate(std::vector<Settings>{settings}, Fidelity::every_run).front(), true, {}};
  for (const Setting& setting : settings)
    model.places.push_back(at_value(curves.curves, setting.candidate, setting.value));
  model.likelihood = likelihood_of(data, rest_of(data, model), like.likelihood.discrepancies);
  return model;
}

GroupVectors beyond_curves(const EffectCurves& curves, const Model& model) {
  return less(model.shift, shift_of(curves, model.places));
}

namespace {
// The curves of some effects, and what is fitted to them.
struct FittedCurves {
  const EffectCurves& all;
  std::span<const std::size_t> effects;
  const GroupVectors& beyond;
  Selection selection;
  GroupVectors target;
  EffectSet numbers;  // of the selection

  FittedCurves(const StageData& data, const EffectCurves& curves, std::span<const std::size_t> of,
               const GroupVectors& and_beyond)
      : all(curves),
        effects(of),
        beyond(and_beyond),
        selection(selected(curves, of)),
        target(beyond.empty() ? residuals_of(data) : less(residuals_of(data), beyond)) {
    for (std::size_t e = 0; e < effects.size(); ++e) numbers.push_back(e);
  }
};

// Fits by generalised least squares.
void fit_places(const StageData& data, const FittedCurves& fitted, const Discrepancies& discrepancies, Model& model) {
  const Products products = products_of(whiteners_of(data, discrepancies), fitted.selection.shifts, fitted.target);
  model.places.clear();
  for (const OnCurve& place : fit_together(products, fitted.selection.curves, fitted.numbers).places)
    model.places.push_back(in_whole(place, fitted.selection, fitted.effects));
  model.shift = shift_of(fitted.all, model.places);
  if (fitted.beyond.empty()) return;
  for (std::size_t g = 0; g < model.shift.size(); ++g) model.shift[g] += fitted.beyond[g];
}
}  // namespace

Model fit_values(const StageData& data, const EffectCurves& curves, std::span<const std::size_t> effects,
                 const GroupVectors& beyond, const Discrepancies& discrepancies) {
  Model model;
  fit_places(data, {data, curves, effects, beyond}, discrepancies, model);
  model.likelihood = likelihood_with(data, rest_of(data, model), discrepancies);
  return model;
}

Model fit_model(const StageData& data, const EffectCurves& curves, std::span<const std::size_t> effects,
                const GroupVectors& beyond, const Discrepancies& start) {
  const FittedCurves fitted(data, curves, effects, beyond);
  // values, then the discrepancies that suit what they leave
  const auto fitted_from = [&](const Discrepancies& from) {
    Model model;
    model.likelihood.discrepancies = from;
    for (int round = 0; round < kFitRounds; ++round) {
      fit_places(data, fitted, model.likelihood.discrepancies, model);
      model.likelihood = likelihood_of(data, rest_of(data, model), model.likelihood.discrepancies);
    }
    return model;
  };

  // discrepancies or numbers' errors that already absorb an effect hide it; with noise alone they cannot
  Model best = fitted_from(start);
  Model plain = fitted_from(no_discrepancy());
  return plain.deviance() < best.deviance() ? plain : best;
}

std::vector<Model> search_singles(const StageData& data, EffectCurves& curves, const Discrepancies& start,
                                  const Simulate& simulate, const SearchSettings& settings) {
  const double nominal = likelihood_of(data, residuals_of(data), start).deviance;
  std::vector<EffectSet> sets;
  for (std::size_t c = 0; c < curves.curves.size(); ++c)
    if (is_visible(curves.curves[c])) sets.push_back({c});
  std::vector<Model> models = fit_all(data, curves, sets, {}, start, settings.threads);
  sort_by_deviance(models);

  // the leading ones with points at their fits
  const auto worth_it = [&](std::size_t most) {
    std::size_t count = 0;
    while (count < std::min(most, models.size()) && nominal - models[count].deviance() >= settings.worth) ++count;
    return count;
  };
  for (int round = 0; round < settings.rounds; ++round) {
    std::vector<Setting> points;
    const std::size_t count = worth_it(settings.contenders);
    for (std::size_t i = 0; i < count; ++i)
      std::ranges::copy(points_around(curves, models[i].places.front(), kBracket, false), std::back_inserter(points));
    if (points.empty()) break;
    add_points(curves, data, points, Fidelity::coarse, simulate);
    for_each_job(count, settings.threads, [&](std::size_t i) {
      models[i] = fit_model(data, curves, effects_of(models[i]), {}, models[i].likelihood.discrepancies);
    });
    sort_by_deviance(models);
  }

  // the best of them at the full rate
  const std::size_t finalists = worth_it(near_best(models, nominal, settings));
  std::vector<Contender> contenders;
  for (std::size_t i = 0; i < finalists; ++i) contenders.push_back({effects_of(models[i]), models[i], {}});
  for (int round = 0; round < settings.exact_rounds; ++round) {
    std::vector<Setting> points;
    for (const Contender& contender : contenders)
      std::ranges::copy(points_around(curves, contender.fitted.places.front(), kExactBracket, true),
                        std::back_inserter(points));
    if (points.empty()) break;
    add_points(curves, data, points, Fidelity::fine, simulate);
    for_each_job(contenders.size(), settings.threads, [&](std::size_t i) {
      Model& fitted = contenders[i].fitted;
      fitted = fit_model(data, curves, contenders[i].set, {}, fitted.likelihood.discrepancies);
    });
  }
  for (std::size_t i = 0; i < finalists; ++i) {
    models[i] = contenders[i].fitted;
    models[i].exact = true;  // between adjacent simulated points
  }
  sort_by_deviance(models);
  return models;
}

std::vector<EffectSet> all_pairs(const EffectCurves& curves) {
  std::vector<EffectSet> pairs;
  for (std::size_t a = 0; a < curves.curves.size(); ++a)
    for (std::size_t b = a + 1; b < curves.curves.size(); ++b)
      if (is_visible(curves.curves[a]) && is_visible(curves.curves[b])) pairs.push_back({a, b});
  return pairs;
}

std::vector<EffectSet> with_one_more(const EffectCurves& curves, const EffectSet& set) {
  std::vector<EffectSet> sets;
  for (std::size_t c = 0; c < curves.curves.size(); ++c) {
    if (std::ranges::count(set, c) > 0 || !is_visible(curves.curves[c])) continue;
    sets.push_back(set);
    sets.back().push_back(c);
  }
  return sets;
}

std::vector<Model> search_sets(const StageData& data, EffectCurves& curves, const Model& than, double by,
                               const Simulate& simulate, const SearchSettings& settings, std::vector<EffectSet> sets) {
  const Discrepancies& start = than.likelihood.discrepancies;
  const double to_beat = than.deviance() - by;
  // interactions of effects persist in a larger set
  const GroupVectors beyond = beyond_curves(curves, than);

  // all sets by their residuals under the same discrepancies
  const Products products = products_of(whiteners_of(data, start), curves.shifts, less(residuals_of(data), beyond));
  std::vector<double> left(sets.size());
  for_each_job(sets.size(), settings.threads,
               [&](std::size_t i) { left[i] = fit_together(products, curves.curves, sets[i]).left; });
  std::vector<std::size_t> order(sets.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return left[i]; });
  order.resize(std::min(order.size(), settings.first_sets));

  // the leading ones with discrepancies of their own
  std::vector<EffectSet> first;
  for (const std::size_t i : order) first.push_back(std::move(sets[i]));
  std::vector<Model> models = fit_all(data, curves, first, beyond, start, settings.threads);
  if (follow_early_ends(curves, data, models, simulate))
    models = fit_all(data, curves, first, beyond, start, settings.threads);
  std::vector<Contender> contenders;
  for (Model& model : models)
    if (model.deviance() < to_beat) contenders.push_back({effects_of(model), std::move(model), {}});
  const auto keep_best = [&](std::size_t count) {
    std::ranges::stable_sort(contenders, {}, [](const Contender& c) { return c.fitted.deviance(); });
    contenders.resize(std::min(contenders.size(), count));
  };
  keep_best(settings.contenders);
  for (int round = 0; round < settings.rounds && !contenders.empty(); ++round)
    simulate_sets(contenders, data, curves, simulate, Fidelity::coarse, settings.threads);

  // the best of them at the full rate
  keep_best(settings.contenders);
  std::vector<Model> fitted;
  for (const Contender& contender : contenders) fitted.push_back(contender.fitted);
  keep_best(near_best(fitted, to_beat, settings));
  for (int round = 0; round < settings.rounds && !contenders.empty(); ++round)
    simulate_sets(contenders, data, curves, simulate, Fidelity::fine, settings.threads);
  models.clear();
  for (Contender& contender : contenders) models.push_back(std::move(contender.best));
  sort_by_deviance(models);
  return models;
}

}  // namespace kenaf::gap::diagnose
