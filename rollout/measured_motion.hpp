// What a recorded run measured of its own motion: how tracks and flippers turned, and how it moved when it began.
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

// A quantity over the time since a run's first row: straight lines between its points, constant before and after them.
// Of two points at one time the second one counts from there on. Empty: never measured.
struct TimeSeries {
  std::vector<double> t_s, value;  // t_s never goes back

  bool empty() const { return t_s.empty(); }
  double at(double time_s) const;  // not of an empty one
};

// How long after it happened a robot's sensors report it.
struct ReportDelays {
  double track_speed_s = 0, track_travel_s = 0, flipper_s = 0;
};
ReportDelays report_delays(const physics::RobotDescription& robot);

// A series is empty where the run measured none of it. Times are those of the reports.
struct MeasuredMotion {
  std::array<TimeSeries, robot::kTrackCount> track_mps;
  std::array<bool, robot::kTrackCount> is_held_to_travel{};
  std::array<TimeSeries, robot::kFlipperCount> flipper_rad;  // without jumps at full turns

  bool empty() const;
  // What happened at a time, by what was reported of it `late`. A track that is held to its travel is as late as that.
  physics::PrescribedMotion at(double time_s, const ReportDelays& late = {}) const;
};

// Tracks: the measured speed, empty cells interpolated. Where travel is measured too, speed gives the shape and travel
// the mean, since a speed's noise adds up over time and that of travel does not: over every 0.1 s (chosen: several
// samples of most logs) a constant is added to the speed, so that it comes as far as the travel says. Where there is
// travel alone: the mean speeds of each 0.05 s, joined at their middles; so a run that drives off at once begins at
// that of its first 0.05 s.
MeasuredMotion measured_motion(const runs::Run& run);

// What tracks and flippers of a robot did at a time, if its sensors reported this of them: report_delays() and the
// errors of its encoders taken out.
physics::PrescribedMotion actual_motion(const MeasuredMotion& measured, double time_s,
                                        const physics::RobotDescription& robot, const ReportDelays& late);

// How a robot on the ground moves when a run begins.
struct StartMotion {
  std::optional<std::array<double, robot::kTrackCount>> track_mps;  // empty: what gives the body's motion without slip
  std::optional<double> forward_mps, yaw_radps;  // of the body; empty: what the tracks give without slip
};

// Empty: it stands. That is where both tracks turn at less than 10 mm/s: a drive ends that within 1 mm.
//
// The body moves as its tracks in the first row would have it, in forward speed and yaw rate, each times the share of
// it that the run's poses show: a turn on tracks slips by a third and more. That is a slope over the whole run, since
// differences of its first poses would be noise, and delay where poses are late. Tracks that never went 50 mm, or
// apart, tell of no share. It lies between 0 and 1; for yaw the caller sees to that, who knows the gauge. A run that
// never measured its tracks moves as its poses do, by a cubic through their first 0.25 s, where that is beyond 4 sigma
// of their own scatter; with fewer than 8 poses there it stands. One that drives off at once from rest may be given up
// to a quarter of its speed so: encoders are worth having.
std::optional<StartMotion> motion_at_start(const runs::Run& run);

}  // namespace kenaf::rollout
