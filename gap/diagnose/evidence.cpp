#include "gap/diagnose/evidence.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <random>

namespace kenaf::gap {
namespace {

using Eigen::VectorXd;

constexpr std::size_t kMostFolds = 5, kResamplings = 400;
constexpr double kTwoSided95 = 1.96;
constexpr double kBorneOut = 0.5;

double quantile(std::vector<double>& values, double share) {
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

// How often each run is drawn.
std::vector<double> resample(std::size_t runs, std::mt19937_64& random) {
  std::vector<double> weights(runs, 0);
  for (std::size_t i = 0; i < runs; ++i) ++weights[random() % runs];
  return weights;
}

// How the model's shift changes with each value, whitened, by its curves.
Eigen::MatrixXd slopes(const EffectCurves& curves, const Model& model, std::size_t run) {
  Eigen::MatrixXd result(curves.gap[run].size(), std::ssize(model.places));
  for (std::size_t i = 0; i < model.places.size(); ++i) {
    const OnCurve& place = model.places[i];
    VectorXd difference = VectorXd::Zero(result.rows());
    if (place.column[1] >= 0) difference += curves.shifts[run].col(place.column[1]);
    if (place.column[0] >= 0) difference -= curves.shifts[run].col(place.column[0]);
    result.col(static_cast<Eigen::Index>(i)) = difference / place.segment;
  }
  return result;
}

// Of each value: what it would be, were the simulator's numbers other ones. The floor takes each run's shapes for its
// own; but these are the same numbers in all runs, so that more runs do not make them known.
std::vector<double> variances_of_numerics(const Refit& refit, const std::vector<Eigen::MatrixXd>& numerics,
                                          std::size_t effects) {
  std::vector<double> variances(effects, 0);
  if (numerics.empty() || numerics.front().cols() == 0) return variances;
  const std::vector<OnCurve> as_they_are = refit(std::vector<double>(numerics.size(), 1));
  for (Eigen::Index c = 0; c < numerics.front().cols(); c += 2) {
    const std::vector<OnCurve> up = refit.with(numerics, c), down = refit.with(numerics, c + 1);
    for (std::size_t e = 0; e < effects; ++e) {
      const double value = as_they_are[e].value;
      variances[e] += std::pow(std::max(std::abs(up[e].value - value), std::abs(down[e].value - value)), 2);
    }
  }
  return variances;
}

}  // namespace

Folds folds_by_repeat(const std::vector<std::vector<std::size_t>>& repeats) {
  std::size_t most = 1;
  for (const auto& group : repeats) most = std::max(most, group.size());
  const std::size_t count = std::min(kMostFolds, most > 1 ? most : repeats.size());
  Folds folds(count);
  std::size_t next = 0;
  for (const auto& group : repeats)
    for (const std::size_t run : group) folds[next++ % count].push_back(run);
  std::erase_if(folds, [](const auto& fold) { return fold.empty(); });
  return folds;
}

Folds folds_by_manoeuvre(const Observations& observations) {
  std::map<std::string, std::size_t> known;
  Folds folds;
  for (std::size_t r = 0; r < observations.runs.size(); ++r) {
    const auto [fold, is_new] = known.try_emplace(observations.runs[r].manoeuvre, folds.size());
    if (is_new) folds.emplace_back();
    folds[fold->second].push_back(r);
  }
  return folds;
}

double shrink(double before, double after, double floor) {
  return before > floor ? 1 - (after - floor) / (before - floor) : 0;
}

bool is_borne_out(const HeldOut& held) {
  return held.before <= held.floor || held.shrink.value >= kBorneOut;
}

bool is_within_repeats(const HeldOut& held, double model_share) {
  return held.after <= std::hypot(kWithinRepeats * held.floor, model_share * held.before);
}

Refit::Refit(const EffectCurves& curves, const Model& model)
    : curves_(curves), effects_(effects_of(model)), runs_(products_of_runs_around(curves, model)) {}

std::vector<OnCurve> Refit::operator()(std::span<const double> weights) const {
  return fit_together(weighted_sum(runs_, weights), curves_.curves, effects_).places;
}

std::vector<OnCurve> Refit::with(const std::vector<Eigen::MatrixXd>& added, Eigen::Index column) const {
  Products sum = weighted_sum(runs_, std::vector<double>(runs_.size(), 1));
  double squares = 0;
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    const VectorXd whitened = curves_.whiteners[r](added[r].col(column));
    sum.shift_gap.noalias() += curves_.shifts[r].transpose() * whitened;
    squares += whitened.squaredNorm();
  }
  // the same for all values, so that the most it may be will do
  sum.gap_gap = std::pow(std::sqrt(sum.gap_gap) + std::sqrt(squares), 2);
  return fit_together(sum, curves_.curves, effects_).places;
}

Shift by_curves(const EffectCurves& curves, const Model& model,
                const std::vector<std::vector<OnCurve>>& places_of_run) {
  Shift shift;
  for (std::size_t r = 0; r < places_of_run.size(); ++r)
    shift.push_back(model.shift[r] - shift_at(curves.raw_shifts[r], model.places) +
                    shift_at(curves.raw_shifts[r], places_of_run[r]));
  return shift;
}

HeldOut hold_out(const EffectCurves& curves, const NoiseFloor& floor, const Model& model, const Folds& folds,
                 double floor_rms, std::uint64_t seed,
                 const std::function<Shift(const std::vector<std::vector<OnCurve>>&)>& shift_of) {
  const std::size_t runs = curves.gap.size();
  const Refit refit(curves, model);
  std::vector<std::vector<OnCurve>> places_of_run(runs, model.places);
  for (const std::vector<std::size_t>& fold : folds) {
    if (folds.size() < 2) break;
    std::vector<double> weights(runs, 1);
    for (const std::size_t r : fold) weights[r] = 0;
    const std::vector<OnCurve> places = refit(weights);
    for (const std::size_t r : fold) places_of_run[r] = places;
  }
  const Shift shift = shift_of(places_of_run);
  HeldOut result;
  std::vector<double> before, after, bins;
  for (std::size_t r = 0; r < runs; ++r) {
    result.left.push_back(curves.residual[r] - shift[r]);
    before.push_back(floor.whiteners[r](curves.residual[r]).squaredNorm());
    after.push_back(floor.whiteners[r](result.left[r]).squaredNorm());
    bins.push_back(static_cast<double>(curves.residual[r].size()));
  }
  const auto rms = [&](const std::vector<double>& squares, std::span<const double> weights) {
    double sum = 0, count = 0;
    for (std::size_t r = 0; r < runs; ++r) sum += weights[r] * squares[r], count += weights[r] * bins[r];
    return std::sqrt(sum / count);
  };
  const std::vector<double> all(runs, 1);
  result.before = rms(before, all);
  result.after = rms(after, all);
  result.floor = std::min(floor_rms, result.before);
  result.shrink.value = shrink(result.before, result.after, result.floor);
  std::mt19937_64 random(seed);
  std::vector<double> resampled;
  for (std::size_t i = 0; i < kResamplings; ++i) {
    const std::vector<double> weights = resample(runs, random);
    resampled.push_back(shrink(rms(before, weights), rms(after, weights), result.floor));
  }
  result.shrink.from = std::min(result.shrink.value, quantile(resampled, 0.025));
  result.shrink.to = std::max(result.shrink.value, quantile(resampled, 0.975));
  return result;
}

std::vector<Interval> value_intervals(const EffectCurves& curves, const Model& model,
                                      const std::vector<Eigen::MatrixXd>& numerics, double model_share,
                                      double inflation, std::uint64_t seed) {
  const auto effects = std::ssize(model.places);
  const std::size_t runs = curves.gap.size();
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(effects, effects);
  for (std::size_t r = 0; r < runs; ++r) {
    const Eigen::MatrixXd slope = slopes(curves, model, r);
    information += slope.transpose() * slope;
  }
  const Eigen::MatrixXd covariance = inflation * information.completeOrthogonalDecomposition().pseudoInverse();

  const Refit refit(curves, model);
  std::mt19937_64 random(seed);
  std::vector<std::vector<double>> resampled(model.places.size());
  for (std::size_t i = 0; i < kResamplings; ++i) {
    const std::vector<OnCurve> places = refit(resample(runs, random));
    for (std::size_t e = 0; e < places.size(); ++e) resampled[e].push_back(places[e].value);
  }
  const std::vector<double> of_numerics = variances_of_numerics(refit, numerics, model.places.size());
  std::vector<Interval> intervals;
  for (std::size_t e = 0; e < model.places.size(); ++e) {
    const EffectCurve& curve = curves.curves[model.places[e].curve];
    const double value = model.places[e].value;
    const auto i = static_cast<Eigen::Index>(e);
    const double of_runs = (quantile(resampled[e], 0.84) - quantile(resampled[e], 0.16)) / 2;
    const double of_model = model_share / 2 * (value - present_value(curve));
    // resampled runs differ by the floor's noise too, and the floor has the numerics: together they would count twice
    const double sigma =
        std::sqrt(std::max({covariance(i, i), of_runs * of_runs, of_numerics[e]}) + of_model * of_model);
    intervals.push_back({value, std::max(curve.parameter->min, value - kTwoSided95 * sigma),
                         std::min(curve.parameter->max, value + kTwoSided95 * sigma)});
  }
  return intervals;
}

}  // namespace kenaf::gap
