// The motion that a robot settles into on level ground with its sides at constant speeds.
#pragma once

#include "physics/robot_description.hpp"

namespace kenaf::validation {

struct SteadyMotion {
  double forward_mps, turn_radps;  // of the body, mean over the last second
};

// Flippers, if any, are folded up. Deterministic; 2 s of robot time.
SteadyMotion steady_motion(const physics::RobotDescription& robot, double left_mps, double right_mps);

}  // namespace kenaf::validation
