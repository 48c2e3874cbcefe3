// A quantity that accumulates over time (travel, turned angle), as samples. Its mean rate over a window is a difference
// of two values, so that a measured speed and a measured pose are compared alike and no noise is differentiated.
//
// Thread safety: pure functions.
#pragma once

#include <span>
#include <vector>

namespace kenaf::gap::logs {

struct Course {
  std::vector<double> t_s;    // strictly increasing
  std::vector<double> value;  // of the same size; its zero is arbitrary
  double longest_gap_s = 0;   // between samples farther apart the quantity is unknown
};

// From a column that is accumulated already; empty cells (NaN) are left out. Gaps up to `longest_gap_s` are bridged.
Course course_of(std::span<const double> t_s, std::span<const double> value, double longest_gap_s);
// From rates, by the trapezoidal rule.
Course course_of_rate(std::span<const double> t_s, std::span<const double> rate, double longest_gap_s);

// Interpolates linearly at `t_s`; NaN before the first sample, after the last, and within a gap.
double value_at(const Course& course, double t_s);
// Mean rate over the window centred at `t_s`; NaN if the value at one of its ends is unknown.
double mean_rate(const Course& course, double t_s, double window_s);

// Largest less smallest value of a column; empty cells (NaN) are left out. 0 if it has no value.
double range(std::span<const double> column);

// Median step between times that have a value; NaN with fewer than two of them.
double median_step(std::span<const double> t_s, std::span<const double> value);

// Defaults for making and comparing courses. All chosen.
constexpr double kStepsPerWindow = 4;             // windows overlap
double longest_gap_s(double median_step_s);       // longest gap over which turns and travel are interpolated
double comparing_window_s(double median_step_s);  // argument: of the slower of two courses

}  // namespace kenaf::gap::logs
