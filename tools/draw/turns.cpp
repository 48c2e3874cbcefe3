#include "tools/draw/turns.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "robot/angles.hpp"
#include "tools/draw/noise.hpp"

namespace kenaf::draw {

namespace {

constexpr double kLeastTurn_rad = 3 * std::numbers::pi / 180;  // chosen: nobody sees less as a turn
constexpr double kTurnInNoises = 15;                           // chosen: as of a path's steps

}  // namespace

Turns turns_of(std::span<const double> yaw_rad) {
  std::vector<double> yaw(yaw_rad.begin(), yaw_rad.end());
  robot::unwrap(yaw);
  if (yaw.empty()) return {0, 0};
  const double least_rad = std::max(kLeastTurn_rad, kTurnInNoises * noise_of(yaw));

  // A turn ends at its extreme, which shows once the heading has come back by a turn's least size. The first begins and
  // the last ends at a measured heading, not at an extreme, which noise would put too far out.
  Turns turns{0, 0};
  const auto add = [&turns](double by_rad) { (by_rad > 0 ? turns.left_rad : turns.right_rad) += std::abs(by_rad); };
  double from = yaw.front(), low = from, high = from;
  int side = 0;  // of the turn under way: 1 left, -1 right, 0 before the first
  for (const double heading : yaw) {
    low = std::min(low, heading);
    high = std::max(high, heading);
    if (side >= 0 && heading <= high - least_rad) {
      if (side > 0) add(high - from), from = high;
      side = -1, low = heading;
    } else if (side <= 0 && heading >= low + least_rad) {
      if (side < 0) add(low - from), from = low;
      side = 1, high = heading;
    }
  }
  if (side != 0) add(yaw.back() - from);
  return turns;
}

}  // namespace kenaf::draw
