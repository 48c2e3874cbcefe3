// The noise of a measured series.
#pragma once

#include <span>

namespace kenaf::draw {

// Returns the standard deviation of the noise of evenly spaced values: what changes from one to the next and no motion
// does. From the median of the third differences, in which motion of constant acceleration cancels and few jerks do not
// count. Values that repeat the one before (a source slower than the rows) are left out. Noise that lasts longer than
// some values, as of a drifting source, is not seen. Zero for fewer than eight values.
double noise_of(std::span<const double> values);

}  // namespace kenaf::draw
