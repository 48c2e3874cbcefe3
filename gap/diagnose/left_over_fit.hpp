// Selects the few regressors of a residual, each of which has to reduce it on runs that its fit has not seen.
//
// Terms are added one at a time, the one with the least loss on held-out units (forward selection with cross
// validation: Hastie, Tibshirani, Friedman, The Elements of Statistical Learning, 2nd ed. 2009, 3.3.2 and 7.10). Least
// squares with Huber's weights (Huber, Robust Estimation of a Location Parameter, 1964), for single rows and for whole
// runs. A slope must have the same sign in nearly all draws of a bootstrap over units (Efron, Tibshirani, An
// Introduction to the Bootstrap, 1993).
//
// Thread safety: values and pure functions. Deterministic.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "gap/diagnose/left_over_regressors.hpp"
#include "gap/diagnose/left_over_robust.hpp"

namespace kenaf::gap::diagnose {

// Minimum advantage of a candidate, as a share of the residual beyond noise, over one that is preferred to it (chosen:
// sampling error).
inline constexpr double kClearlyMore = 0.02;

struct LeftOverTerm {
  std::size_t candidate;  // of LeftOverRows
  double share;           // of the residual beyond noise, on held-out units: its reduction when the term was added
  double slope;           // from the fit of all terms to all rows
};

// Each run has its own factor or offset, which other runs do not predict; stretches of time within runs were held out.
struct RunFactor {
  bool of_simulated;         // a factor on the simulated quantity; false: an offset
  double share;              // beyond the terms
  double low, middle, high;  // 10, 50 and 90 % quantiles over runs: of the factor, 1 without a gap, or of the offset
  std::vector<std::array<double, 2>> of_run;  // number of the run, its factor or offset
};

struct LeftOverFit {
  std::vector<LeftOverTerm> terms;
  std::optional<RunFactor> by_run;
  Eigen::VectorXd rest;     // residual of each row after all terms
  Eigen::VectorXd weights;  // of each row, 0 to 1
};

// Returns the held-out unit of each row: its group of repeats, or with fewer than four groups a stretch of time of its
// run.
std::vector<std::size_t> held_out_together(const LeftOverRows& rows, std::span<const std::size_t> group_of_run);

LeftOverFit fit_left_over(const LeftOverRows& rows, const std::vector<std::size_t>& unit_of_row);

// Fits run factors to the residual of `fit`; `beyond`: the robust losses beyond noise, to which the share refers. Empty
// if runs do not differ.
std::optional<RunFactor> run_factor(const LeftOverRows& rows, const LeftOverFit& fit, const RobustRows& robust,
                                    double beyond);

// Lateness of `term`: in seconds for delay and lag, as a fraction of the limited change for a ramp. `terms` must
// include its candidate.
double lateness(const LeftOverRows& rows, const std::vector<LeftOverTerm>& terms, const LeftOverTerm& term);

}  // namespace kenaf::gap::diagnose
