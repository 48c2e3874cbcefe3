// Angles that wrap, and joints with limits. Radians.
//
// Thread safety: pure functions.
#pragma once

namespace kenaf::robot {

// The same direction in (-pi, pi].
double wrap_angle(double angle_rad);

// Returns the angle to which a joint with limits turns for a wanted direction: the equivalent angle (modulo a full
// turn) within the limits that is nearest to the present one, or the nearer limit if none is within them.
double reachable_angle(double wanted_rad, double present_rad, double min_rad, double max_rad);

}  // namespace kenaf::robot
