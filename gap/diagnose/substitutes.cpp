#include "gap/diagnose/substitutes.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace kenaf::gap::diagnose {

using Eigen::Index;
using Eigen::MatrixXd;

MatrixXd products_of_effects(const StageData& data, const StandingModel& standing) {
  const std::vector<OnCurve>& places = standing.model.places;
  std::vector<MatrixXd> shifts;
  for (const StageGroup& group : data.groups) shifts.emplace_back(std::ssize(group.bins), std::ssize(places));
  for (std::size_t e = 0; e < places.size(); ++e) {
    const GroupVectors own = shift_of(standing.curves, {&places[e], 1});
    for (std::size_t g = 0; g < shifts.size(); ++g) shifts[g].col(static_cast<Index>(e)) = own[g];
  }
  return inner_products(whiteners_of(data, no_discrepancy()), shifts);
}

double least_apart(const MatrixXd& products, std::span<const std::size_t> places) {
  double least = 1;
  for (const std::size_t a : places)
    for (const std::size_t b : places) {
      const auto i = static_cast<Index>(a), k = static_cast<Index>(b);
      const double lengths = products(i, i) * products(k, k);
      if (i >= k || !(lengths > 0)) continue;
      const double squared_cosine = products(i, k) * products(i, k) / lengths;
      least = std::min(least, std::sqrt(std::max(0.0, 1 - squared_cosine)));
    }
  return least;
}

}  // namespace kenaf::gap::diagnose
