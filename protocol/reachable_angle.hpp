// Where a joint with limits turns to when it is told a direction; robot and simulation alike.
#pragma once

namespace kenaf::frames {

// The angle to turn to for a wanted one: the same direction within the limits that is nearest to the present angle,
// or the nearer limit where no such angle is within them.
double reachable_angle(double wanted_rad, double present_rad, double min_rad, double max_rad);

}  // namespace kenaf::frames
