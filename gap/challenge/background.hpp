// The background of the imperfect challenge: a robot whose description is a little off in every number.
//
// Thread safety: values and pure functions; deterministic for a seed.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "physics/robot_description.hpp"

namespace kenaf::gap::challenge {

// Largest deviation to either side, as a share of the value; of Candidate::whole if the value is 0 (chosen: the
// accuracy to which a robot is known that was built from drawings and weighed).
inline constexpr double kBackgroundOff = 0.03;

struct BackgroundNumber {
  std::string key;  // description_candidates()
  double value = 0;
};

struct Background {
  std::vector<BackgroundNumber> numbers;
  double floors = 0;  // size of the gap by it alone; known once the case is made
};

// Moves each number of the description by up to kBackgroundOff, drawn evenly, except those in `without` and those that
// duplicate another. The robot is always one that parse_robot() accepts.
Background draw_background(const physics::RobotDescription& robot, std::uint64_t seed,
                           std::span<const std::string> without);

// Throws std::runtime_error if the robot lacks one of the numbers or is invalid with them.
physics::RobotDescription with_background(physics::RobotDescription robot, const Background& background);

}  // namespace kenaf::gap::challenge
