// Travel of a track whose counter wraps: it jumps by the same length each time, while the track goes on.
//
// Thread safety: pure functions.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "formats/runs/run_file.hpp"

namespace kenaf::gap::logs {

struct WrappedTravel {
  double modulus_m;
  std::vector<std::size_t> rows;  // the first row after each jump
  std::vector<int> sign;          // of each jump
};

// Finds jumps of at least 0.05 m between samples at most longest_gap_s() apart. A jump is what a step of the travel
// differs from the integral of `speed`, or, if that is empty, from the mean of the steps beside it, where that is more
// than five times the step and ten times what is usual (all chosen). Empty if there is none, or if they differ by more
// than 5 % from their median, the modulus. A counter that was set back once counts as wrapped.
std::optional<WrappedTravel> wrapped_travel(std::span<const double> t_s, std::span<const double> travel,
                                            std::span<const double> speed);

// Adds up the travel of both tracks beyond their jumps. Returns what was done, a sentence for each column.
std::vector<std::string> unwrap_travel(runs::Run& run);

}  // namespace kenaf::gap::logs
