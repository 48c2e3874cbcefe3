// Merges the pose from motion capture into a run that the robot recorded. docs/logs.md describes it for users.
//
// Thread safety: pure functions.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/runs/run_file.hpp"
#include "gap/logs/clock_drift.hpp"
#include "gap/logs/clock_offset.hpp"
#include "gap/logs/motion_capture.hpp"

namespace kenaf::gap::logs {

inline constexpr std::array<std::string_view, 6> kPoseColumns = {"x_m",      "y_m",       "z_m",
                                                                 "roll_rad", "pitch_rad", "yaw_rad"};

struct MergeOptions {
  bool keep_frame = false;            // otherwise the first merged pose becomes the origin in x, y and yaw; z stays
  double start_s = 0;                 // the first pose is the mean over this time; 0: a single pose
  std::optional<double> offset_s{};   // clock offset at the run's first row, if known; empty: estimated
  std::optional<double> drift{};      // ClockDrift::rate, if known; empty: estimated, or 0 with a known offset
  std::optional<double> max_gap_s{};  // longest time between captured poses to interpolate; empty: 2.5 median steps
};

struct MergedRun {
  runs::Run run;       // columns of the run in order, then those of the pose
  ClockOffset offset;  // without quantities if it was given
  ClockDrift drift;    // which the pose's times follow; rate 0: clocks of the same speed
  double max_gap_s;
  std::size_t rows_with_pose;
  std::vector<std::pair<std::string, std::string>> renamed;  // columns that were replaced: old name, kept as
};

// Returns the quantities that run and capture both measured, for estimate_clock_offset(): turns about the body's axes
// from gyro, orientation sensor or the run's own pose; travel of the tracks, and their difference if nothing else
// measured turns. Bounds of the gain: 0.8 to 1.25 of gyros, 0.5 to 3 of belts. Tracks are not used if the body's turns
// give the offset to 10 ms.
std::vector<CourseSeenTwice> courses_seen_twice(const runs::Run& run, const MotionCapture& capture);

// Returns the run with x_m, y_m, z_m, roll_rad, pitch_rad and yaw_rad from the capture, as far as it measured them,
// interpolated at the run's own times. A pose column of the run that holds values is kept as recorded_<name>.
// Throws NoOffset; runs::RunFileError if no row of the run lies within the capture, recorded_<name> exists already, or
// the run's times are beyond kLatest_s.
MergedRun merge_pose(const runs::Run& run, const MotionCapture& capture, const MergeOptions& options);

}  // namespace kenaf::gap::logs
