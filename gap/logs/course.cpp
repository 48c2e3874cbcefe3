#include "gap/logs/course.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "gap/logs/median.hpp"

namespace kenaf::gap::logs {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

}  // namespace

Course course_of(std::span<const double> t_s, std::span<const double> value, double longest_gap_s) {
  Course course{{}, {}, longest_gap_s};
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (std::isnan(value[i])) continue;
    course.t_s.push_back(t_s[i]);
    course.value.push_back(value[i]);
  }
  return course;
}

Course course_of_rate(std::span<const double> t_s, std::span<const double> rate, double longest_gap_s) {
  Course course = course_of(t_s, rate, longest_gap_s);
  double sum = 0, before = 0;
  for (std::size_t i = 0; i < course.t_s.size(); ++i) {
    const double now = course.value[i];
    if (i > 0) sum += 0.5 * (before + now) * (course.t_s[i] - course.t_s[i - 1]);
    course.value[i] = sum;
    before = now;
  }
  return course;
}

double value_at(const Course& course, double t_s) {
  const auto after = std::ranges::lower_bound(course.t_s, t_s);
  if (after == course.t_s.end()) return kUnknown;
  const auto i = static_cast<std::size_t>(after - course.t_s.begin());
  if (*after == t_s) return course.value[i];
  if (i == 0) return kUnknown;
  const double step_s = course.t_s[i] - course.t_s[i - 1];
  if (step_s > course.longest_gap_s) return kUnknown;
  return std::lerp(course.value[i - 1], course.value[i], (t_s - course.t_s[i - 1]) / step_s);
}

double mean_rate(const Course& course, double t_s, double window_s) {
  return (value_at(course, t_s + 0.5 * window_s) - value_at(course, t_s - 0.5 * window_s)) / window_s;
}

double range(std::span<const double> column) {
  double least = INFINITY, most = -INFINITY;
  for (const double value : column) {
    if (std::isnan(value)) continue;
    least = std::min(least, value);
    most = std::max(most, value);
  }
  return most >= least ? most - least : 0;
}

double median_step(std::span<const double> t_s, std::span<const double> value) {
  std::vector<double> steps;
  double last_s = kUnknown;
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (std::isnan(value[i])) continue;
    if (!std::isnan(last_s)) steps.push_back(t_s[i] - last_s);
    last_s = t_s[i];
  }
  if (steps.empty()) return kUnknown;
  return upper_median(std::move(steps));
}

double longest_gap_s(double median_step_s) {
  return std::max(0.25, 5 * median_step_s);
}

double comparing_window_s(double median_step_s) {
  return std::max(0.2, 3 * median_step_s);
}

}  // namespace kenaf::gap::logs
