// Motion that a recorded run measured: how tracks and flippers turned, and how the robot moved at the start.
//
// Thread safety: values and pure functions.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "formats/runs/run_file.hpp"
#include "physics/prescribed_motion.hpp"
#include "physics/robot_description.hpp"
#include "robot/parts.hpp"

namespace kenaf::rollout {

// A quantity over the time since a run's first row: linear between its points, constant before and after them. Of two
// points at one time the second one counts from there on. Empty: never measured.
struct TimeSeries {
  std::vector<double> t_s, value;  // t_s never goes back

  bool empty() const { return t_s.empty(); }
  double at(double time_s) const;  // the series must not be empty
};

// Delays of a robot's sensor reports.
struct ReportDelays {
  double track_speed_s = 0, track_travel_s = 0, flipper_s = 0;
};
ReportDelays report_delays(const physics::RobotDescription& robot);

// A series is empty if the run did not measure it. Times are those of the reports.
struct MeasuredMotion {
  std::array<TimeSeries, robot::kTrackCount> track_mps;
  std::array<bool, robot::kTrackCount> is_held_to_travel{};
  std::array<TimeSeries, robot::kFlipperCount> flipper_rad;  // without jumps at full turns

  bool empty() const;
  // The motion at `time_s`, from reports that are `late`. A track that is held to its travel has the travel's delay.
  physics::PrescribedMotion at(double time_s, const ReportDelays& late = {}) const;
};

// Tracks: the measured speed, empty cells interpolated; before the first and after the last sample the value stays. If
// travel is measured too, speed gives the shape and travel the mean, since the noise of speed accumulates (80 mm/s at
// 20 Hz, white, are 44 mm after 6 s) and that of travel does not: over every 0.1 s (chosen: several samples of most
// logs) a constant is added to the speed, so that its integral is the travel. With travel alone: the mean speeds of
// each 0.05 s, joined at their middles; so a run that drives off at once begins with that of its first 0.05 s. A track
// with neither, like a flipper that was not measured, follows its command through its drive (manoeuvre.hpp).
MeasuredMotion measured_motion(const runs::Run& run);

// Returns the true motion of tracks and flippers at a time: `measured` without report_delays() and without the errors
// of the robot's encoders (encoder_scale, encoder_asymmetry): belts turn so that the encoders report what was measured.
physics::PrescribedMotion actual_motion(const MeasuredMotion& measured, double time_s,
                                        const physics::RobotDescription& robot, const ReportDelays& late);

// Returns the true speeds of belts whose encoders have these errors (encoder_scale, encoder_asymmetry) and report
// these.
std::array<double, robot::kTrackCount> without_encoder_errors(const physics::RobotDescription& robot,
                                                              std::array<double, robot::kTrackCount> reported_mps);

// How a robot on the ground moves when a run begins.
struct StartMotion {
  std::optional<std::array<double, robot::kTrackCount>> track_mps;  // empty: those of the body without slip
  std::optional<double> forward_mps, yaw_radps;  // of the body; empty: those that the tracks give without slip
};

// Of the body, forward and about its vertical axis.
struct BodyMotion {
  double forward_mps, yaw_radps;
};
// Returns the body's motion at the start. With known tracks, missing rates are those without slip, and yaw is limited
// to between none and that.
BodyMotion body_motion(const physics::RobotDescription& robot, const StartMotion& start);

// Returns nothing if the robot stands: both tracks turn at less than 10 mm/s, which a drive stops within 1 mm.
//
// The body's forward speed and yaw rate are those that the tracks in the first row give, each times the share of it
// that the run's poses show, since a turn on tracks slips by a third and more. The share is a slope over the whole run:
// differences of the first poses would be noise, and delay if poses are late. It is unknown if the tracks never went
// 50 mm, or 50 mm apart. It lies between 0 and 1; for yaw the caller, who knows the gauge, must clamp it. Without
// measured tracks, the motion is the slope of a cubic through the poses of the first 0.25 s, if it is beyond 4 sigma of
// their scatter; with fewer than 8 poses there the robot stands. A run that drives off at once from rest may thus get
// up to a quarter of its speed: encoders are worth having. Friction removes an error of the body's speed v within
// v^2 / (2 mu g): 6 mm for 0.3 m/s at mu g = 8 m/s^2. Sideways and vertical speeds are 0.
std::optional<StartMotion> motion_at_start(const runs::Run& run);

}  // namespace kenaf::rollout
