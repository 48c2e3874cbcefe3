// Least squares in which neither a single row nor a whole run counts for all (Huber, Robust Estimation of a Location
// Parameter, 1964), of a left-over.
//
// Thread safety: values and pure functions.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "gap/diagnose/left_over_regressors.hpp"

namespace kenaf::gap::diagnose {

// Rows with what of them counts how much.
struct RobustRows {
  Eigen::VectorXd of_run;  // weight of each row's run
  double clip;             // beyond it a row counts linearly

  Eigen::VectorXd row_weights(const Eigen::VectorXd& residual) const;  // with that of the row's run
  Eigen::VectorXd losses(const Eigen::VectorXd& residual) const;       // Huber's, in squares of the residual
};

RobustRows robust_for(const LeftOverRows& rows);

// With a ridge too small to notice: alike regressors share a slope, instead of having none.
Eigen::VectorXd ridge_solution(const Eigen::MatrixXd& square, const Eigen::VectorXd& right);

// Huber's M-estimate by reweighting, over the rows whose `mask` is 1. As many slopes as x has columns.
Eigen::VectorXd robust_slopes(const Eigen::MatrixXd& x, const Eigen::VectorXd& y, const RobustRows& robust,
                              const Eigen::VectorXd& mask);

// Weighted least squares of y over x through 0, of the rows that `chosen` has; 0 where x says nothing.
double slope_through_zero(const Eigen::VectorXd& x, const Eigen::VectorXd& y, const Eigen::VectorXd& weights,
                          const std::vector<bool>& chosen);

// Whether the mean of what was gained in each unit is more than two standard errors above 0 (chosen: 2.3 % by chance).
bool is_above_chance(const std::vector<double>& gains);

// That share of the values is smaller; of at least one value.
double quantile_of(std::vector<double> values, double share);

}  // namespace kenaf::gap::diagnose
