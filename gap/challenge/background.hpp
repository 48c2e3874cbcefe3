// The background of the imperfect challenge: a robot of which every number of the description is a little off.
//
// Thread safety: values and pure functions; deterministic for a seed.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "physics/robot_description.hpp"

namespace kenaf::gap::challenge {

// Of its value to either side; of a number whose value is 0, of Candidate::whole (chosen: as well as a
// robot is known that was built from drawings and weighed).
inline constexpr double kBackgroundOff = 0.03;

struct BackgroundNumber {
  std::string key;  // description_candidates()
  double value = 0;
};

struct Background {
  std::vector<BackgroundNumber> numbers;
  double floors = 0;  // how large the gap by it alone is; known once the case is made
};

// Each number of the description off by its own part of kBackgroundOff, evenly drawn, but for `without` and for those
// by which others move as well. Never a robot that parse_robot() would refuse.
Background draw_background(const physics::RobotDescription& robot, std::uint64_t seed,
                           std::span<const std::string> without);

// Throws std::runtime_error where the robot has no such number, or is refused with these.
physics::RobotDescription with_background(physics::RobotDescription robot, const Background& background);

}  // namespace kenaf::gap::challenge
