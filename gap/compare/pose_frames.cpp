#include "gap/compare/pose_frames.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

namespace kenaf::gap::compare {

namespace {

constexpr double kFarthest_m = 1e6, kLargest_rad = 1e6, kLatest_s = 1e9;

enum class Kind { length, angle };

double between(double from, double to, double share, Kind kind) {
  return from + share * (kind == Kind::angle ? wrapped(to - from) : to - from);
}

// Sets a member of all frames from a column, interpolated if the frame's row has no value; NaN beyond its first and
// last value.
void fill(std::vector<PoseFrame>& frames, double PoseFrame::*member, std::span<const double> t_s,
          std::span<const double> column, Kind kind) {
  std::vector<std::size_t> measured;
  for (std::size_t row = 0; row < column.size(); ++row) {
    if (!std::isnan(column[row])) measured.push_back(row);
  }
  std::size_t next = 0;  // the first measurement that is not before the frame
  for (PoseFrame& frame : frames) {
    while (next < measured.size() && t_s[measured[next]] < frame.t_s) ++next;
    if (next == measured.size()) {
      frame.*member = std::numeric_limits<double>::quiet_NaN();
    } else if (const std::size_t row = measured[next]; t_s[row] == frame.t_s) {
      frame.*member = column[row];
    } else if (next == 0) {
      frame.*member = std::numeric_limits<double>::quiet_NaN();
    } else {
      const std::size_t earlier = measured[next - 1];
      const double share = (frame.t_s - t_s[earlier]) / (t_s[row] - t_s[earlier]);
      frame.*member = between(column[earlier], column[row], share, kind);
    }
  }
}

bool beyond(std::span<const double> column, double limit) {
  return std::ranges::any_of(column, [limit](double value) { return std::abs(value) > limit; });
}

std::string find_impossible(const runs::Run& run) {
  for (const char* name : {"x_m", "y_m", "z_m"}) {
    if (beyond(run.column(name), kFarthest_m)) return std::string(name) + " is beyond 1000 km";
  }
  for (const char* name : {"roll_rad", "pitch_rad", "yaw_rad"}) {
    if (beyond(run.column(name), kLargest_rad)) return std::string(name) + " is beyond 1000000 rad";
  }
  return beyond(run.column("t_s"), kLatest_s) ? "t_s is beyond 1000000000 s" : "";
}

struct Start {
  double x_m, y_m, yaw_rad;
  bool has_heading() const { return !std::isnan(y_m) && !std::isnan(yaw_rad); }
};

Start mean_start(const std::vector<PoseFrame>& frames, double start_s) {
  const PoseFrame& first = frames.front();
  Start sum{0, 0, 0};
  double count = 0;
  for (const PoseFrame& frame : frames) {
    if (frame.t_s > first.t_s + start_s) break;
    sum.x_m += frame.x_m;
    sum.y_m += frame.y_m;
    sum.yaw_rad += wrapped(frame.yaw_rad - first.yaw_rad);
    ++count;
  }
  return {sum.x_m / count, sum.y_m / count, first.yaw_rad + sum.yaw_rad / count};
}

}  // namespace

double wrapped(double angle_rad) {
  return std::remainder(angle_rad, 2 * std::numbers::pi);
}

PoseFrames pose_frames(const runs::Run& run) {
  const auto t_s = run.column("t_s"), x_m = run.column("x_m"), z_m = run.column("z_m");
  if (run.row_count() == 0) return {{}, "has no rows"};
  const bool has_height = runs::any_measured(z_m);
  const auto second_m = has_height ? z_m : run.column("y_m");
  if (!runs::any_measured(x_m)) return {{}, "x_m was not measured"};
  if (!runs::any_measured(second_m)) return {{}, "neither z_m nor y_m was measured"};
  if (const std::string impossible = find_impossible(run); !impossible.empty()) return {{}, impossible};

  // The frames, then their other quantities, as far as they were measured.
  PoseFrames result;
  for (std::size_t row = 0; row < t_s.size(); ++row) {
    if (std::isnan(x_m[row]) || std::isnan(second_m[row])) continue;
    result.frames.push_back(
        {t_s[row], x_m[row], has_height ? z_m[row] : kUnknown, kUnknown, kUnknown, kUnknown, kUnknown});
  }
  if (result.frames.size() < 2)
    return {{}, std::string("fewer than two rows have both x_m and ") + (has_height ? "z_m" : "y_m")};
  fill(result.frames, &PoseFrame::y_m, t_s, run.column("y_m"), Kind::length);
  fill(result.frames, &PoseFrame::roll_rad, t_s, run.column("roll_rad"), Kind::angle);
  fill(result.frames, &PoseFrame::pitch_rad, t_s, run.column("pitch_rad"), Kind::angle);
  fill(result.frames, &PoseFrame::yaw_rad, t_s, run.column("yaw_rad"), Kind::angle);
  return result;
}

PoseFrame pose_at(const std::vector<PoseFrame>& frames, double t_s) {
  const auto after = std::ranges::lower_bound(frames, t_s, {}, &PoseFrame::t_s);
  if (after == frames.end() || (after == frames.begin() && after->t_s != t_s)) {
    return {t_s, kUnknown, kUnknown, kUnknown, kUnknown, kUnknown, kUnknown};
  }
  if (after->t_s == t_s) return *after;
  const PoseFrame &a = *(after - 1), &b = *after;
  const double share = (t_s - a.t_s) / (b.t_s - a.t_s);
  return {t_s,
          between(a.x_m, b.x_m, share, Kind::length),
          between(a.z_m, b.z_m, share, Kind::length),
          between(a.y_m, b.y_m, share, Kind::length),
          between(a.roll_rad, b.roll_rad, share, Kind::angle),
          between(a.pitch_rad, b.pitch_rad, share, Kind::angle),
          between(a.yaw_rad, b.yaw_rad, share, Kind::angle)};
}

Plane plane_of(const std::vector<PoseFrame>& real, const std::vector<PoseFrame>& sim) {
  return std::isnan(real.front().z_m) || std::isnan(sim.front().z_m) ? Plane::ground : Plane::vertical;
}

std::vector<PoseFrame> frames_in(Plane plane, std::vector<PoseFrame> frames) {
  if (plane == Plane::ground) std::erase_if(frames, [](const PoseFrame& frame) { return std::isnan(frame.y_m); });
  return frames;
}

std::vector<Eigen::Vector2d> path_in(Plane plane, const std::vector<PoseFrame>& frames) {
  std::vector<Eigen::Vector2d> path;
  path.reserve(frames.size());
  for (const PoseFrame& frame : frames) path.emplace_back(frame.x_m, plane == Plane::vertical ? frame.z_m : frame.y_m);
  return path;
}

StartOffset align_start(const std::vector<PoseFrame>& real, std::vector<PoseFrame>& sim, double start_s) {
  const Start to = mean_start(real, start_s), from = mean_start(sim, start_s);
  StartOffset offset{to.x_m - from.x_m, to.y_m - from.y_m, wrapped(to.yaw_rad - from.yaw_rad),
                     to.has_heading() && from.has_heading()};
  if (!offset.turned) offset.yaw_rad = 0;
  if (std::isnan(offset.y_m)) offset.y_m = 0;

  // p' = p_start + Rz(yaw) (p - p_start) + shift
  const double c = std::cos(offset.yaw_rad), s = std::sin(offset.yaw_rad);
  for (PoseFrame& frame : sim) {
    if (offset.turned) {
      const double x = frame.x_m - from.x_m, y = frame.y_m - from.y_m;
      frame.x_m = from.x_m + c * x - (std::isnan(y) ? 0 : s * y);  // unknown y: as that of the start
      frame.y_m = from.y_m + s * x + c * y;
      frame.yaw_rad += offset.yaw_rad;
    }
    frame.x_m += offset.x_m;
    frame.y_m += offset.y_m;
  }
  return offset;
}

}  // namespace kenaf::gap::compare
