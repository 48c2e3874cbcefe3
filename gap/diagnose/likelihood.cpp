#include "gap/diagnose/likelihood.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

#include "gap/diagnose/channels.hpp"

namespace kenaf::gap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Chosen: sizes settle to a few per cent by then.
constexpr int kRounds = 3;
// A shape shorter than this, in standard deviations, leaves nothing open.
constexpr double kNoShape = 1e-3;

// Products of shared shapes with each other, and with a residual; the amounts that the residual makes most likely.
struct Shared {
  MatrixXd shapes;  // N' A^-1 N + 1
  VectorXd residual;
  VectorXd amounts;
  double log_determinant = 0;
};

Shared shared_of(const StageData& data, const std::vector<GroupWhitener>& whiteners, const GroupVectors& residual,
                 std::vector<VectorXd>& white) {
  const Index count = data.groups.empty() ? 0 : data.groups.front().shared_shapes.cols();
  Shared shared{MatrixXd::Identity(count, count), VectorXd::Zero(count), VectorXd::Zero(count), 0};
  white.clear();
  for (std::size_t g = 0; g < data.groups.size(); ++g) {
    MatrixXd columns(residual[g].size(), count + 1);
    columns << data.groups[g].shared_shapes, residual[g];
    columns = whiteners[g](std::move(columns));
    shared.shapes.noalias() += columns.leftCols(count).transpose() * columns.leftCols(count);
    shared.residual.noalias() += columns.leftCols(count).transpose() * columns.col(count);
    white.push_back(columns.col(count));
  }
  if (count == 0) return shared;
  const Eigen::LLT<MatrixXd> factor(shared.shapes);
  shared.amounts = factor.solve(shared.residual);
  shared.log_determinant = 2 * factor.matrixL().toDenseMatrix().diagonal().array().log().sum();
  return shared;
}

// The amounts of local shapes that a residual makes most likely, taken off it: what noise and discrepancy are left
// with.
VectorXd without_local_shapes(const StageGroup& group, const Discrepancies& discrepancies, VectorXd residual) {
  MatrixXd columns(residual.size(), group.local_shapes.cols() + 1);
  columns << group.local_shapes, residual;
  for (const Series& series : group.series)
    SeriesWhitener({group.t_s.data() + series.first, static_cast<std::size_t>(series.count)},
                   group.variance.segment(series.first, series.count), discrepancies[series.kind])
        .whiten(columns.middleRows(series.first, series.count));
  const Index count = group.local_shapes.cols();
  const auto shapes = columns.leftCols(count);
  MatrixXd normal = MatrixXd::Identity(count, count);
  normal.noalias() += shapes.transpose() * shapes;
  residual -= group.local_shapes * normal.llt().solve(shapes.transpose() * columns.col(count));
  return residual;
}

Discrepancies estimated(const StageData& data, const GroupVectors& rest) {
  Discrepancies result = no_discrepancy();
  for (std::size_t kind = 0; kind < result.size(); ++kind) {
    std::vector<SeriesOfKind> all;
    for (std::size_t g = 0; g < data.groups.size(); ++g) {
      const StageGroup& group = data.groups[g];
      for (const Series& series : group.series) {
        if (series.kind != kind) continue;
        const auto first = group.t_s.begin() + series.first;
        all.push_back({{first, first + series.count},
                       group.variance.segment(series.first, series.count),
                       rest[g].segment(series.first, series.count)});
      }
    }
    if (!all.empty()) result[kind] = most_likely_discrepancy(all);
  }
  return result;
}

}  // namespace

Discrepancies no_discrepancy() {
  return Discrepancies(kind_count());
}

GroupWhitener::GroupWhitener(const StageGroup& group, const Discrepancies& discrepancies) {
  for (const Series& series : group.series) {
    parts_.push_back({series.first, series.count,
                      SeriesWhitener({group.t_s.data() + series.first, static_cast<std::size_t>(series.count)},
                                     group.variance.segment(series.first, series.count), discrepancies[series.kind])});
    log_determinant_ += parts_.back().whitener.log_determinant();
  }
  MatrixXd shapes = group.local_shapes;
  directions_.resize(shapes.rows(), 0);
  shrink_.resize(0);
  if (shapes.cols() == 0) return;
  for (const Part& part : parts_) part.whitener.whiten(shapes.middleRows(part.first, part.count));

  // covariance in whitened units: 1 + S S'; along its direction u_i the variance is 1 + s_i^2
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(shapes.transpose() * shapes);
  const VectorXd squares = eigen.eigenvalues();
  Index first = 0;
  while (first < squares.size() && squares[first] < kNoShape * kNoShape) ++first;
  const Index count = squares.size() - first;
  directions_ =
      shapes * eigen.eigenvectors().rightCols(count) * squares.tail(count).cwiseSqrt().cwiseInverse().asDiagonal();
  shrink_ = 1 - (1 + squares.tail(count).array()).rsqrt();
  log_determinant_ += (1 + squares.tail(count).array()).log().sum();
}

