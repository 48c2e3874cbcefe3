// Separation of two models' predictions for a run after refitting the values of both, with a limited contribution of
// each bin.
//
// Thread safety: pure functions.
#pragma once

#include <Eigen/Core>

namespace kenaf::gap::diagnose {

// Largest contribution of one bin, in standard deviations (chosen: noise reaches it in one bin of 370). A robot that
// tips in one model only differs by thousands in a few bins, at an unpredictable time; so a separation of 6 takes at
// least (6 / 3)^2 = 4 bins.
inline constexpr double kOfOneBin = 3;

// `difference`: between the two models, bin by bin, in standard deviations. `free`: one column per value of either
// model, the first-order change of the difference, with unbounded amount; may have no columns or zero columns, and need
// not have full rank. Finite.
//
// The amounts of the columns minimise the sum of Huber's losses with threshold kOfOneBin, which is convex and
// insensitive to a few outliers; the result is the root of the sum of squared residuals, each limited to kOfOneBin.
// Without residuals that large it is the length of the component orthogonal to the columns.
double separation(const Eigen::VectorXd& difference, const Eigen::MatrixXd& free);

}  // namespace kenaf::gap::diagnose
