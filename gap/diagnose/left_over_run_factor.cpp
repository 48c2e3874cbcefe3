#include <algorithm>
#include <cmath>

#include "gap/diagnose/left_over_fit.hpp"

namespace kenaf::gap::diagnose {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr std::size_t kLeastRunsApart = 5;  // chosen: fewer have no middle 80 %

// Products of one base with itself and with the residual, for each run.
struct RunSums {
  VectorXd square, product;
};

constexpr double kBlock_s = 1.5;        // length of a block, the unit that is held out (chosen)
constexpr double kApart_s = 0.5;        // rows this close to a held-out block do not count: a rate spans half a second
constexpr std::size_t kBlockFolds = 4;  // chosen

std::size_t block_fold(double time_s) {
  return static_cast<std::size_t>(std::max(0.0, time_s) / kBlock_s) % kBlockFolds;
}

// Sums over rows neither in nor close to fold `held_out`; over all rows if it is no fold.
RunSums run_sums(const LeftOverRows& rows, const VectorXd& base, const VectorXd& rest, const VectorXd& weights,
                 std::size_t held_out) {
  RunSums sums{VectorXd::Zero(static_cast<Index>(rows.runs)), VectorXd::Zero(static_cast<Index>(rows.runs))};
  for (std::size_t i = 0; i < rows.run.size(); ++i) {
    const auto row = static_cast<Index>(i), run = static_cast<Index>(rows.run[i]);
    const double t = rows.time_s[row];
    if (block_fold(t) == held_out || block_fold(t - kApart_s) == held_out || block_fold(t + kApart_s) == held_out)
      continue;
    sums.square[run] += weights[row] * base[row] * base[row];
    sums.product[run] += weights[row] * base[row] * rest[row];
  }
  return sums;
}

// Random effect: each run's own slope, shrunk towards 0 according to its noise (empirical Bayes by moments).
VectorXd shrunken(const RunSums& sums, double variance) {
  // method of moments: spread^2 = max(0, sum b_r^2 A_r - n variance) / sum A_r, b_r = B_r / A_r the slope of run r
  double of_slopes = 0, of_noise = 0, runs = 0;
  for (Index r = 0; r < sums.square.size(); ++r) {
    if (sums.square[r] <= 0) continue;
    of_slopes += std::pow(sums.product[r] / sums.square[r], 2) * sums.square[r];
    of_noise += variance;
    runs += sums.square[r];
  }
  const double spread = runs > 0 ? std::max(0.0, of_slopes - of_noise) / runs : 0;

  // posterior mean: B_r / (A_r + variance / spread^2)
  VectorXd slopes = VectorXd::Zero(sums.square.size());
  for (Index r = 0; r < slopes.size(); ++r)
    if (sums.square[r] > 0 && spread > 0) slopes[r] = sums.product[r] / (sums.square[r] + variance / spread);
  return slopes;
}

}  // namespace

std::optional<RunFactor> run_factor(const LeftOverRows& rows, const LeftOverFit& fit, const RobustRows& robust,
                                    double beyond) {
  const VectorXd before = robust.losses(fit.rest);
  const double variance = before.sum() / std::max(1e-300, robust.of_run.sum());
  std::optional<RunFactor> best;
  for (std::size_t c = 0; c < rows.candidates.size(); ++c) {
    // a factor on the simulated quantity, or an offset
    const Regressor kind = rows.candidates[c].kind;
    if (kind != Regressor::simulated && kind != Regressor::constant) continue;
    const VectorXd base = rows.x.col(static_cast<Index>(c));

    // held-out residuals: the slopes of a block of time from the other blocks of the same run
    VectorXd residual = fit.rest;
    for (std::size_t fold = 0; fold < kBlockFolds; ++fold) {
      const VectorXd slopes = shrunken(run_sums(rows, base, fit.rest, fit.weights, fold), variance);
      for (std::size_t i = 0; i < rows.run.size(); ++i)
        if (const auto row = static_cast<Index>(i); block_fold(rows.time_s[row]) == fold)
          residual[row] -= slopes[static_cast<Index>(rows.run[i])] * base[row];
    }

    // gains by run, for runs that show the base at all
    const VectorXd gains = before - robust.losses(residual);
    std::vector<double> by_run(rows.runs, 0), of_runs, usual, values;
    for (std::size_t i = 0; i < rows.run.size(); ++i) by_run[rows.run[i]] += gains[static_cast<Index>(i)];
    const RunSums sums = run_sums(rows, base, fit.rest, fit.weights, kBlockFolds);
    for (std::size_t r = 0; r < rows.runs; ++r)
      if (sums.square[static_cast<Index>(r)] > 0) {
        of_runs.push_back(by_run[r]);
        usual.push_back(sums.square[static_cast<Index>(r)]);
      }

    // needs enough runs, a reportable share beyond chance, and a clear advantage over the other kind
    const double share = gains.sum() / beyond;
    if (of_runs.size() < kLeastRunsApart || share < kLeastReported || !is_above_chance(of_runs)) continue;
    if (best && share < best->share + kClearlyMore) continue;

    // each run's own value, including what all runs share by the terms, and its quantiles
    best = RunFactor{kind == Regressor::simulated, share, 0, 0, 0, {}};
    double common = best->of_simulated ? 1 : 0;
    for (const LeftOverTerm& term : fit.terms)
      if (rows.candidates[term.candidate].kind == kind) common += term.slope;
    // a run with hardly any motion has no factor
    const double enough = quantile_of(usual, 0.5) / 4;
    for (std::size_t r = 0; r < rows.runs; ++r) {
      const auto run = static_cast<Index>(r);
      if (sums.square[run] < enough) continue;
      values.push_back(common + sums.product[run] / sums.square[run]);
      best->of_run.push_back({static_cast<double>(r), values.back()});
    }
    best->low = quantile_of(values, 0.1);
    best->middle = quantile_of(values, 0.5);
    best->high = quantile_of(values, 0.9);
  }
  return best;
}

}  // namespace kenaf::gap::diagnose