MatrixXd GroupWhitener::operator()(MatrixXd columns) const {
  for (const Part& part : parts_) part.whitener.whiten(columns.middleRows(part.first, part.count));
  const MatrixXd along = shrink_.asDiagonal() * (directions_.transpose() * columns);
  columns.noalias() -= directions_ * along;
  return columns;
}

std::vector<GroupWhitener> whiteners_of(const StageData& data, const Discrepancies& discrepancies) {
  std::vector<GroupWhitener> whiteners;
  for (const StageGroup& group : data.groups) whiteners.emplace_back(group, discrepancies);
  return whiteners;
}

MatrixXd inner_products(const StageData& data, const std::vector<GroupWhitener>& whiteners,
                        const std::vector<MatrixXd>& columns, std::span<const double> weights) {
  const Index count = columns.front().cols(), shared = data.groups.front().shared_shapes.cols();
  MatrixXd sum = MatrixXd::Zero(count + shared, count + shared);
  for (std::size_t g = 0; g < data.groups.size(); ++g) {
    const double weight = weights.empty() ? 1 : weights[g];
    if (weight == 0) continue;
    MatrixXd all(columns[g].rows(), count + shared);
    all << columns[g], data.groups[g].shared_shapes;
    all = whiteners[g](std::move(all));
    sum.noalias() += weight * (all.transpose() * all);
  }

  // amounts of shared shapes, N(0, 1), integrated out: x'A^-1 y - x'A^-1 N (1 + N'A^-1 N)^-1 N'A^-1 y (Woodbury)
  MatrixXd normal = sum.bottomRightCorner(shared, shared);
  normal.diagonal().array() += 1;
  return sum.topLeftCorner(count, count) -
         sum.topRightCorner(count, shared) * normal.llt().solve(sum.bottomLeftCorner(shared, count));
}

Likelihood likelihood_with(const StageData& data, const GroupVectors& residual, const Discrepancies& discrepancies) {
  const std::vector<GroupWhitener> whiteners = whiteners_of(data, discrepancies);
  std::vector<VectorXd> white;
  const Shared shared = shared_of(data, whiteners, residual, white);
  Likelihood result{shared.log_determinant, -shared.residual.dot(shared.amounts), discrepancies};
  for (std::size_t g = 0; g < data.groups.size(); ++g) {
    result.chi_squared += white[g].squaredNorm();
    result.deviance += whiteners[g].log_determinant();
  }
  result.deviance += result.chi_squared;
  return result;
}

Likelihood likelihood_of(const StageData& data, const GroupVectors& residual, const Discrepancies& start) {
  Discrepancies discrepancies = start;
  for (int round = 0; round < kRounds; ++round) {
    // open shapes at their most likely amounts, then the discrepancies that make the rest most likely
    std::vector<VectorXd> white;
    const Shared shared = shared_of(data, whiteners_of(data, discrepancies), residual, white);
    GroupVectors rest;
    for (std::size_t g = 0; g < data.groups.size(); ++g)
      rest.push_back(without_local_shapes(data.groups[g], discrepancies,
                                          residual[g] - data.groups[g].shared_shapes * shared.amounts));
    discrepancies = estimated(data, rest);
  }
  return likelihood_with(data, residual, discrepancies);
}

std::vector<VectorXd> whitened_rest(const StageData& data, const GroupVectors& residual,
                                    const Discrepancies& discrepancies) {
  const std::vector<GroupWhitener> whiteners = whiteners_of(data, discrepancies);
  std::vector<VectorXd> white;
  const Shared shared = shared_of(data, whiteners, residual, white);
  for (std::size_t g = 0; g < data.groups.size(); ++g)
    white[g] -= whiteners[g](MatrixXd(data.groups[g].shared_shapes * shared.amounts)).col(0);
  return white;
}

std::vector<double> deviance_of_groups(const StageData& data, const GroupVectors& residual,
                                       const Discrepancies& discrepancies) {
  const std::vector<VectorXd> white = whitened_rest(data, residual, discrepancies);
  std::vector<double> result;
  for (std::size_t g = 0; g < data.groups.size(); ++g)
    result.push_back(white[g].squaredNorm() + GroupWhitener(data.groups[g], discrepancies).log_determinant());
  return result;
}

}  // namespace kenaf::gap
