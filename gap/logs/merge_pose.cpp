#include "gap/logs/merge_pose.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "physics/pose.hpp"

namespace kenaf::gap::logs {
namespace {

constexpr double kLongestGapSteps = 2.5;  // chosen: one captured pose may be missing

double median_step_of(const MotionCapture& capture) {
  std::vector<double> t_s;
  for (const CapturedPose& pose : capture.poses) t_s.push_back(pose.t_s);
  return median_step(t_s, t_s);
}

// Interpolates between the captured poses a and b around `t_s`: p = p_a + s (p_b - p_a), and q by slerp, with
// s = (t - t_a) / (t_b - t_a). Empty before the first pose, after the last one and in a gap.
std::optional<CapturedPose> pose_between(const MotionCapture& capture, double t_s, double max_gap_s) {
  const auto after = std::ranges::lower_bound(capture.poses, t_s, {}, &CapturedPose::t_s);
  if (after == capture.poses.end()) return std::nullopt;
  if (after->t_s == t_s) return *after;
  if (after == capture.poses.begin()) return std::nullopt;
  const CapturedPose &a = *(after - 1), &b = *after;
  if (b.t_s - a.t_s > max_gap_s) return std::nullopt;
  const double share = (t_s - a.t_s) / (b.t_s - a.t_s);
  return CapturedPose{t_s, a.p_m + share * (b.p_m - a.p_m), a.q.slerp(share, b.q)};
}

double yaw_of(const Eigen::Quaterniond& q) {
  return physics::roll_pitch_yaw(q).z();
}

// Moves all poses in the plane so that the first one, or the mean over the first `start_s`, becomes the origin:
// p' = Rz(-yaw_0) (p - p_0), q' = Rz(-yaw_0) q. p_0 has z = 0, so z, roll and pitch stay.
void put_start_at_origin(std::vector<std::optional<CapturedPose>>& poses, double start_s) {
  const auto first = std::ranges::find_if(poses, [](const auto& pose) { return pose.has_value(); });
  if (first == poses.end()) return;
  const CapturedPose start = **first;

  // The mean place, and the mean heading as the direction of the sum of heading vectors, which has no jump at pi.
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Vector2d heading = Eigen::Vector2d::Zero();
  double count = 0;
  for (const auto& pose : poses) {
    if (!pose || pose->t_s > start.t_s + start_s) continue;
    sum += pose->p_m;
    heading += Eigen::Vector2d(std::cos(yaw_of(pose->q)), std::sin(yaw_of(pose->q)));
    ++count;
  }

  const Eigen::Vector3d origin(sum.x() / count, sum.y() / count, 0);
  const Eigen::Quaterniond back(Eigen::AngleAxisd(-std::atan2(heading.y(), heading.x()), Eigen::Vector3d::UnitZ()));
  for (auto& pose : poses) {
    if (!pose) continue;
    pose->p_m = back * (pose->p_m - origin);
    pose->q = back * pose->q;
  }
}

double offset_at(const ClockDrift& drift, double time_s) {
  return drift.offset_s + drift.rate * (time_s - drift.at_s);
}

void set_clocks(MergedRun& merged, const MotionCapture& capture, const MergeOptions& options) {
  if (options.offset_s) {
    const auto t_s = merged.run.column("t_s");
    merged.offset = {.offset_s = *options.offset_s, .quantities = {}};
    merged.drift = {options.drift.value_or(0), 0, *options.offset_s, t_s.empty() ? 0 : t_s.front()};
    return;
  }
  const std::vector<CourseSeenTwice> courses = courses_seen_twice(merged.run, capture);
  merged.offset = estimate_clock_offset(courses);
  const auto estimated = options.drift ? std::nullopt : estimate_clock_drift(courses, merged.offset);
  // A given drift holds about the middle of the run, where the offset is that of all its motion.
  const auto t_s = merged.run.column("t_s");
  merged.drift = estimated.value_or(
      ClockDrift{options.drift.value_or(0), 0, merged.offset.offset_s, (t_s.front() + t_s.back()) / 2});
}

}  // namespace

MergedRun merge_pose(const runs::Run& run, const MotionCapture& capture, const MergeOptions& options) {
  const auto t_s = run.column("t_s");
  if (!t_s.empty() && !(std::abs(t_s.front()) <= kLatest_s && std::abs(t_s.back()) <= kLatest_s))
    throw runs::RunFileError(
        fmt::format("the run goes from {:.3g} to {:.3g} s, which is implausible", t_s.front(), t_s.back()));

  // Offset and drift are given or estimated: capture time = run time - offset(run time).
  MergedRun merged{run, {}, {}, 0, 0, {}};
  merged.max_gap_s = options.max_gap_s.value_or(kLongestGapSteps * median_step_of(capture));
  set_clocks(merged, capture, options);

  // The pose at each row's time, where there is one.
  std::vector<std::optional<CapturedPose>> poses;
  for (const double time_s : t_s)
    poses.push_back(pose_between(capture, time_s - offset_at(merged.drift, time_s), merged.max_gap_s));
  merged.rows_with_pose =
      static_cast<std::size_t>(std::ranges::count_if(poses, [](const auto& p) { return p.has_value(); }));
  if (merged.rows_with_pose == 0)
    throw runs::RunFileError(
        fmt::format("no row of the run lies between two captured poses at most {:.3g} s apart", merged.max_gap_s));

  if (!options.keep_frame) put_start_at_origin(poses, options.start_s);

  // Columns that the capture did not measure stay as they are in the run.
  runs::Run& out = merged.run;
  const std::array<bool, 6> measured = {true, true, capture.has_z, capture.has_tilt, capture.has_tilt, true};
  for (std::size_t i = 0; i < kPoseColumns.size(); ++i) {
    if (!measured[i]) continue;
    const std::string name(kPoseColumns[i]);
    // A column of the run that holds values is kept under another name; merging twice is refused.
    auto found = std::ranges::find(out.columns, name);
    if (found != out.columns.end() && runs::any_measured(out.column(name))) {
      const std::string kept = "recorded_" + name;
      if (!out.column(kept).empty() || std::ranges::find(out.columns, kept) != out.columns.end())
        throw runs::RunFileError(fmt::format(
            "{} has values and {} exists too: motion capture was merged before; merge into the run as it was recorded",
            name, kept));
      *found = kept;
      merged.renamed.emplace_back(name, kept);
      found = out.columns.end();
    }

    // A new column goes to the end; an empty one is filled in its place.
    if (found == out.columns.end()) {
      out.columns.push_back(name);
      out.values.emplace_back(t_s.size(), std::numeric_limits<double>::quiet_NaN());
      found = out.columns.end() - 1;
    }

    std::vector<double>& values = out.values[static_cast<std::size_t>(found - out.columns.begin())];
    for (std::size_t row = 0; row < poses.size(); ++row) {
      if (!poses[row]) continue;
      const Eigen::Vector3d rpy = physics::roll_pitch_yaw(poses[row]->q);
      const double six[] = {poses[row]->p_m.x(), poses[row]->p_m.y(), poses[row]->p_m.z(), rpy.x(), rpy.y(), rpy.z()};
      values[row] = six[i];
    }
  }
  return merged;
}

}  // namespace kenaf::gap::logs
