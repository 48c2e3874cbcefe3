// Columns in which rows only repeat a value: the sensor, or the message that brings it, comes more rarely than rows are
// written.
//
// Thread safety: pure functions.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace kenaf::gap::logs {

struct HeldSamples {
  double hold_s;                     // from one new value to the next, the median
  std::vector<std::size_t> repeats;  // rows that repeat the value before them
};

// Of one column; empty cells (NaN) are no rows. Empty where the values change from row to row, and where fewer than 10
// of them change by so much that it shows: a live sensor that is written in whole counts repeats its count, too, but
// not while what it measures moves by many of them.
std::optional<HeldSamples> held_samples(std::span<const double> t_s, std::span<const double> values);

}  // namespace kenaf::gap::logs
