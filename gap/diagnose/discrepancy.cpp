#include "gap/diagnose/discrepancy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gap/diagnose/golden_section.hpp"

namespace kenaf::gap::diagnose {
namespace {

// Chosen: from one bin to longer than most manoeuvres' phases. The likelihood is flat between neighbours.
constexpr double kMemories_s[] = {0.25, 0.7, 2, 6, 16};
// Golden section over the logarithm of sigma: to 3 %.
constexpr int kSections = 12;

double minus_two_log_likelihood(std::span<const SeriesOfKind> series, const Discrepancy& discrepancy) {
  double sum = 0;
  for (const SeriesOfKind& one : series) {
    const SeriesWhitener whitener(one.t_s, one.variance, discrepancy);
    Eigen::MatrixXd white = one.value;
    whitener.whiten(white);
    sum += one.weight * (white.squaredNorm() + whitener.log_determinant());
  }
  return sum;
}

}  // namespace

SeriesWhitener::SeriesWhitener(std::span<const double> t_s, const Eigen::Ref<const Eigen::VectorXd>& variance,
                               const Discrepancy& discrepancy) {
  // Kalman filter of the process, f = exp(-dt / memory): prediction variance p = f^2 known + sigma^2 (1 - f^2),
  // innovation variance p + noise, gain k = p / (p + noise), known = (1 - k) p
  const double process = discrepancy.sigma * discrepancy.sigma;
  double known = process;  // variance after the update
  steps_.reserve(t_s.size());
  for (std::size_t i = 0; i < t_s.size(); ++i) {
    const double decay = i == 0 ? 1 : std::exp(-(t_s[i] - t_s[i - 1]) / discrepancy.memory_s);
    const double predicted = i == 0 ? process : decay * decay * known + process * (1 - decay * decay);
    const double innovation = predicted + variance[static_cast<Eigen::Index>(i)];
    const double gain = predicted / innovation;
    known = (1 - gain) * predicted;
    steps_.push_back({decay, gain, 1 / std::sqrt(innovation)});
    log_determinant_ += std::log(innovation);
  }
}

void SeriesWhitener::whiten(Eigen::Ref<Eigen::MatrixXd> series) const {
  for (Eigen::Index c = 0; c < series.cols(); ++c) {
    double state = 0;
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      double& value = series(static_cast<Eigen::Index>(i), c);
      state *= steps_[i].decay;
      const double innovation = value - state;
      state += steps_[i].gain * innovation;
      value = innovation * steps_[i].inverse_sigma;
    }
  }
}

Discrepancy most_likely_discrepancy(std::span<const SeriesOfKind> series) {
  // the scale of the series, and its smallest noise
  double squares = 0, noise = std::numeric_limits<double>::infinity(), bins = 0;
  for (const SeriesOfKind& one : series) {
    squares += one.value.squaredNorm();
    bins += static_cast<double>(one.value.size());
    if (one.variance.size() > 0) noise = std::min(noise, one.variance.minCoeff());
  }
  Discrepancy best;
  if (bins == 0 || squares == 0) return best;
  double least = minus_two_log_likelihood(series, best);
  // from invisible beneath the noise to more than the residuals
  const double from = std::log(0.03 * std::sqrt(noise)), to = std::log(10 * std::sqrt(squares / bins));
  if (!(from < to)) return best;

  // for each memory the best sigma; sigma 0 stays if no other is more likely
  for (const double memory_s : kMemories_s) {
    const auto at = [&](double log_sigma) { return minus_two_log_likelihood(series, {std::exp(log_sigma), memory_s}); };
    const auto [log_sigma, value] = golden_section(from, to, kSections, at);
    if (value < least) {
      least = value;
      best = {std::exp(log_sigma), memory_s};
    }
  }
  return best;
}

}  // namespace kenaf::gap::diagnose
