#include "gap/diagnose/evidence.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <span>

#include "gap/diagnose/channels.hpp"
#include "gap/parallel.hpp"

namespace kenaf::gap::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t kResamplings = 400;
// Squared shift in noise below which data do not show an effect: two sigma.
constexpr double kHardlySeen = 4;

using Places = std::vector<std::size_t>;

double quantile(std::vector<double>& values, double share) {
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1)))];
}

// Expected reduction of these data's deviance by effects together, with the others refitted, if the model is right.
class EvidenceExpected {
 public:
  EvidenceExpected(const StageData& data, const StandingModel& standing)
      : information_(
            inner_products(whiteners_of(data, standing.model.likelihood.discrepancies), slopes(data, standing))),
        away_(information_.rows()) {
    for (Index e = 0; e < away_.size(); ++e) {
      const OnCurve& place = standing.model.places[static_cast<std::size_t>(e)];
      away_[e] = place.value - standing.curves.candidates[place.curve].present;
    }
  }

  double operator()(const Places& together) const {
    std::vector<Index> these, others;
    for (Index i = 0; i < away_.size(); ++i)
      (std::ranges::count(together, static_cast<std::size_t>(i)) > 0 ? these : others).push_back(i);
    // the effects' directions orthogonal to the others (Schur complement)
    MatrixXd information = information_(these, these);
    if (!others.empty()) {
      const MatrixXd shared = information_(others, these), of_others = information_(others, others);
      information -= shared.transpose() * of_others.completeOrthogonalDecomposition().solve(shared);
    }
    const VectorXd away = away_(these);
    return std::max(0.0, away.dot(information * away));
  }

 private:
  MatrixXd information_;
  VectorXd away_;
};

StageData data_of(const StageView& view, Passage passage, const UsedParts& used) {
  return stage_data(passage, *view.features, *view.repeats, *view.residuals, *view.floor, used);
}

Model refit(const StageData& data, const StandingModel& standing, const GroupVectors& beyond) {
  return fit_model(data, standing.curves, effects_of(standing.model), beyond, standing.model.likelihood.discrepancies);
}

// For each effect, whether these data show it above noise.
std::vector<bool> seen_in(const StageData& data, const StandingModel& standing) {
  std::vector<bool> seen;
  for (const OnCurve& place : standing.model.places)
    seen.push_back(squares_in_noise(data, shift_of(standing.curves, {&place, 1})) >= kHardlySeen);
  return seen;
}

// The model fitted to these data. Effects that they do not show keep their values: a value fitted to noise predicts
// nothing.
Model refit_seen(const StageData& data, const StandingModel& standing, const std::vector<bool>& seen,
                 const GroupVectors& beyond) {
  const std::vector<OnCurve>& places = standing.model.places;
  EffectSet fitted;
  std::vector<OnCurve> kept;
  for (std::size_t e = 0; e < places.size(); ++e)
    if (seen[e])
      fitted.push_back(places[e].curve);
    else
      kept.push_back(places[e]);
  GroupVectors shift = shift_of(standing.curves, kept);
  for (std::size_t g = 0; g < shift.size(); ++g) shift[g] += beyond[g];
  const Discrepancies& discrepancies = standing.model.likelihood.discrepancies;
  Model model;
  if (fitted.empty()) {
    model.shift = std::move(shift);
    model.likelihood = likelihood_with(data, rest_of(data, model), discrepancies);
  } else {
    model = fit_values(data, standing.curves, fitted, shift, discrepancies);
  }
  model.places.insert(model.places.end(), kept.begin(), kept.end());
  return model;
}

// Like NoiseFloor::whiteners, for the mean of a group's used runs.
std::vector<Whitener> whiteners_of_means(const StageData& data) {
  std::vector<Whitener> whiteners;
  for (const StageGroup& group : data.groups) {
    MatrixXd open(group.local_shapes.rows(), group.local_shapes.cols() + group.shared_shapes.cols());
    open << group.local_shapes, group.shared_shapes;
    whiteners.emplace_back(group.variance.cwiseSqrt(), open);
  }
  return whiteners;
}

