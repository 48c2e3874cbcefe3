// Robust least squares for residuals, in which neither a single row nor a whole run dominates (Huber, Robust Estimation
// of a Location Parameter, 1964).
//
// Thread safety: values and pure functions.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "gap/diagnose/left_over_regressors.hpp"

namespace kenaf::gap::diagnose {

// Weights of rows and runs.
struct RobustRows {
  Eigen::VectorXd of_run;  // weight of the run of each row
  double clip;             // a row's loss is linear beyond this

  Eigen::VectorXd row_weights(const Eigen::VectorXd& residual) const;  // times that of the row's run
  Eigen::VectorXd losses(const Eigen::VectorXd& residual) const;       // Huber's, in squares of the residual
};

RobustRows robust_for(const LeftOverRows& rows);

// Solves the normal equations with a negligible ridge, so that collinear regressors share a slope.
Eigen::VectorXd ridge_solution(const Eigen::MatrixXd& square, const Eigen::VectorXd& right);

// Huber's M-estimate by iterative reweighting, over the rows whose `mask` is 1. One slope per column of x.
Eigen::VectorXd robust_slopes(const Eigen::MatrixXd& x, const Eigen::VectorXd& y, const RobustRows& robust,
                              const Eigen::VectorXd& mask);

// Weighted least-squares slope of y over x through 0, for the rows with `chosen`; 0 if x is 0 there.
double slope_through_zero(const Eigen::VectorXd& x, const Eigen::VectorXd& y, const Eigen::VectorXd& weights,
                          const std::vector<bool>& chosen);

// Whether the mean gain over units is more than two standard errors above 0 (chosen: 2.3 % by chance).
bool is_above_chance(const std::vector<double>& gains);

// The `share` quantile, linearly interpolated; needs at least one value.
double quantile_of(std::vector<double> values, double share);

}  // namespace kenaf::gap::diagnose
