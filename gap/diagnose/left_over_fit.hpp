// The few regressors that a left-over goes with, each of which has to take something on runs that its fit has not seen.
//
// Terms are added one at a time, the one that leaves least on folds of held-out units (forward selection with cross
// validation: Hastie, Tibshirani, Friedman, The Elements of Statistical Learning, 2nd ed. 2009, 3.3.2 and 7.10). Least
// squares with Huber's weights (Huber, Robust Estimation of a Location Parameter, 1964), of single rows and of whole
// runs. The sign of a slope has to be the same in nearly all draws of a bootstrap over units (Efron, Tibshirani, An
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

// A candidate has to take this much more, of all beyond noise, than one that is preferred to it (chosen: sampling
// error).
inline constexpr double kClearlyMore = 0.02;

struct LeftOverTerm {
  std::size_t candidate;  // of LeftOverRows
  double share;           // of what is left beyond noise, on held-out units: what it took when it was added
  double slope;           // of all terms together, on all rows
};

// Each run has its own factor or offset, which no other run foretells; stretches of time within runs were held out.
struct RunFactor {
  bool of_simulated;         // a factor of the simulated quantity; false: an offset
  double share;              // beyond the terms
  double low, middle, high;  // 10, 50 and 90 % of the runs: of the factor, 1 without a gap, or of the offset
  std::vector<std::array<double, 2>> of_run;  // number of the run, its factor or offset
};

struct LeftOverFit {
  std::vector<LeftOverTerm> terms;
  std::optional<RunFactor> by_run;
  Eigen::VectorXd rest;     // of each row, beyond all terms
  Eigen::VectorXd weights;  // of each row, 0 to 1
};

// What is held out together, of each row: groups of repeats; where there are fewer than four, stretches of time of
// their runs.
std::vector<std::size_t> held_out_together(const LeftOverRows& rows, std::span<const std::size_t> group_of_run);

LeftOverFit fit_left_over(const LeftOverRows& rows, const std::vector<std::size_t>& unit_of_row);

// Of what the terms of `fit` leave; `beyond`: the robust losses beyond noise, of which its share is. Empty: runs do not
// differ.
std::optional<RunFactor> run_factor(const LeftOverRows& rows, const LeftOverFit& fit, const RobustRows& robust,
                                    double beyond);

// In seconds for delay and lag, what of the limited change shows for a ramp; `terms` have its candidate among them.
double lateness(const LeftOverRows& rows, const std::vector<LeftOverTerm>& terms, const LeftOverTerm& term);

}  // namespace kenaf::gap::diagnose