// Squared residuals of the used runs' means, by kind.
KindSquares squares_of_groups(const StageData& data, const std::vector<Whitener>& whiteners, const GroupVectors& rest) {
  KindSquares squares = no_squares();
  for (std::size_t g = 0; g < data.groups.size(); ++g) {
    const StageGroup& group = data.groups[g];
    const VectorXd white = whiteners[g](rest[g]);
    for (std::size_t b = 0; b < group.bins.size(); ++b) {
      const auto i = static_cast<Index>(b);
      if (group.count[i] == 0) continue;
      const std::size_t kind = kind_of(group.bins[b].channel);
      squares.sum[kind] += white[i] * white[i];
      ++squares.bins[kind];
    }
  }
  return squares;
}

// A model's squared residuals by kind: with its effects alone, and with errors of the description's numbers.
struct Left {
  KindSquares by_effects, with_numbers;
};
Left& operator+=(Left& sum, const Left& more) {
  sum.by_effects += more.by_effects;
  sum.with_numbers += more.with_numbers;
  return sum;
}

// Residuals of a model, with the numbers' most likely errors in the fitted data. All models use the whole one's
// discrepancies: estimated without an effect, the numbers' errors would grow until they replace it.
Left left_in(const StageData& tested, const std::vector<Whitener>& whiteners, const StageData& fitted,
             const Model& model) {
  GroupVectors rest = rest_of(tested, model);
  Left left{squares_of_groups(tested, whiteners, rest), {}};
  const VectorXd numbers = most_likely_numbers(fitted, rest_of(fitted, model), model.likelihood.discrepancies);
  for (std::size_t g = 0; g < rest.size(); ++g) rest[g] -= tested.groups[g].number_shapes * numbers;
  left.with_numbers = squares_of_groups(tested, whiteners, rest);
  return left;
}

// The model without some effects, the others at their values.
Model others_of(const StandingModel& standing, const Model& model, const Places& without) {
  Model others;
  for (std::size_t i = 0; i < model.places.size(); ++i)
    if (std::ranges::none_of(
            without, [&](std::size_t place) { return standing.model.places[place].curve == model.places[i].curve; }))
      others.places.push_back(model.places[i]);
  others.shift = shift_of(standing.curves, others.places);
  others.likelihood.discrepancies = model.likelihood.discrepancies;
  return others;
}

// Residuals of models on all held-out data.
struct LeftOfFolds {
  KindSquares nominal;
  Left whole;
  // For each set of effects to leave out: the others refitted, or at the whole model's values.
  struct Without {
    Left fitted, held;
  };
  std::vector<Without> without;
  std::vector<std::vector<double>> shown;  // for each fold and each set, EvidenceExpected of the others
  std::vector<std::vector<bool>> seen;     // likewise, seen_in()

  LeftOfFolds& operator+=(const LeftOfFolds& more) {
    nominal += more.nominal;
    whole += more.whole;
    for (std::size_t s = 0; s < without.size(); ++s) {
      without[s].fitted += more.without[s].fitted;
      without[s].held += more.without[s].held;
    }
    shown.insert(shown.end(), more.shown.begin(), more.shown.end());
    seen.insert(seen.end(), more.seen.begin(), more.seen.end());
    return *this;
  }
};

