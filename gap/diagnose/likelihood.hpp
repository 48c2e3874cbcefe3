// How likely the residuals of a stage are under a model, with what the model lacks counted in: the covariance of a
// group is
//
//   noise (diagonal) + discrepancy (of each channel) + L L'    and over all groups together + N N'
//
// L: shapes that are open in each group by itself, N: shapes with one amount in all groups, among them what the numbers
// of the description shift that are each a little off. The sizes of the discrepancies and of that are those that make
// the residuals most likely (empirical Bayes), so a model that leaves a lot is believed less, in the channels where it
// leaves a lot. All is done by inner products of whitened columns.
//
// Thread safety: values and pure functions.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "gap/diagnose/discrepancy.hpp"
#include "gap/diagnose/stage_data.hpp"

namespace kenaf::gap::diagnose {

using GroupVectors = std::vector<Eigen::VectorXd>;  // of each group of a stage, its bins

// What a model lacks.
struct Discrepancies {
  std::vector<Discrepancy> of_kind;  // of channels
  double numbers_off = 0;            // of each number of the description, in parts of it (number_shapes.hpp), 1 sigma
};
// Nothing.
Discrepancies no_discrepancy();

// Turns differences of one group into independent numbers of variance 1, but for shared shapes.
class GroupWhitener {
 public:
  GroupWhitener(const StageGroup& group, const Discrepancies& discrepancies);
  // Columns of the group's bins.
  Eigen::MatrixXd operator()(Eigen::MatrixXd columns) const;
  double log_determinant() const { return log_determinant_; }
  // The group's shared shapes, whitened, those of the numbers as large as numbers are off.
  const Eigen::MatrixXd& shared() const { return shared_; }

 private:
  struct Part {
    Eigen::Index first, count;
    SeriesWhitener whitener;
  };
  std::vector<Part> parts_;
  Eigen::MatrixXd directions_;  // orthonormal, of the local shapes
  Eigen::VectorXd shrink_;
  Eigen::MatrixXd shared_;
  double log_determinant_ = 0;
};
std::vector<GroupWhitener> whiteners_of(const StageData& data, const Discrepancies& discrepancies);

// Inner products of columns, summed over groups, with the amounts of shared shapes integrated out: x' C^-1 y for all
// pairs of columns, C the covariance. `columns`: of each group, the same number. `weights`: of groups; empty: 1.
Eigen::MatrixXd inner_products(const std::vector<GroupWhitener>& whiteners, const std::vector<Eigen::MatrixXd>& columns,
                               std::span<const double> weights = {});

struct Likelihood {
  double deviance = 0;     // -2 log likelihood, but for a constant
  double chi_squared = 0;  // residual' C^-1 residual
  Discrepancies discrepancies;
};
// `residual`: what a model leaves, of each group. The discrepancies are estimated, beginning at `start`.
Likelihood likelihood_of(const StageData& data, const GroupVectors& residual, const Discrepancies& start);
// With given discrepancies.
Likelihood likelihood_with(const StageData& data, const GroupVectors& residual, const Discrepancies& discrepancies);

// A residual as independent numbers of variance 1, of each group: shared shapes taken off at their most likely amounts.
std::vector<Eigen::VectorXd> whitened_rest(const StageData& data, const GroupVectors& residual,
                                           const Discrepancies& discrepancies);

// A residual less what shared shapes most likely have in it, those of the description's numbers among them; of each
// group.
GroupVectors without_shared_shapes(const StageData& data, const GroupVectors& residual,
                                   const Discrepancies& discrepancies);

// The same less what the shapes that are open in each group by itself most likely have in it, too.
GroupVectors without_open_shapes(const StageData& data, const GroupVectors& residual,
                                 const Discrepancies& discrepancies);

// How far each direction of the description's numbers most likely is off, in the unit of StageGroup::number_shapes;
// none by more than 3 sigma, discrepancies.numbers_off.
Eigen::VectorXd most_likely_numbers(const StageData& data, const GroupVectors& residual,
                                    const Discrepancies& discrepancies);

// Parts of the deviance by group, for tests between models (Vuong 1989): shared shapes at their most likely amounts.
std::vector<double> deviance_of_groups(const StageData& data, const GroupVectors& residual,
                                       const Discrepancies& discrepancies);

}  // namespace kenaf::gap::diagnose
