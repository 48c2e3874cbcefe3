#include "gap/diagnose/number_shapes.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace kenaf::gap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

// Chosen: what more directions add is a few per cent of what numbers shift.
constexpr Index kMostDirections = 12;
// Length in noise, of numbers off by all of themselves, below which nobody sees a direction where they are off by a few
// per cent.
constexpr double kVisibleDirection = 3;

const CurvePoint* nearest_to_present(const EffectCurve& curve, double present) {
  const CurvePoint* nearest = nullptr;
  for (const CurvePoint& point : curve.points)
    if (point.column >= 0 &&
        (nearest == nullptr || std::abs(point.value - present) < std::abs(nearest->value - present)))
      nearest = &point;
  return nearest;
}

}  // namespace

std::vector<MatrixXd> number_shapes(const StageData& data, const EffectCurves& curves,
                                    std::span<const std::size_t> possible) {
  // what each number shifts, off by all of itself
  std::vector<int> columns;
  std::vector<double> scales;
  for (const std::size_t c : possible) {
    const Candidate& candidate = curves.candidates[c];
    if (candidate.whole == 0) continue;
    const CurvePoint* point = nearest_to_present(curves.curves[c], candidate.present);
    if (point == nullptr) continue;
    columns.push_back(point->column);
    scales.push_back(candidate.whole / (point->value - candidate.present));
  }
  const Eigen::Map<const Eigen::VectorXd> scale(scales.data(), std::ssize(scales));
  std::vector<MatrixXd> shifts;
  MatrixXd products = MatrixXd::Zero(std::ssize(columns), std::ssize(columns));
  for (std::size_t g = 0; g < data.groups.size(); ++g) {
    shifts.emplace_back(curves.shifts[g](Eigen::all, columns) * scale.asDiagonal());
    const MatrixXd white = data.groups[g].variance.cwiseSqrt().cwiseInverse().asDiagonal() * shifts.back();
    products.noalias() += white.transpose() * white;
  }
  if (columns.empty()) return shifts;

  // of the covariance of all shifts together the principal directions, in units of noise
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(products);
  Index count = 0;
  while (count < std::min(kMostDirections, products.cols()) &&
         eigen.eigenvalues()[products.cols() - 1 - count] > kVisibleDirection * kVisibleDirection)
    ++count;
  const MatrixXd directions = eigen.eigenvectors().rightCols(count).rowwise().reverse();
  for (MatrixXd& group : shifts) group = group * directions;
  return shifts;
}

}  // namespace kenaf::gap
