// By how much what two models predict of a run differs, after either may change its values, with no bin counting for
// much.
//
// Thread safety: pure functions.
#pragma once

#include <Eigen/Core>

namespace kenaf::gap::diagnose {

// What one bin may count at most, in standard deviations (chosen: noise reaches it in one bin of 370). A robot that
// tips in one model and not in the other is apart by thousands in a few bins, at a time that nobody can foretell; so it
// takes (6 / 3)^2 = 4 bins at the least to be apart by 6.
inline constexpr double kOfOneBin = 3;

// `difference`: of the two models, bin by bin, in standard deviations. `free`: a column for each direction in which a
// change of a value of one of them moves the difference, to first order and however far; may have no columns or columns
// of 0, and need not be independent. Finite.
//
// The amounts of the columns are those that leave the least sum of Huber's losses with the bend at kOfOneBin, which is
// convex and does not run after a few bins that are far out; the result is the root of the sum of squares of what is
// left, of each bin at most kOfOneBin. Where nothing is left that large this is the length of what is orthogonal to the
// columns.
double separation(const Eigen::VectorXd& difference, const Eigen::MatrixXd& free);

}  // namespace kenaf::gap::diagnose
