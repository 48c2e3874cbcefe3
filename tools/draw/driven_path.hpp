// A run as the views need it: the robot's pose and flipper angles at each sample time.
// Frame W: x forward, y left, z up; SI units, radians.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "formats/runs/run_file.hpp"
#include "physics/pose.hpp"
#include "physics/robot_description.hpp"

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
  double length_m() const;        // driven, in space
  double start_to_end_m() const;  // in the ground plane
  double turned_rad() const;      // yaw at the end less yaw at the start, in (-pi, pi]
  bool climbs() const;            // height or pitch change enough to be seen from the side
};

// Rows without x_m and y_m are left out; other quantities that a row does not have keep their last value. Throws
// RunFileError where no row has a position, or one is farther than 1000 km away.
DrivenPath driven_path(const runs::Run& run, const std::string& name, const physics::RobotDescription& robot);

// Indices of postures evenly apart, about `spacing_m`, turning counted as driving along a circle of `radius_m`; the
// first and the last are among them.
std::vector<std::size_t> spaced_postures(const DrivenPath& path, double spacing_m, double radius_m);

}  // namespace kenaf::draw
