#include "gap/diagnose/isolability.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kenaf::gap::diagnose {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kVisible = 3;  // in noise: shorter shifts have no meaningful direction

// The point nearest to neutral that is long enough to have a direction; else the longest one.
int direction_column(const EffectCurve& curve, const VectorXd& length) {
  int best = -1;
  for (const CurvePoint& point : curve.points) {
    if (point.column < 0) continue;
    if (best < 0) {
      best = point.column;
      continue;
    }
    const bool best_visible = length[best] >= kVisible, visible = length[point.column] >= kVisible;
    if (visible == best_visible ? (visible ? length[point.column] < length[best] : length[point.column] > length[best])
                                : visible)
      best = point.column;
  }
  return best;
}

}  // namespace

Isolability isolability(const StageData& data, const EffectCurves& curves) {
  const MatrixXd products = inner_products(whiteners_of(data, no_discrepancy()), curves.shifts);
  const VectorXd length = products.diagonal().cwiseMax(0).cwiseSqrt();
  Isolability result;
  std::vector<int> columns;
  for (std::size_t c = 0; c < curves.curves.size(); ++c) {
    const int column = direction_column(curves.curves[c], length);
    if (column < 0 || length[column] < 1) continue;
    result.candidates.push_back(c);
    columns.push_back(column);
  }
  const auto count = std::ssize(columns);
  result.angle_deg = MatrixXd::Zero(count, count);
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < count; ++j) {
      if (i == j) continue;
      const int a = columns[static_cast<std::size_t>(i)], b = columns[static_cast<std::size_t>(j)];
      const double cosine = std::abs(products(a, b)) / (length[a] * length[b]);
      result.angle_deg(i, j) = std::acos(std::min(1.0, cosine)) * 180 / std::numbers::pi;
    }
  return result;
}

}  // namespace kenaf::gap::diagnose
