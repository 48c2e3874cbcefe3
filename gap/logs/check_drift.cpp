// Check of clocks: a pose whose clock runs faster or slower than that of the robot's own sensors.
#include "gap/logs/clock_drift.hpp"
#include "gap/logs/merge_pose.hpp"
#include "gap/logs/run_checks.hpp"

namespace kenaf::gap::logs {
namespace {

// Both chosen.
constexpr double kLongEnough_s = 30;
constexpr double kShifts_s = 0.01;  // shift between the pose and the rest from the middle to an end

// The run without its pose, as its robot recorded it.
runs::Run without_pose(const runs::Run& run) {
  runs::Run rest;
  for (std::size_t i = 0; i < run.columns.size(); ++i) {
    if (std::ranges::count(kPoseColumns, run.columns[i]) > 0) continue;
    rest.columns.push_back(run.columns[i]);
    rest.values.push_back(run.values[i]);
  }
  return rest;
}

}  // namespace

void RunChecks::check_drift() {
  const auto t_s = column("t_s");
  const double length_s = t_s.empty() ? 0 : t_s.back() - t_s.front();
  if (length_s < kLongEnough_s || !has("x_m") || !has("y_m") || !has("yaw_rad")) return;
  try {
    const std::vector<CourseSeenTwice> courses =
        courses_seen_twice(without_pose(run_), motion_capture_of(run_, file_, LengthUnit::metres));
    const auto drift = estimate_clock_drift(courses, estimate_clock_offset(courses));
    if (!drift || std::abs(drift->rate) * length_s / 2 < kShifts_s) return;
    add(Severity::warn, "x_m",
        fmt::format(
            "the pose's clock drifts against the robot's sensors, by {:.0f} ppm (standard error {:.0f}): {:.3f} s "
            "over the run; merge the pose again from its own log, which follows the drift",
            1e6 * drift->rate, 1e6 * drift->standard_error, std::abs(drift->rate) * length_s));
  } catch (const NoOffset&) {
    // the robot hardly moves, or nothing else tells how: there is nothing to compare
  } catch (const runs::RunFileError&) {
    // the pose is no whole one: other checks say so
  }
}

}  // namespace kenaf::gap::logs
