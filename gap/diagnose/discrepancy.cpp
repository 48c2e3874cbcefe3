#include "gap/diagnose/discrepancy.hpp"

#include <algorithm>
#include <array>
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

// A number for each of kMemories_s. Likelihoods are computed for all of them at once: a filter is one long chain of
// divisions, and a processor works on several such chains in the time of one.
constexpr std::size_t kMemories = std::size(kMemories_s);
using EachMemory = std::array<double, kMemories>;

// For each bin of a series.
std::vector<EachMemory> decays_with_each_memory(std::span<const double> t_s) {
  std::vector<EachMemory> decays(t_s.size());
  for (std::size_t m = 0; m < kMemories; ++m) {
    const std::vector<double> with_memory = decays_of(t_s, kMemories_s[m]);
    for (std::size_t i = 0; i < decays.size(); ++i) decays[i][m] = with_memory[i];
  }
  return decays;
}

// The sum of logarithms of numbers > 0, by few logarithms.
class LogSum {
 public:
  void add(double x) {
    product_ *= x;
    if (product_ > kLeast && product_ < 1 / kLeast) return;
    sum_ += std::log(product_);
    product_ = 1;
  }
  double value() const { return sum_ + std::log(product_); }

 private:
  static constexpr double kLeast = 1e-100;
  double product_ = 1, sum_ = 0;
};

// Minus twice the log-likelihood of one series with each memory and its sigma: filter() and innovation_of(), without
// what only a whitener needs. `decays`: of its bins.
EachMemory minus_two_log_likelihood(const SeriesOfKind& series, std::span<const EachMemory> decays,
                                    const EachMemory& sigma) {
  EachMemory process, known, state{}, squares{};
  std::array<LogSum, kMemories> log_determinant;
  for (std::size_t m = 0; m < kMemories; ++m) known[m] = process[m] = sigma[m] * sigma[m];
  for (std::size_t i = 0; i < decays.size(); ++i) {
    const double value = series.value[static_cast<Eigen::Index>(i)];
    const double noise = series.variance[static_cast<Eigen::Index>(i)];
    for (std::size_t m = 0; m < kMemories; ++m) {
      const double f = decays[i][m], predicted = f * f * known[m] + process[m] * (1 - f * f);
      const double innovation_variance = predicted + noise, inverse = 1 / innovation_variance;
      const double gain = predicted * inverse, innovation = value - f * state[m];
      known[m] = gain * noise;
      state[m] = f * state[m] + gain * innovation;
      squares[m] += innovation * innovation * inverse;
      log_determinant[m].add(innovation_variance);
    }
  }
  EachMemory sum;
  for (std::size_t m = 0; m < kMemories; ++m) sum[m] = squares[m] + log_determinant[m].value();
  return sum;
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
  // of all series
  std::vector<std::vector<EachMemory>> decays;
  for (const SeriesOfKind& one : series) decays.push_back(decays_with_each_memory(one.t_s));
  const auto deviance = [&](const EachMemory& sigma) {
    EachMemory sum{};
    for (std::size_t i = 0; i < series.size(); ++i) {
      const EachMemory of_series = minus_two_log_likelihood(series[i], decays[i], sigma);
      for (std::size_t m = 0; m < kMemories; ++m) sum[m] += series[i].weight * of_series[m];
    }
    return sum;
  };
  double least = deviance({})[0];  // without a discrepancy, whatever its memory
  // from invisible beneath the noise to more than the residuals
  const double from = std::log(0.03 * std::sqrt(noise)), to = std::log(10 * std::sqrt(squares / bins));
  if (!(from < to)) return best;

  // for each memory the best sigma; sigma 0 stays if no other is more likely
  const auto minima = golden_sections<kMemories>(from, to, kSections, [&](EachMemory log_sigma) {
    for (double& at : log_sigma) at = std::exp(at);
    return deviance(log_sigma);
  });
  for (std::size_t m = 0; m < kMemories; ++m) {
    if (minima[m].value >= least) continue;
    least = minima[m].value;
    best = {std::exp(minima[m].at), kMemories_s[m]};
  }
  return best;
}

}  // namespace kenaf::gap::diagnose
