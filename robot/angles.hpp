// Angles that wrap, and joints with limits. Radians.
//
// Thread safety: pure functions.
#pragma once

#include <span>

namespace kenaf::robot {

// The same direction in (-pi, pi].
double wrap_angle(double angle_rad);

// Adds whole turns to angles that jump by more than half a one, so that they can be interpolated and summed.
void unwrap(std::span<double> angles_rad);

// Returns the angle to which a joint with limits turns for a wanted direction: the equivalent angle (modulo a full
// turn) within the limits that is nearest to the present one, or the nearer limit if none is within them. Limits count
// as wide as a thousandth of a radian more. If they are a full turn apart at most, a wanted angle within them is itself
// the answer: half a turn goes to the end that was asked for, wherever the joint is.
double reachable_angle(double wanted_rad, double present_rad, double min_rad, double max_rad);

}  // namespace kenaf::robot
