#include "gap/logs/clock_drift.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gap/logs/offset_refinement.hpp"

namespace kenaf::gap::logs {
namespace {

// All chosen.
constexpr double kShortestDrive_s = 20;  // in common; 100 ppm are 2 ms in it
constexpr double kPart_s = 10;           // least length of a part
constexpr int kMostParts = 16;
constexpr int kFewestParts = 3;       // with an offset: two have no scatter
constexpr double kProven = 3;         // standard errors
constexpr double kMatters_s = 0.002;  // shift of the offset from the middle to an end

struct PartOffset {
  double middle_s, offset_s, variance_s2;
};

struct CommonTime {
  double first_s = -std::numeric_limits<double>::infinity(), last_s = -first_s;  // by the robot's clock
  double length_s() const { return last_s - first_s; }
};

// The courses that determined the offset.
std::vector<const CourseSeenTwice*> used_courses(const std::vector<CourseSeenTwice>& courses,
                                                 const ClockOffset& offset) {
  std::vector<const CourseSeenTwice*> used;
  for (const CourseSeenTwice& course : courses)
    if (std::ranges::any_of(offset.quantities, [&](const auto& q) { return q.used && q.name == course.name; }))
      used.push_back(&course);
  return used;
}

CommonTime common_time(const std::vector<const CourseSeenTwice*>& courses, double offset_s) {
  CommonTime common;
  for (const CourseSeenTwice* course : courses) {
    common.first_s = std::max({common.first_s, course->robot.t_s.front(), course->capture.t_s.front() + offset_s});
    common.last_s = std::min({common.last_s, course->robot.t_s.back(), course->capture.t_s.back() + offset_s});
  }
  return common;
}

Course part_of(const Course& course, double from_s, double to_s) {
  Course part{{}, {}, course.longest_gap_s};
  for (std::size_t i = 0; i < course.t_s.size(); ++i) {
    if (course.t_s[i] < from_s || course.t_s[i] > to_s) continue;
    part.t_s.push_back(course.t_s[i]);
    part.value.push_back(course.value[i]);
  }
  return part;
}

RateWindows windows_for(const CourseSeenTwice& course) {
  const double window_s = comparing_window_s(std::max(median_step(course.robot.t_s, course.robot.value),
                                                      median_step(course.capture.t_s, course.capture.value)));
  return {window_s, window_s / kStepsPerWindow};
}

// The inverse-variance mean of the quantities' offsets within a part of the robot's time; empty if none has one.
std::optional<PartOffset> offset_of_part(const std::vector<const CourseSeenTwice*>& courses, double from_s, double to_s,
                                         double start_s) {
  double weights = 0, sum = 0;
  for (const CourseSeenTwice* course : courses) {
    CourseSeenTwice part = *course;
    part.robot = part_of(course->robot, from_s, to_s);
    if (part.robot.t_s.size() < 2) continue;
    const auto refined = refine_offset(part, windows_for(*course), start_s);
    if (!refined) continue;
    const double weight = 1 / (refined->standard_error_s * refined->standard_error_s);
    weights += weight;
    sum += weight * refined->offset_s;
  }
  if (!(weights > 0)) return std::nullopt;
  return PartOffset{(from_s + to_s) / 2, sum / weights, 1 / weights};
}

std::vector<PartOffset> offsets_of_parts(const std::vector<const CourseSeenTwice*>& courses, const CommonTime& common,
                                         double offset_s) {
  const int parts = std::clamp(static_cast<int>(common.length_s() / kPart_s), kFewestParts, kMostParts);
  const double part_s = common.length_s() / parts;
  std::vector<PartOffset> offsets;
  // Outwards from the middle, so that each part starts within reach of its neighbour however far the ends have drifted.
  for (const int direction : {1, -1}) {
    double start_s = offset_s;
    for (int k = direction > 0 ? parts / 2 : parts / 2 - 1; k >= 0 && k < parts; k += direction) {
      const double from_s = common.first_s + k * part_s;
      const auto part = offset_of_part(courses, from_s, from_s + part_s, start_s);
      if (!part) continue;
      start_s = part->offset_s;
      offsets.push_back(*part);
    }
  }
  return offsets;
}

// The line o = offset + rate (t - at) of least weighted squares, where `at` is the weighted mean of t:
//   rate = sum w (t - at) o / sum w (t - at)^2        Var(rate) = 1 / sum w (t - at)^2
ClockDrift line_through(const std::vector<PartOffset>& parts) {
  double weights = 0, at_s = 0, offset_s = 0;
  for (const PartOffset& part : parts) {
    weights += 1 / part.variance_s2;
    at_s += part.middle_s / part.variance_s2;
    offset_s += part.offset_s / part.variance_s2;
  }
  ClockDrift drift{.offset_s = offset_s / weights, .at_s = at_s / weights};
  double spread = 0, product = 0;
  for (const PartOffset& part : parts) {
    const double t_s = part.middle_s - drift.at_s;
    spread += t_s * t_s / part.variance_s2;
    product += t_s * part.offset_s / part.variance_s2;
  }
  drift.rate = product / spread;

  // The Birge ratio, with two numbers fitted.
  double chi_squared = 0;
  for (const PartOffset& part : parts) {
    const double left_s = part.offset_s - drift.offset_s - drift.rate * (part.middle_s - drift.at_s);
    chi_squared += left_s * left_s / part.variance_s2;
  }
  const double birge = std::max(1.0, std::sqrt(chi_squared / static_cast<double>(parts.size() - 2)));
  drift.standard_error = birge / std::sqrt(spread);
  return drift;
}

}  // namespace

std::optional<ClockDrift> estimate_clock_drift(const std::vector<CourseSeenTwice>& courses, const ClockOffset& offset) {
  const std::vector<const CourseSeenTwice*> used = used_courses(courses, offset);
  if (used.empty()) return std::nullopt;
  const CommonTime common = common_time(used, offset.offset_s);
  if (!(common.length_s() >= kShortestDrive_s)) return std::nullopt;
  const std::vector<PartOffset> parts = offsets_of_parts(used, common, offset.offset_s);
  if (std::ssize(parts) < kFewestParts) return std::nullopt;
  const ClockDrift drift = line_through(parts);
  const bool proven = std::abs(drift.rate) >= kProven * drift.standard_error;
  const bool matters = std::abs(drift.rate) * common.length_s() / 2 >= kMatters_s;
  return proven && matters ? std::optional(drift) : std::nullopt;
}

}  // namespace kenaf::gap::logs
