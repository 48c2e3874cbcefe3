// Recognises sample times that are not in seconds.
//
// Thread safety: pure functions.
#pragma once

#include <optional>
#include <span>
#include <string>

namespace kenaf::runs {

struct TimeUnit {
  std::string words;  // "nanoseconds since 1970"
  double in_a_second;
};

// Returns the unit of increasing times if it is certainly another than the second. Since 1970: the first time lies
// between 1999 and 2099 in that unit, and the median step is 0.1 ms to 10 s. Since any other moment, as a computer's
// start: the median step is more than 10, too long for one in seconds, and 2 ms to 0.5 s in this unit alone (limits
// chosen). Empty with fewer than ten times.
std::optional<TimeUnit> time_unit(std::span<const double> times);

}  // namespace kenaf::runs
