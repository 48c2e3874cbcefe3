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

// Which of a model's effects move a group by at least `visible`; to the others it can say nothing.
std::vector<bool> shown_by(const EffectCurves& curves, const std::vector<OnCurve>& common,
                           const std::vector<std::size_t>& group, double visible) {
  std::vector<bool> shown;
  for (const OnCurve& place : common) {
    double moved = 0;
    for (const std::size_t run : group) moved += shift_at(curves.shifts[run], {&place, 1}).squaredNorm();
    shown.push_back(moved >= visible);
  }
  return shown;
}

// By values of its own for the effects that it shows, the others at the common ones.
double gained_by_group(const EffectCurves& curves, const std::vector<bool>& shown, const Products& group,
                       const std::vector<OnCurve>& common, double numerics) {
  EffectSet own;
  std::vector<OnCurve> held;
  for (std::size_t e = 0; e < common.size(); ++e)
    if (shown[e])
      own.push_back(common[e].curve);
    else
      held.push_back(common[e]);
  if (own.empty()) return 0;
  const double left = left_with(group, common);
  const double gained = left - fit_together(without_places(group, held), curves.curves, own).left;
  return std::max(0.0, gained - numerics * std::max(0.0, group.gap_gap - left));
}

// Had the runs been made by the model itself, with a column of `shapes` more.
double gained_by_shape(const EffectCurves& curves, const Model& model,
                       const std::vector<std::vector<std::size_t>>& groups,
                       const std::vector<std::vector<bool>>& shown_by_group, const std::vector<Eigen::MatrixXd>& shapes,
                       Eigen::Index column) {
  Whitened made;
  for (std::size_t r = 0; r < shapes.size(); ++r)
    made.push_back(shift_at(curves.shifts[r], model.places) + curves.whiteners[r](shapes[r].col(column)));
  const std::vector<Products> runs = products_of_runs(curves, made);
  const std::vector<OnCurve> common = common_fit(curves, effects_of(model), runs);
  double gained = 0;
  for (std::size_t g = 0; g < groups.size(); ++g)
    gained +=
        gained_by_group(curves, shown_by_group[g], weighted_sum(runs, once_each(groups[g], runs.size())), common, 0);
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
  std::vector<std::vector<bool>> shown_by_group;
  for (const std::vector<std::size_t>& group : groups) {
    const Products products = weighted_sum(runs, once_each(group, runs.size()));
    shown_by_group.push_back(shown_by(curves, common, group, visible));
    result.gained += gained_by_group(curves, shown_by_group.back(), products, common, numerics);
    for (std::size_t e = 0; e < effects.size(); ++e)
      if (shown_by_group.back()[e]) ++own_values[e];
  }
  for (const double values : own_values) result.freedom += std::max(0.0, values - 1);
  if (!shapes.empty())
    for (Eigen::Index c = 0; c < shapes.front().cols(); c += 2)
      result.of_numerics += std::max(gained_by_shape(curves, model, groups, shown_by_group, shapes, c),
                                     gained_by_shape(curves, model, groups, shown_by_group, shapes, c + 1));
  return result;
}

double p_of_squares(double sum, double freedom) {
  if (freedom <= 0) return 1;
  const double spread = 2 / (9 * freedom);
  return 0.5 * std::erfc((std::cbrt(sum / freedom) - (1 - spread)) / std::sqrt(spread) / std::sqrt(2.0));
}

}  // namespace kenaf::gap
