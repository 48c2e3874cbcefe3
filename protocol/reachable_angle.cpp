#include "protocol/reachable_angle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "protocol/frames.hpp"

namespace kenaf::frames {

double reachable_angle(double wanted, double present, double min, double max) {
  constexpr double kTurn = 2 * std::numbers::pi;
  double best = 0, best_distance = std::numeric_limits<double>::infinity();
  wanted = wrap_angle(wanted);
  const double first = wanted + kTurn * std::ceil((min - wanted) / kTurn - 1e-9);
  for (double angle = first; angle <= max + 1e-9; angle += kTurn) {
    if (std::abs(angle - present) < best_distance) {
      best = std::clamp(angle, min, max);
      best_distance = std::abs(angle - present);
    }
  }
  if (std::isfinite(best_distance)) return best;
  const double to_min = std::abs(wrap_angle(wanted - min)), to_max = std::abs(wrap_angle(wanted - max));
  return to_min < to_max ? min : max;
}

}  // namespace kenaf::frames
