// Angles that wrap, and joints with limits. Radians.
//
// Thread safety: pure functions.
#pragma once

namespace kenaf::robot {

// The same direction in (-pi, pi].
double wrap_angle(double angle_rad);

// The angle that a joint with limits turns to for a wanted direction: the equal angle within the limits that is nearest
// to the present one, or the nearer limit where no equal angle is within them.
double reachable_angle(double wanted_rad, double present_rad, double min_rad, double max_rad);

}  // namespace kenaf::robot
