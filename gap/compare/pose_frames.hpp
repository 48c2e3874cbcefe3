// The frames of a run: the rows in which the position of the robot in a plane was measured, the vertical one if the run
// has a height, else the ground plane.
//
// Frame W: x forward, y left, z up; intrinsic z-y-x angles, pitch positive nose down; SI units, radians. NaN: unknown.
//
// Thread safety: pure functions.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

#include "formats/runs/run_file.hpp"

namespace kenaf::gap::compare {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

enum class Plane { vertical, ground };  // (x, z), (x, y)

struct PoseFrame {
  double t_s;                           // as in the run
  double x_m;                           // always known
  double z_m;                           // known in all frames of a run or in none
  double y_m;                           // this and the angles: NaN if unknown
  double roll_rad, pitch_rad, yaw_rad;  // measured or interpolated, not wrapped
};

struct PoseFrames {
  std::vector<PoseFrame> frames;
  std::string unusable;  // why the run cannot be compared, in words; then there are no frames. Empty: it can be
};

// A row is a frame if x_m and z_m were measured; in a run without z_m, if x_m and y_m were. y_m and the angles of a
// frame are measured in the same row, or interpolated in time between the measurements before and after it (angles the
// shorter way round); before the first and after the last measurement they are unknown. Unusable: no x_m, neither z_m
// nor y_m, fewer than two frames, or a value that no robot has (a position beyond 1000 km, an angle beyond 1e6 rad, a
// time beyond 1e9 s).
PoseFrames pose_frames(const runs::Run& run);

// Returns the pose at a time between the first and the last frame, interpolated likewise; all NaN outside them.
PoseFrame pose_at(const std::vector<PoseFrame>& frames, double t_s);

// The plane in which two runs are compared: the vertical one if both have a height, else the ground plane. Neither may
// be empty.
Plane plane_of(const std::vector<PoseFrame>& real, const std::vector<PoseFrame>& sim);

// Returns the frames whose place in the plane is known.
std::vector<PoseFrame> frames_in(Plane plane, std::vector<PoseFrame> frames);

std::vector<Eigen::Vector2d> path_in(Plane plane, const std::vector<PoseFrame>& frames);

// Returns the equivalent angle in [-pi, pi].
double wrapped(double angle_rad);

// Motion of a simulated run in the ground plane: a turn by yaw_rad about its own start, then a shift.
struct StartOffset {
  double x_m = 0, y_m = 0, yaw_rad = 0;
  bool turned = true;  // false: y or yaw of a start is unknown, so it was only shifted
};

// Moves `sim` so that it starts where `real` starts, in x, y and yaw. The start is the mean over the frames of the
// first `start_s` seconds; 0: the first frame alone. If y or yaw of a start is unknown, only shifts.
StartOffset align_start(const std::vector<PoseFrame>& real, std::vector<PoseFrame>& sim, double start_s);

}  // namespace kenaf::gap::compare
