// Columns of a run at other times than its rows', for a page to draw. Thread safety: pure functions.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "formats/runs/run_file.hpp"

namespace kenaf::gap::playback {

// Times of a run from its first row on, at most `most` of them: every row, or every second, third ...; always the last
// one.
std::vector<double> shown_times(std::span<const double> t_s, std::size_t most);

// A column at times since the run's first row. Between two measured cells it is taken as a straight line, angles the
// short way round; NaN where they are further apart than 0.25 s and than three times what is usual in that column, and
// before the first and after the last one. Empty where the column was never measured.
std::vector<double> column_at(const runs::Run& run, std::string_view column, std::span<const double> times_s);

}  // namespace kenaf::gap::playback