// `held`: simulated model for each of `left_out`, if there is one.
LeftOfFolds left_of_folds(const StageView& view, Passage passage, const StandingModel& standing, const Folds& folds,
                          std::span<const Places> left_out, const std::vector<Model>& held, unsigned threads) {
  const GroupVectors beyond = beyond_curves(standing.curves, standing.model);
  // Models without an effect are fitted to all runs, i.e. at their best: fitted to runs that hardly show another
  // effect, one would use that as a substitute and lose both in the test. All use the whole model's discrepancies: new
  // estimates could absorb another effect, too.
  const StageData all_data = data_of(view, passage, {});
  std::vector<Model> models_without(left_out.size());
  for_each_job(left_out.size(), threads,
               [&](std::size_t s) { models_without[s] = values_without(all_data, standing, left_out[s]); });

  std::vector<LeftOfFolds> left(folds.size());
  for_each_job(folds.size(), threads, [&](std::size_t f) {
    const StageData tested_data = data_of(view, passage, UsedParts::of(folds[f]));
    const StageData fitted_data = folds.size() < 2 ? tested_data : data_of(view, passage, UsedParts::without(folds[f]));
    const std::vector<Whitener> whiteners = whiteners_of_means(tested_data);
    const auto left_by = [&](const Model& model) { return left_in(tested_data, whiteners, fitted_data, model); };
    const std::vector<bool> seen = seen_in(fitted_data, standing);
    const Model whole = refit_seen(fitted_data, standing, seen, beyond);
    left[f] = {squares_of_groups(tested_data, whiteners, residuals_of(tested_data)), left_by(whole), {}, {{}}, {seen}};
    const EvidenceExpected evidence(fitted_data, standing);
    for (const Places& set : left_out) left[f].shown.front().push_back(evidence(set));
    for (std::size_t s = 0; s < left_out.size(); ++s)
      left[f].without.push_back(
          {left_by(models_without[s]), left_by(held.empty() ? others_of(standing, whole, left_out[s]) : held[s])});
  });
  LeftOfFolds sum = std::move(left.front());
  for (std::size_t f = 1; f < left.size(); ++f) sum += left[f];
  return sum;
}

// Shares of the whole model in the stage, and its advantage over the models without each of `left_out`, in that order.
struct SharesWithout {
  double model;
  std::vector<HeldOutShares::OfEffect> left_out;
};

SharesWithout shares_without(const StageView& view, Passage passage, const StandingModel& standing, const Folds& folds,
                             std::span<const Places> left_out, const std::vector<Model>& held, unsigned threads) {
  const LeftOfFolds left = left_of_folds(view, passage, standing, folds, left_out, held, threads);

  // in the stage each kind is weighted by its own gap; a single kind by its rms
  const KindSquares& before = left.nominal;
  const std::vector<double> weights = kind_weights(before, no_squares());
  const auto of_stage = [&](const KindSquares& squares) {
    return explained_share(weighted_rms(before, weights), weighted_rms(squares, weights), 1);
  };
  // Errors of the numbers that predict less than none explain nothing, of any model.
  const auto with_numbers_of_stage = [&](const Left& model) {
    return std::max(of_stage(model.by_effects), of_stage(model.with_numbers));
  };
  const auto of_kind = [&](const Left& model, std::size_t kind) {
    const auto of = [&](const KindSquares& squares) {
      const auto rms = [kind](const KindSquares& all) { return std::sqrt(all.sum[kind] / all.bins[kind]); };
      return explained_share(rms(before), rms(squares), 1);
    };
    return std::max(of(model.by_effects), of(model.with_numbers));
  };

  SharesWithout shares{of_stage(left.whole.by_effects), {}};
  for (std::size_t s = 0; s < left_out.size(); ++s) {
    // Advantage over the better model without it, as a refit of the others may lose what they explained. Others whose
    // residual exceeds the original gap explain nothing.
    const auto more_than_without = [&](const auto& explained) {
      const LeftOfFolds::Without& without = left.without[s];
      const double by_others = std::max({0.0, explained(without.fitted), explained(without.held)});
      return std::max(0.0, explained(left.whole)) - by_others;
    };
    HeldOutShares::OfEffect share;
    share.of_stage = more_than_without([&](const Left& by) { return of_stage(by.by_effects); });
    share.beyond_numbers = more_than_without(with_numbers_of_stage);
    share.model_of_stage = shares.model;
    share.shown_by_others = std::numeric_limits<double>::infinity();
    for (const std::vector<double>& of_fold : left.shown)
      share.shown_by_others = std::min(share.shown_by_others, of_fold[s]);
    // largest share of everything, including noise: chance may remove all of a gap hardly above noise
    double most = -std::numeric_limits<double>::infinity();
    for (std::size_t kind = 0; kind < weights.size(); ++kind) {
      if (before.bins[kind] == 0 || weights[kind] == 0) continue;
      const double taken = more_than_without([&](const Left& by) { return of_kind(by, kind); });
      const double beyond_noise = 1 - before.bins[kind] / before.sum[kind];
      if (taken * beyond_noise <= most) continue;
      most = taken * beyond_noise;
      share.of_kind = taken;
      share.kind = kind;
      share.model_of_kind = of_kind(left.whole, kind);
    }
    // other runs do not predict a value that they do not show
    const auto is_seen = [&](const std::vector<bool>& of_fold) {
      return std::ranges::all_of(left_out[s], [&](std::size_t place) { return of_fold[place]; });
    };
    if (!std::ranges::all_of(left.seen, is_seen)) share.of_stage = share.beyond_numbers = share.of_kind = 0;
    shares.left_out.push_back(share);
  }
  return shares;
}

}  // namespace

