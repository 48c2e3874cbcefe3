// The frames of a run: the rows in which the position of the robot in the vertical plane was measured.
//
// Frame W: x forward, y left, z up; intrinsic z-y-x angles, pitch positive nose down; SI units, radians. NaN: unknown.
//
// Thread safety: pure functions.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "formats/runs/run_file.hpp"

namespace kenaf::gap::compare {

struct PoseFrame {
  double t_s;                           // as in the run
  double x_m, z_m;                      // always known
  double y_m;                           // this and the angles: NaN if unknown
  double roll_rad, pitch_rad, yaw_rad;  // measured or interpolated, not wrapped
};

struct PoseFrames {
  std::vector<PoseFrame> frames;
  std::string unusable;  // why the run cannot be compared, in words; then there are no frames. Empty: it can be
};

// A row is a frame if x_m and z_m were measured. y_m and the angles of a frame are measured in the same row, or
// interpolated in time between the measurements before and after it (angles the shorter way round); before the first
// and after the last measurement they are unknown. Unusable: no x_m or z_m, fewer than two frames, or a value that no
// robot has (a position beyond 1000 km, an angle beyond 1e6 rad, a time beyond 1e9 s).
PoseFrames pose_frames(const runs::Run& run);

// Returns the pose at a time between the first and the last frame, interpolated likewise; all NaN outside them.
PoseFrame pose_at(const std::vector<PoseFrame>& frames, double t_s);

std::vector<Eigen::Vector2d> vertical_path(const std::vector<PoseFrame>& frames);

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
