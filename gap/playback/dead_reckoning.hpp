// Estimates where a robot is from its own sensors, if nothing else measured it, by the library's dead reckoning
// (hrt/estimate.hpp).
//
// Thread safety: pure functions.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "formats/runs/run_file.hpp"
#include "physics/robot_description.hpp"

namespace kenaf::gap::playback {

struct ReckonedPath {
  std::vector<double> x_m, y_m,
      yaw_rad;  // for each row, in frame W; starts at (0, 0) with the first measured yaw, or 0
};

// Uses the pose's angles, or those of the orientation sensor (posture_yaw_rad, ...), whose zero is not the world's.
// Empty unless travel or speed of both tracks was measured.
std::optional<ReckonedPath> reckon(const runs::Run& run, const physics::RobotDescription& robot);

// Returns a track's travel at each row, from its encoder or its speed. An empty cell holds the value before it, at the
// start the first one. All 0 if neither was measured.
std::vector<double> travel_of(const runs::Run& run, std::string_view track);

}  // namespace kenaf::gap::playback
