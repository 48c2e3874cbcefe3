// A run for the views: the robot's pose and flipper angles at each sample time.
// Frame W: x forward, y left, z up; SI units, radians.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "formats/runs/run_file.hpp"
#include "physics/pose.hpp"
#include "physics/robot_description.hpp"
#include "tools/draw/turns.hpp"

namespace kenaf::draw {

struct Posture {
  double time_s;
  physics::Pose X_WB;
  std::array<double, robot::kFlipperCount> flipper_rad;  // tip up positive
};

struct DrivenPath {
  std::string name;
  std::vector<Posture> postures;  // at least one

  double duration_s() const;
  double length_m() const;        // driven, in space; path_length_m() keeps noise out
  Turns turns() const;            // of the yaw; turns_of() keeps noise out
  double start_to_end_m() const;  // in the ground plane
  double turned_rad() const;      // yaw at the end minus yaw at the start, in [-pi, pi]
  bool climbs() const;            // whether height or pitch change enough for a side view
};

// Rows without x_m and y_m are left out; other quantities that a row does not have keep their last value. Throws
// RunFileError if no row has a position, or one is farther than 1000 km away.
DrivenPath driven_path(const runs::Run& run, const std::string& name, const physics::RobotDescription& robot);

// Indices of evenly spaced postures, about `spacing_m` apart, including the first and the last. Turning counts as
// driving along a circle of `radius_m`.
std::vector<std::size_t> spaced_postures(const DrivenPath& path, double spacing_m, double radius_m);

}  // namespace kenaf::draw
