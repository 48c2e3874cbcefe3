#include "gap/diagnose/agreement.hpp"

#include <algorithm>
#include <cmath>

namespace kenaf::gap {

Agreement agreement(const EffectCurves& curves, const Model& model, const std::vector<std::vector<std::size_t>>& groups,
                    double visible, double numerics) {
  const EffectSet effects = effects_of(model);
  const std::vector<Products> runs = products_of_runs_around(curves, model);
  const std::vector<OnCurve> common =
      fit_together(weighted_sum(runs, std::vector<double>(runs.size(), 1)), curves.curves, effects).places;
  Agreement result;
  std::vector<double> own_values(effects.size(), 0);
  for (const std::vector<std::size_t>& group : groups) {
    std::vector<double> weights(runs.size(), 0);
    for (const std::size_t run : group) weights[run] = 1;
    const Products products = weighted_sum(runs, weights);
    const double left = left_with(products, common);
    const double gained = left - fit_together(products, curves.curves, effects).left;
    result.gained += std::max(0.0, gained - numerics * std::max(0.0, products.gap_gap - left));
    for (std::size_t e = 0; e < effects.size(); ++e) {
      double moved = 0;
      for (const std::size_t run : group) moved += shift_at(curves.shifts[run], {&common[e], 1}).squaredNorm();
      if (moved >= visible) ++own_values[e];
    }
  }
  for (const double values : own_values) result.freedom += std::max(0.0, values - 1);
  return result;
}

double p_of_squares(double sum, double freedom) {
  if (freedom <= 0) return 1;
  const double spread = 2 / (9 * freedom);
  return 0.5 * std::erfc((std::cbrt(sum / freedom) - (1 - spread)) / std::sqrt(spread) / std::sqrt(2.0));
}

}  // namespace kenaf::gap
