#include "can/candrives/ramp.hpp"

#include <algorithm>
#include <cmath>

namespace kenaf::candrives {

void ramp_to_velocity(Demand& demand, double velocity, const Ramps& ramps, double step_s) {
  const double before = demand.velocity;
  // away from 0 it accelerates; towards 0, and through it, it decelerates
  const bool grows = before * velocity >= 0 && std::abs(velocity) > std::abs(before);
  const double change = (grows ? ramps.acceleration : ramps.deceleration) * step_s;
  double after = std::abs(velocity - before) <= change ? velocity : before + std::copysign(change, velocity - before);
  if (before * after < 0) after = 0;  // a change of direction passes through standstill
  demand.velocity = after;
  demand.position += (before + after) / 2 * step_s;
}

bool move_to_position(Demand& demand, double position, double max_speed, const Ramps& ramps, double step_s) {
  const double distance = position - demand.position;
  const double direction = distance < 0 ? -1 : 1;
  const double rest = std::abs(distance), speed = demand.velocity * direction;
  // The speed v after this step from which deceleration d stops exactly at the position: (speed + v) / 2 step + v^2 /
  // (2 d) = rest.
  const double d = ramps.deceleration, half = d * step_s / 2;
  const double under_root = half * half + 2 * d * (rest - speed * step_s / 2);
  const double allowed = under_root > half * half ? std::sqrt(under_root) - half : 0;
  if (allowed <= d * step_s && std::abs(speed) <= 1.001 * d * step_s && rest <= d * step_s * step_s) {
    demand = {position, 0};
    return true;
  }
  ramp_to_velocity(demand, direction * std::min(allowed, max_speed), ramps, step_s);
  return false;
}

}  // namespace kenaf::candrives