GapMeasure measure_gap(const StageView& view, const std::vector<VectorXd>& after, const Deviations& repeats,
                       std::uint64_t seed) {
  // weights by each kind's own gap, the same before and after
  const std::vector<StageFeatures>& features = *view.features;
  const std::vector<KindSquares> before_of_runs = squares_of_runs(features, *view.floor, *view.residuals),
                                 after_of_runs = squares_of_runs(features, *view.floor, after);
  const auto sum_of = [&](const std::vector<KindSquares>& of_runs, std::span<const std::size_t> runs) {
    KindSquares sum = no_squares();
    for (const std::size_t r : runs) sum += of_runs[r];
    return sum;
  };
  std::vector<std::size_t> all(features.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const KindSquares before = sum_of(before_of_runs, all);

  const KindSquares floor = squares_of_floor(features, *view.floor, repeats);
  const std::vector<double> weights = kind_weights(before, floor);
  GapMeasure gap;
  gap.before = weighted_rms(before, weights);
  gap.after = weighted_rms(sum_of(after_of_runs, all), weights);
  gap.floor = std::min(weighted_rms(floor, weights), gap.before);
  gap.shrink.value = shrink(gap.before, gap.after, gap.floor);
  gap.explains.value = explained_share(gap.before, gap.after, gap.floor);

  // groups of repeats that measured something, drawn with replacement: one alone shows no spread
  std::vector<std::span<const std::size_t>> groups;
  for (const std::vector<std::size_t>& group : *view.repeats)
    if (std::ranges::any_of(group, [&](std::size_t r) { return !features[r].bins.empty(); }))
      groups.emplace_back(group);
  if (groups.size() < 2) return gap;
  std::mt19937_64 random(seed);
  std::vector<double> shrinks, shares;
  for (std::size_t i = 0; i < kResamplings; ++i) {
    KindSquares drawn_before = no_squares(), drawn_after = no_squares();
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const std::span<const std::size_t> group = groups[random() % groups.size()];
      drawn_before += sum_of(before_of_runs, group);
      drawn_after += sum_of(after_of_runs, group);
    }
    const double rms_before = weighted_rms(drawn_before, weights), rms_after = weighted_rms(drawn_after, weights);
    if (rms_before <= gap.floor) continue;
    shrinks.push_back(shrink(rms_before, rms_after, gap.floor));
    shares.push_back(explained_share(rms_before, rms_after, gap.floor));
  }

  // 95 % quantiles, which always include the value itself
  const auto widen = [](Interval& interval, std::vector<double>& drawn) {
    if (drawn.empty()) drawn.push_back(interval.value);
    interval.from = std::min(interval.value, quantile(drawn, 0.025));
    interval.to = std::max(interval.value, quantile(drawn, 0.975));
  };
  widen(gap.shrink, shrinks);
  widen(gap.explains, shares);
  return gap;
}

