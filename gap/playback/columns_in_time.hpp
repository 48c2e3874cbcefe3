// Resamples columns of a run for a page to draw. Thread safety: pure functions.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "formats/runs/run_file.hpp"

namespace kenaf::gap::playback {

// Returns at most `most` times of a run, counted from its first row: every row, or every second, third, ..., and always
// the last one.
std::vector<double> shown_times(std::span<const double> t_s, std::size_t most);

// Returns a column at times since the run's first row. Interpolates linearly between measured cells, angles the shorter
// way round; NaN between cells farther apart than 0.25 s and three median steps of the column, before the first and
// after the last one. Empty if the column was never measured.
std::vector<double> column_at(const runs::Run& run, std::string_view column, std::span<const double> times_s);

}  // namespace kenaf::gap::playback
