#include "robot/angles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace kenaf::robot {

double wrap_angle(double angle_rad) {
  const double wrapped_rad = std::remainder(angle_rad, 2 * std::numbers::pi);  // in [-pi, pi]
  return wrapped_rad <= -std::numbers::pi ? std::numbers::pi : wrapped_rad;
}

void unwrap(std::span<double> angles_rad) {
  constexpr double kTurn_rad = 2 * std::numbers::pi;
  for (std::size_t i = 1; i < angles_rad.size(); ++i)
    angles_rad[i] -= kTurn_rad * std::round((angles_rad[i] - angles_rad[i - 1]) / kTurn_rad);
}

double reachable_angle(double wanted_rad, double present_rad, double min_rad, double max_rad) {
  // Chosen: half a turn, and a limit, may be written with as few digits as 3.142, and still mean the same angle.
  constexpr double kTurn_rad = 2 * std::numbers::pi, kRounding_rad = 1e-3;

  // Within a turn each direction has one angle, but for the two ends, which may be the same one: then the end that was
  // asked for, as the way to the other one leads through the directions between.
  const bool is_within = wanted_rad >= min_rad - kRounding_rad && wanted_rad <= max_rad + kRounding_rad;
  if (is_within && max_rad - min_rad <= kTurn_rad + kRounding_rad) return std::clamp(wanted_rad, min_rad, max_rad);

  // The nearest of the equivalent angles within the limits.
  const double wanted = wrap_angle(wanted_rad);
  double best = 0, best_distance = std::numeric_limits<double>::infinity();
  const double first = wanted + kTurn_rad * std::ceil((min_rad - kRounding_rad - wanted) / kTurn_rad);
  for (double angle = first; angle <= max_rad + kRounding_rad; angle += kTurn_rad) {
    if (std::abs(angle - present_rad) < best_distance) {
      best = std::clamp(angle, min_rad, max_rad);
      best_distance = std::abs(angle - present_rad);
    }
  }
  if (std::isfinite(best_distance)) return best;

  // None is within them: the nearer limit, as a direction.
  const double to_min = std::abs(wrap_angle(wanted - min_rad)), to_max = std::abs(wrap_angle(wanted - max_rad));
  return to_min < to_max ? min_rad : max_rad;
}

}  // namespace kenaf::robot
