// How far a robot turned, from measured headings. The difference between end and start does not tell: it is the same
// after none, one and two whole turns, and after a turn to and fro.
#pragma once

#include <span>

namespace kenaf::draw {

// Both at least 0.
struct Turns {
  double left_rad;   // all turns to the left, summed
  double right_rad;  // all turns to the right
};

// Returns the turns through the headings `yaw_rad` (left positive, of any range, in order of time, less than half a
// turn from one to the next). A change is a turn once it is 3 degrees, and 15 times the noise of the headings: less is
// what a robot sways on its way, or noise. After any turn, left_rad - right_rad is the difference of the last and first
// heading.
Turns turns_of(std::span<const double> yaw_rad);

}  // namespace kenaf::draw
