// The discrepancy of a model: its residual beyond noise (Kennedy and O'Hagan 2001; Brynjarsdottir and O'Hagan 2014). It
// is coherent in time, differs from run to run, and its size is estimated together with the effects.
//
// In each channel it is an Ornstein-Uhlenbeck process, a stationary Gaussian process with the covariance
// sigma^2 exp(-|dt| / memory). That process is Markov, so that a Kalman filter turns a series of n bins into n
// independent standardised innovations in O(n) operations (Sarkka and Solin 2019, Applied Stochastic Differential
// Equations, ch. 10 and 12).
//
// Thread safety: values and pure functions.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace kenaf::gap::diagnose {

// Discrepancy of one kind of channels. sigma >= 0 in the unit of the channel; memory_s > 0.
struct Discrepancy {
  double sigma = 0;
  double memory_s = 1;
};

// Transforms series with independent noise and a discrepancy into independent numbers of variance 1: applies the
// inverse Cholesky factor of their covariance without forming it.
class SeriesWhitener {
 public:
  // `t_s`: time of each bin, increasing. `variance`: its noise variance, > 0.
  SeriesWhitener(std::span<const double> t_s, const Eigen::Ref<const Eigen::VectorXd>& variance,
                 const Discrepancy& discrepancy);
  // In place; each column is a series, one row a bin.
  void whiten(Eigen::Ref<Eigen::MatrixXd> series) const;
  double log_determinant() const { return log_determinant_; }  // of the covariance

 private:
  struct Step {
    double decay, gain, inverse_sigma;
  };
  std::vector<Step> steps_;
  double log_determinant_ = 0;
};

// One series of a kind of channels, with its own times.
struct SeriesOfKind {
  std::vector<double> t_s;
  Eigen::VectorXd variance, value;
  // Weight of this series in the log-likelihood; 1 unless runs are weighted.
  double weight = 1;
};
// Maximum-likelihood discrepancy of one kind of channels: over sigma, for each of a few memories from 0.25 to 16 s.
// sigma is 0 if noise alone explains `series` as well.
Discrepancy most_likely_discrepancy(std::span<const SeriesOfKind> series);

}  // namespace kenaf::gap::diagnose
