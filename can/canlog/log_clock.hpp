// The times of a log's lines, made one continuous time: the recorder may have written intervals, and its clock may have
// been set back. Pure functions.
#pragma once

#include <span>
#include <vector>

#include "can/canlog/log.hpp"

namespace kenaf::canlog {

// True if times of Stamp::short_seconds are intervals (`candump -td`), not times since the first frame (`candump -tz`).
// Times since the first frame increase, but for frames within one microsecond and for steps of the clock; intervals do
// so by chance, at about half of the lines. Intervals, if more than a quarter (chosen) do not.
bool are_intervals(std::span<const canopen::RecordedFrame> lines);

// Replaces intervals by their sum.
void sum_up(std::span<canopen::RecordedFrame> lines);

// Removes the steps by which the times go back, and returns them. Lines of two senders may be out of order by less than
// a millisecond (chosen): no step; the earlier one gets the later one's time.
std::vector<ClockStep> remove_steps(std::span<LogFrame> frames);

}  // namespace kenaf::canlog
