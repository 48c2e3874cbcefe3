#include "gap/diagnose/agreement.hpp"

#include <algorithm>
#include <cmath>

namespace kenaf::gap {
namespace {

std::vector<double> once_each(const std::vector<std::size_t>& group, std::size_t runs) {
  std::vector<double> weights(runs, 0);
  for (const std::size_t run : group) weights[run] = 1;
  return weights;
}

std::vector<OnCurve> common_fit(const EffectCurves& curves, const EffectSet& effects,
                                const std::vector<Products>& runs) {
  return fit_together(weighted_sum(runs, std::vector<double>(runs.size(), 1)), curves.curves, effects).places;
}

double gained_by_group(const EffectCurves& curves, const EffectSet& effects, const Products& group,
                       const std::vector<OnCurve>& common, double numerics) {
  const double left = left_with(group, common);
  const double gained = left - fit_together(group, curves.curves, effects).left;
  return std::max(0.0, gained - numerics * std::max(0.0, group.gap_gap - left));
}

// Had the runs been made by the model itself, with a column of `shapes` more.
double gained_by_shape(const EffectCurves& curves, const Model& model,
                       const std::vector<std::vector<std::size_t>>& groups, const std::vector<Eigen::MatrixXd>& shapes,
                       Eigen::Index column) {
  Whitened made;
  for (std::size_t r = 0; r < shapes.size(); ++r)
    made.push_back(shift_at(curves.shifts[r], model.places) + curves.whiteners[r](shapes[r].col(column)));
  const std::vector<Products> runs = products_of_runs(curves, made);
  const EffectSet effects = effects_of(model);
  const std::vector<OnCurve> common = common_fit(curves, effects, runs);
  double gained = 0;
  for (const std::vector<std::size_t>& group : groups)
    gained += gained_by_group(curves, effects, weighted_sum(runs, once_each(group, runs.size())), common, 0);
  return gained;
}

}  // namespace

Agreement agreement(const EffectCurves& curves, const Model& model, const std::vector<std::vector<std::size_t>>& groups,
                    double visible, double numerics, const std::vector<Eigen::MatrixXd>& shapes) {
  const EffectSet effects = effects_of(model);
  const std::vector<Products> runs = products_of_runs_around(curves, model);
  const std::vector<OnCurve> common = common_fit(curves, effects, runs);
  Agreement result;
  std::vector<double> own_values(effects.size(), 0);
  for (const std::vector<std::size_t>& group : groups) {
    const Products products = weighted_sum(runs, once_each(group, runs.size()));
    result.gained += gained_by_group(curves, effects, products, common, numerics);
    for (std::size_t e = 0; e < effects.size(); ++e) {
      double moved = 0;
      for (const std::size_t run : group) moved += shift_at(curves.shifts[run], {&common[e], 1}).squaredNorm();
      if (moved >= visible) ++own_values[e];
    }
  }
  for (const double values : own_values) result.freedom += std::max(0.0, values - 1);
  if (!shapes.empty())
    for (Eigen::Index c = 0; c < shapes.front().cols(); c += 2)
      result.of_numerics += std::max(gained_by_shape(curves, model, groups, shapes, c),
                                     gained_by_shape(curves, model, groups, shapes, c + 1));
  return result;
}

double p_of_squares(double sum, double freedom) {
  if (freedom <= 0) return 1;
  const double spread = 2 / (9 * freedom);
  return 0.5 * std::erfc((std::cbrt(sum / freedom) - (1 - spread)) / std::sqrt(spread) / std::sqrt(2.0));
}

}  // namespace kenaf::gap
