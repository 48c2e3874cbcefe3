// Poses that a motion-capture system (or lidar, total station) recorded of the robot, read from its CSV file.
//
// Thread safety: pure functions.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <string_view>
#include <vector>

#include "formats/runs/run_file.hpp"

namespace kenaf::gap::logs {

// Largest absolute time of a robot or a capture; larger numbers would lose their small digits.
inline constexpr double kLatest_s = 1e12;

enum class LengthUnit { metres, millimetres };

struct CapturedPose {
  double t_s;            // on the capture's own clock
  Eigen::Vector3d p_m;   // z 0 where not measured
  Eigen::Quaterniond q;  // roll and pitch 0 where not measured
};

struct MotionCapture {
  std::vector<CapturedPose> poses;  // in order of time
  bool has_z, has_tilt;
};

// Columns: t_s; x_m, y_m and, if measured, z_m; yaw_rad and, if measured, roll_rad and pitch_rad; or qx, qy, qz, qw in
// any order instead of the angles. Lengths may also be named x_mm, ... and angles roll_deg, ...; `unit` is that of
// columns without _mm. Other columns are ignored. A row in which one of these is empty is no measurement.
// Throws RunFileError with the file's name, and with line and column if a cell is wrong, if a column is missing or
// present in two forms, there are fewer than two poses, or a quaternion is not of unit norm.
MotionCapture parse_motion_capture(std::string_view text, std::string_view name_for_errors, LengthUnit unit);
MotionCapture motion_capture_of(const runs::Run& table, std::string_view name_for_errors, LengthUnit unit);

}  // namespace kenaf::gap::logs