std::vector<RunPart> halves_of_runs_alone(const StageView& view, Passage passage, const StandingModel& standing,
                                          double evidence) {
  std::vector<RunPart> halves;
  const StageData data = data_of(view, passage, {});
  for (std::size_t g = 0; g < data.groups.size(); ++g) {
    const StageGroup& group = data.groups[g];
    // only single runs whose absence hides an effect
    if (group.runs.size() > 1) continue;
    const std::size_t run = group.runs.front();
    const EvidenceExpected expected(data_of(view, passage, UsedParts::without({run})), standing);
    bool shown_by_others = true;
    for (std::size_t e = 0; e < standing.model.places.size(); ++e) shown_by_others &= expected({e}) >= evidence;
    if (shown_by_others) continue;

    // bins are ordered by channel: sum the model's squared shift by time
    std::map<double, double> squares;
    double sum = 0, half = 0;
    for (std::size_t b = 0; b < group.bins.size(); ++b) {
      const auto i = static_cast<Index>(b);
      const double square = standing.model.shift[g][i] * standing.model.shift[g][i] / group.variance[i];
      squares[group.t_s[b]] += square;
      sum += square;
    }

    // the first half ends where half of the sum is reached
    for (const auto& [t_s, square] : squares) {
      half += square;
      if (half < sum / 2) continue;
      halves.push_back({run, 0, t_s});
      break;
    }
  }
  return halves;
}

std::vector<std::vector<PlacesOfPart>> places_held_out(const StageView& view, Passage passage,
                                                       const StandingModel& standing, const Folds& folds,
                                                       unsigned threads) {
  std::vector<std::vector<PlacesOfPart>> places(view.features->size());
  std::vector<std::vector<OnCurve>> of_fold(folds.size(), standing.model.places);
  if (folds.size() > 1) {
    const GroupVectors beyond = beyond_curves(standing.curves, standing.model);
    for_each_job(folds.size(), threads, [&](std::size_t f) {
      of_fold[f] = refit(data_of(view, passage, UsedParts::without(folds[f])), standing, beyond).places;
    });
  }
  for (std::size_t f = 0; f < folds.size(); ++f)
    for (const RunPart& part : folds[f]) places[part.run].push_back({part, of_fold[f]});
  for (std::vector<PlacesOfPart>& of_run : places)
    std::ranges::sort(of_run, {}, [](const PlacesOfPart& of_part) { return of_part.part.from_s; });
  return places;
}

HeldOutShares shares_held_out(const StageView& view, Passage passage, const StandingModel& standing,
                              const std::vector<Model>& without_each, const Folds& folds, unsigned threads) {
  std::vector<Places> singles;
  for (std::size_t e = 0; e < standing.model.places.size(); ++e) singles.push_back({e});
  SharesWithout shares = shares_without(view, passage, standing, folds, singles, without_each, threads);
  return {std::move(shares.left_out), {}, shares.model};
}

std::vector<Places> sets_small_first(std::span<const std::size_t> places) {
  std::vector<Places> sets;
  for (std::size_t bits = 1; bits < std::size_t{1} << places.size(); ++bits) {
    Places set;
    for (std::size_t i = 0; i < places.size(); ++i)
      if (bits >> i & 1) set.push_back(places[i]);
    if (set.size() > 1) sets.push_back(std::move(set));
  }
  std::ranges::stable_sort(sets, {}, &Places::size);
  return sets;
}

std::vector<HeldOutShares::OfSet> shares_of_sets_held_out(const StageView& view, Passage passage,
                                                          const StandingModel& standing, std::span<const Places> sets,
                                                          const std::vector<Model>& without_sets, const Folds& folds,
                                                          unsigned threads) {
  if (sets.empty()) return {};
  const SharesWithout shares = shares_without(view, passage, standing, folds, sets, without_sets, threads);
  std::vector<HeldOutShares::OfSet> result;
  for (std::size_t s = 0; s < sets.size(); ++s) result.push_back({sets[s], shares.left_out[s]});
  return result;
}

}  // namespace kenaf::gap::diagnose
