#include "gap/diagnose/left_over_robust.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace kenaf::gap::diagnose {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr int kReweightings = 5;  // chosen: weights hardly change afterwards
// Losses are linear beyond this multiple of the rms, taken without the largest 5 %, but at least half of the rms with
// them (chosen: a step's transient is no outlier, a jump of the pose is).
constexpr double kRowClip = 4, kTrimmedRows = 0.05, kLeastOfRms = 0.5;
// A run whose rms exceeds twice the median's counts as if at twice (chosen). Fewer runs have no typical rms.
constexpr double kRunClip = 2;
constexpr std::size_t kLeastUsualRuns = 5;
constexpr double kStandardErrors = 2;  // chosen: is_above_chance()

}  // namespace

VectorXd RobustRows::row_weights(const VectorXd& residual) const {
  return of_run.array() * (residual.array().abs() > clip).select(clip / residual.array().abs(), 1.0);
}

VectorXd RobustRows::losses(const VectorXd& residual) const {
  const auto size = residual.array().abs();
  return of_run.array() * (size > clip).select(clip * (2 * size - clip), size.square());
}

RobustRows robust_for(const LeftOverRows& rows) {
  // rms of each run, and the usual one: the median, at least the noise
  const auto count = static_cast<std::size_t>(rows.error.size());
  std::vector<double> squares(count), sum(rows.runs, 0), size(rows.runs, 0), rms;
  for (std::size_t i = 0; i < count; ++i) {
    squares[i] = std::pow(rows.error[static_cast<Index>(i)], 2);
    sum[rows.run[i]] += squares[i];
    ++size[rows.run[i]];
  }
  for (std::size_t r = 0; r < rows.runs; ++r)
    if (size[r] > 0) rms.push_back(std::sqrt(sum[r] / size[r]));
  const double noise = std::sqrt(rows.sigma.squaredNorm() / static_cast<double>(count));
  const double usual = std::max(noise, quantile_of(rms, 0.5));

  // a run with an rms beyond 2 usual gets the weight (2 usual / rms)^2, so that its squares count as at 2 usual
  RobustRows robust{VectorXd::Ones(rows.error.size()), 0};
  if (rms.size() >= kLeastUsualRuns)
    for (std::size_t i = 0; i < count; ++i) {
      const double most = kRunClip * usual, of_run = std::sqrt(sum[rows.run[i]] / size[rows.run[i]]);
      if (of_run > most) robust.of_run[static_cast<Index>(i)] = std::pow(most / of_run, 2);
    }

  // clip = 4 max(noise, rms without the largest 5 %, half of the rms with them)
  for (std::size_t i = 0; i < count; ++i) squares[i] *= robust.of_run[static_cast<Index>(i)];
  std::ranges::sort(squares);
  const auto kept = static_cast<std::size_t>(std::ceil(static_cast<double>(count) * (1 - kTrimmedRows)));
  double trimmed = 0, all = 0;
  for (std::size_t i = 0; i < count; ++i) {
    all += squares[i];
    if (i < kept) trimmed += squares[i];
  }
  robust.clip = kRowClip * std::max({noise, std::sqrt(trimmed / static_cast<double>(kept)),
                                     kLeastOfRms * std::sqrt(all / static_cast<double>(count))});
  return robust;
}

VectorXd ridge_solution(const MatrixXd& square, const VectorXd& right) {
  MatrixXd regular = square;
  regular.diagonal() *= 1 + 1e-9;
  regular.diagonal().array() += 1e-300;
  return regular.ldlt().solve(right);
}

VectorXd robust_slopes(const MatrixXd& x, const VectorXd& y, const RobustRows& robust, const VectorXd& mask) {
  VectorXd slopes = VectorXd::Zero(x.cols());
  if (x.cols() == 0) return slopes;
  VectorXd weights = robust.row_weights(y).cwiseProduct(mask);
  for (int i = 0; i < kReweightings; ++i) {
    const MatrixXd weighted = weights.asDiagonal() * x;
    slopes = ridge_solution(x.transpose() * weighted, weighted.transpose() * y);
    weights = robust.row_weights(y - x * slopes).cwiseProduct(mask);
  }
  return slopes;
}

double slope_through_zero(const VectorXd& x, const VectorXd& y, const VectorXd& weights,
                          const std::vector<bool>& chosen) {
  double square = 0, product = 0;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (!chosen[i]) continue;
    const auto row = static_cast<Index>(i);
    square += weights[row] * x[row] * x[row];
    product += weights[row] * x[row] * y[row];
  }
  return square > 0 ? product / square : 0;
}

bool is_above_chance(const std::vector<double>& gains) {
  const auto count = static_cast<double>(gains.size());
  double mean = 0, square = 0;
  for (const double gain : gains) mean += gain / count;
  for (const double gain : gains) square += std::pow(gain - mean, 2);
  return mean > kStandardErrors * std::sqrt(square / (count - 1) / count);
}

double quantile_of(std::vector<double> values, double share) {
  std::ranges::sort(values);
  const double at = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (at - static_cast<double>(below)) * (values[above] - values[below]);
}

}  // namespace kenaf::gap::diagnose
