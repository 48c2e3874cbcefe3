// Likelihood of a stage's residuals under a model with its discrepancy: the covariance of a group is
//
//   noise (diagonal) + discrepancy (of each channel) + L L'    and over all groups together + N N'
//
// L: local shapes, with a separate amount in each group, N: shared shapes, with one amount in all groups, here
// including those of small errors of the description's numbers (P in docs/gap-method.md). The sizes of these errors and
// of the discrepancies maximise the likelihood (empirical Bayes), so a model with large residuals is trusted less, in
// the channels where they are large. All computations are inner products of whitened columns.
//
// Thread safety: values and pure functions.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "gap/diagnose/discrepancy.hpp"
#include "gap/diagnose/stage_data.hpp"

namespace kenaf::gap::diagnose {

using GroupVectors = std::vector<Eigen::VectorXd>;  // the bins of each group of a stage

GroupVectors less(GroupVectors a, const GroupVectors& b);  // a - b

// The discrepancies of a model.
struct Discrepancies {
  std::vector<Discrepancy> of_kind;  // of channels
  double numbers_off = 0;            // relative error of each number of the description, 1 sigma (number_shapes.hpp)
};
// No discrepancy and no wrong numbers.
Discrepancies no_discrepancy();

// Transforms differences of one group into independent numbers of variance 1, except for shared shapes.
class GroupWhitener {
 public:
  GroupWhitener(const StageGroup& group, const Discrepancies& discrepancies);
  // `columns`: one row per bin of the group.
  Eigen::MatrixXd operator()(Eigen::MatrixXd columns) const;
  double log_determinant() const { return log_determinant_; }
  // The group's shared shapes, whitened; those of the numbers are scaled by numbers_off.
  const Eigen::MatrixXd& shared() const { return shared_; }
  // The most likely amounts of the group's local shapes in a residual.
  Eigen::VectorXd local_amounts(const Eigen::VectorXd& residual) const;

 private:
  struct Part {  // a series, with the local shapes that are not 0 in it, by their columns: most act in one series
    Eigen::Index first, count;
    SeriesWhitener whitener;
    std::vector<Eigen::Index> local;
    Eigen::MatrixXd shapes;  // S, whitened
  };
  void whiten_series(Eigen::MatrixXd& columns) const;
  Eigen::MatrixXd local_products(const Eigen::MatrixXd& white) const;  // S' white

  std::vector<Part> parts_;
  Eigen::MatrixXd squares_;  // S'S of the local shapes
  Eigen::MatrixXd shrink_;   // (1 + S S')^(-1/2) = 1 - S shrink S'
  Eigen::MatrixXd shared_;
  double log_determinant_ = 0;
};
std::vector<GroupWhitener> whiteners_of(const StageData& data, const Discrepancies& discrepancies);

// Inner products of columns over all groups, with the amounts of shared shapes integrated out: x' C^-1 y for all pairs
// of columns, C the covariance. `columns`: of each group, the same number. `weights`: of groups; empty: 1.
Eigen::MatrixXd inner_products(const std::vector<GroupWhitener>& whiteners, const std::vector<Eigen::MatrixXd>& columns,
                               std::span<const double> weights = {});

struct Likelihood {
  double deviance = 0;     // -2 log likelihood, up to a constant
  double chi_squared = 0;  // residual' C^-1 residual
  Discrepancies discrepancies;
};
// `residual`: of a model, for each group. Estimates the discrepancies, starting from `start`.
Likelihood likelihood_of(const StageData& data, const GroupVectors& residual, const Discrepancies& start);
// With given discrepancies.
Likelihood likelihood_with(const StageData& data, const GroupVectors& residual, const Discrepancies& discrepancies);

// A residual as independent numbers of variance 1, without shared shapes at their most likely amounts, for each group.
std::vector<Eigen::VectorXd> whitened_rest(const StageData& data, const GroupVectors& residual,
                                           const Discrepancies& discrepancies);

// Subtracts shared shapes at their most likely amounts, including those of the description's numbers, for each group.
GroupVectors without_shared_shapes(const StageData& data, const GroupVectors& residual,
                                   const Discrepancies& discrepancies);

// The same, and also subtracts each group's local shapes at their most likely amounts.
GroupVectors without_open_shapes(const StageData& data, const GroupVectors& residual,
                                 const Discrepancies& discrepancies);

// Most likely error along each direction of the description's numbers, in the unit of StageGroup::number_shapes; at
// most 1 sigma, sigma = discrepancies.numbers_off. What larger errors could be instead of an effect, all of them
// together, errors_of_values() says.
Eigen::VectorXd most_likely_numbers(const StageData& data, const GroupVectors& residual,
                                    const Discrepancies& discrepancies);

// Returns the size of errors of the description's numbers that intervals allow for, 1 sigma as a fraction: the root
// mean square of Discrepancies::numbers_off over its posterior, with the prior of a standard deviation, uniform up to
// 0.025 (Gelman 2006, Bayesian Analysis 1, 515); at least the most likely size. So few numbers show in a stage that the
// most likely size is often half the true one. 0 where that is 0.
double numbers_off_of_intervals(const StageData& data, const GroupVectors& residual, const Discrepancies& most_likely);

// The deviance by group, for tests between models (Vuong 1989), with shared shapes at their most likely amounts.
std::vector<double> deviance_of_groups(const StageData& data, const GroupVectors& residual,
                                       const Discrepancies& discrepancies);

}  // namespace kenaf::gap::diagnose
