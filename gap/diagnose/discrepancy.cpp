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

// The decay f = exp(-dt / memory) of the process from the bin before to each bin; 1 for the first.
std::vector<double> decays_of(std::span<const double> t_s, double memory_s) {
  std::vector<double> decays(t_s.size(), 1);
  double before_s = 0;
  for (std::size_t i = 1; i < t_s.size(); ++i) {
    const double dt_s = t_s[i] - t_s[i - 1];
    decays[i] = i > 1 && dt_s == before_s ? decays[i - 1] : std::exp(-dt_s / memory_s);
    before_s = dt_s;
  }
  return decays;
}

// Kalman filter of the process: prediction variance p = f^2 known + sigma^2 (1 - f^2), innovation variance p + noise,
// gain k = p / (p + noise), known = (1 - k) p. Calls use(bin, gain, 1 / innovation's sigma) and returns the logarithm
// of the covariance's determinant. Where bins and noise are alike the filter settles, and repeats what it computed.
template <class Use>
double filter(std::span<const double> decays, const Eigen::Ref<const Eigen::VectorXd>& variance, double sigma,
              Use&& use) {
  const double process = sigma * sigma;
  double known = process;  // variance after the update
  double predicted = 0, innovation = 0, gain = 0, inverse_sigma = 0, log_innovation = 0, log_determinant = 0;
  for (std::size_t i = 0; i < decays.size(); ++i) {
    const double f = decays[i], p = i == 0 ? process : f * f * known + process * (1 - f * f);
    const double s = p + variance[static_cast<Eigen::Index>(i)];
    if (p != predicted || s != innovation) {
      predicted = p, innovation = s;
      gain = predicted / innovation;
      known = (1 - gain) * predicted;
      inverse_sigma = 1 / std::sqrt(innovation);
      log_innovation = std::log(innovation);
    }
    use(i, gain, inverse_sigma);
    log_determinant += log_innovation;
  }
  return log_determinant;
}

// The standardised innovation of a bin: what the process, whose mean `state` follows the series, did not predict.
double innovation_of(double value, double& state, double decay, double gain, double inverse_sigma) {
  state *= decay;
  const double innovation = value - state;
  state += gain * innovation;
  return innovation * inverse_sigma;
}

// Minus twice the log-likelihood of one series; `decays`: of its bins. `white` is overwritten.
double minus_two_log_likelihood(const SeriesOfKind& series, std::span<const double> decays, double sigma,
                                Eigen::VectorXd& white) {
  white.resize(series.value.size());
  double state = 0;
  const double log_determinant =
      filter(decays, series.variance, sigma, [&](std::size_t i, double gain, double inverse_sigma) {
        const auto row = static_cast<Eigen::Index>(i);
        white[row] = innovation_of(series.value[row], state, decays[i], gain, inverse_sigma);
      });
  return white.squaredNorm() + log_determinant;
}

}  // namespace

SeriesWhitener::SeriesWhitener(std::span<const double> t_s, const Eigen::Ref<const Eigen::VectorXd>& variance,
                               const Discrepancy& discrepancy) {
  const std::vector<double> decays = decays_of(t_s, discrepancy.memory_s);
  steps_.reserve(t_s.size());
  log_determinant_ = filter(decays, variance, discrepancy.sigma, [&](std::size_t i, double gain, double inverse_sigma) {
    steps_.push_back({decays[i], gain, inverse_sigma});
  });
}

void SeriesWhitener::whiten(Eigen::Ref<Eigen::MatrixXd> series) const {
  for (Eigen::Index c = 0; c < series.cols(); ++c) {
    double state = 0;
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      double& value = series(static_cast<Eigen::Index>(i), c);
      value = innovation_of(value, state, steps_[i].decay, steps_[i].gain, steps_[i].inverse_sigma);
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
  // of all series for a sigma, given the decays of each
  Eigen::VectorXd white;
  const auto deviance = [&](const std::vector<std::vector<double>>& decays, double sigma) {
    double sum = 0;
    for (std::size_t i = 0; i < series.size(); ++i)
      sum += series[i].weight * minus_two_log_likelihood(series[i], decays[i], sigma, white);
    return sum;
  };
  const auto decays_with = [&](double memory_s) {
    std::vector<std::vector<double>> decays;
    for (const SeriesOfKind& one : series) decays.push_back(decays_of(one.t_s, memory_s));
    return decays;
  };
  double least = deviance(decays_with(best.memory_s), best.sigma);
  // from invisible beneath the noise to more than the residuals
  const double from = std::log(0.03 * std::sqrt(noise)), to = std::log(10 * std::sqrt(squares / bins));
  if (!(from < to)) return best;

  // for each memory the best sigma; sigma 0 stays if no other is more likely
  for (const double memory_s : kMemories_s) {
    const auto decays = decays_with(memory_s);
    const auto [log_sigma, value] =
        golden_section(from, to, kSections, [&](double at) { return deviance(decays, std::exp(at)); });
    if (value < least) {
      least = value;
      best = {std::exp(log_sigma), memory_s};
    }
  }
  return best;
}

}  // namespace kenaf::gap::diagnose
