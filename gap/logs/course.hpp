// A quantity that adds up over time (travel, turned angle), as samples. Its mean rate over a window is a difference of
// two values, so that a measured speed and a measured pose are compared alike, and nothing noisy is differentiated.
//
// Thread safety: pure functions.
#pragma once

#include <span>
#include <vector>

namespace kenaf::gap::logs {

struct Course {
  std::vector<double> t_s;    // strictly increasing
  std::vector<double> value;  // of the same size; its zero is anywhere
  double longest_gap_s = 0;   // between samples farther apart nothing is known
};

// From values of a column that adds up already; empty cells (NaN) are left out. Gaps up to `longest_gap_s` are bridged.
Course course_of(std::span<const double> t_s, std::span<const double> value, double longest_gap_s);
// From rates, by the trapezoidal rule.
Course course_of_rate(std::span<const double> t_s, std::span<const double> rate, double longest_gap_s);

// At `t_s`, between samples on a straight line; NaN before the first, after the last, and within a gap.
double value_at(const Course& course, double t_s);
// Over the window around `t_s`; NaN where an end of it is not known.
double mean_rate(const Course& course, double t_s, double window_s);

// From the least to the most of a column; empty cells (NaN) are left out. 0 where there is none.
double range(std::span<const double> column);

// Of the steps between the times that have a value; NaN with fewer than two.
double median_step(std::span<const double> t_s, std::span<const double> value);

// How courses are made and compared where a log says nothing else. All chosen.
constexpr double kStepsPerWindow = 4;             // windows overlap
double longest_gap_s(double median_step_s);       // over which turns and travel go on as if nothing had happened
double comparing_window_s(double median_step_s);  // of the slower of two courses

}  // namespace kenaf::gap::logs
