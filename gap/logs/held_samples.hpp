// Finds columns whose rows repeat a value because the sensor, or its message, comes more rarely than rows are written.
//
// Thread safety: pure functions.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace kenaf::gap::logs {

struct HeldSamples {
  double hold_s;                     // median time from one new value to the next
  std::vector<std::size_t> repeats;  // rows that repeat the value before them
};

// Examines one column without its empty cells (NaN). Returns nothing if the values change from row to row, or if fewer
// than 10 changes are large enough to tell: a live sensor that reports whole counts repeats its count, too, but not
// while the measured quantity moves by many counts.
std::optional<HeldSamples> held_samples(std::span<const double> t_s, std::span<const double> values);

}  // namespace kenaf::gap::logs
