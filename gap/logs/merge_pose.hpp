// Puts motion capture's pose into a run that the robot recorded. docs/logs.md describes it for users.
//
// Thread safety: pure functions.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "formats/runs/run_file.hpp"
#include "gap/logs/clock_offset.hpp"
#include "gap/logs/motion_capture.hpp"

namespace kenaf::gap::logs {

struct MergeOptions {
  bool keep_frame = false;            // else the first merged pose is the origin in x, y and yaw; z stays
  double start_s = 0;                 // the first pose is the mean over this time; 0: one pose
  std::optional<double> offset_s{};   // known, not estimated
  std::optional<double> max_gap_s{};  // a pose is only put between captured ones so near; empty: 2.5 median steps
};

struct MergedRun {
  runs::Run run;       // columns of the run in order, then those of the pose
  ClockOffset offset;  // no quantities: it was given
  double max_gap_s;
  std::size_t rows_with_pose;
  std::vector<std::pair<std::string, std::string>> renamed;  // columns that were replaced: old name, kept as
};

// What run and capture both measured, as estimate_clock_offset() compares it: turns about the body's axes from gyro,
// posture sensor or the pose that the run has; travel of the tracks, and their difference where nothing else tells
// turns.
std::vector<CourseSeenTwice> courses_seen_twice(const runs::Run& run, const MotionCapture& capture);

// The run with x_m, y_m, z_m, roll_rad, pitch_rad, yaw_rad of the capture, as far as that measured them, at the run's
// own times. A pose column of the run that holds values is kept as recorded_<name>.
// Throws NoOffset; runs::RunFileError where no row of the run lies within the capture, recorded_<name> is there, or the
// run's times are beyond kLatest_s.
MergedRun merge_pose(const runs::Run& run, const MotionCapture& capture, const MergeOptions& options);

}  // namespace kenaf::gap::logs
