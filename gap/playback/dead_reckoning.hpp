// Where a robot is by its own sensors, where nothing else measured it: by the library's dead reckoning
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
  std::vector<double> x_m, y_m, yaw_rad;  // of each row; frame W: from (0, 0), with the first measured yaw, or 0
};

// By the pose's angles, or the posture sensor's (posture_yaw_rad, ...), whose zero is not the world's. Nothing where
// not both tracks' travel or speed was measured.
std::optional<ReckonedPath> reckon(const runs::Run& run, const physics::RobotDescription& robot);

// A track's travel at each row, from its encoder or its speed; a hole holds what was before, and one at the start what
// comes first. All 0 where neither was measured.
std::vector<double> travel_of(const runs::Run& run, std::string_view track);

}  // namespace kenaf::gap::playback
