// The numbers of wheels and casters, for robot_numbers.hpp.
//
// Thread safety: as there.
#pragma once

#include <string>
#include <vector>

#include "gap/candidates/robot_numbers.hpp"

namespace kenaf::gap::candidates {

// Those of each pair, "wheel[0].radius_m", "wheel[1].left_center_m[2]", "caster[0].friction"; and those of all wheels
// together, as a robot is usually measured:
// - "wheel.radius_m", "wheel.width_m", "wheel.friction_along", "wheel.friction_across": the front pair's; setting one
//   scales all pairs alike. "caster.friction": the first one's, likewise;
// - "wheel.separation_m", between the centre planes of left and right wheels, in the mean: moves all outwards alike;
// - "wheel.base_m", between the front and the rear axle: stretches the distances from their middle;
// - "wheel.forward_m" and "wheel.up_m": the middle of those axles along x, and the front axle's z: move all alike.
// Empty for a robot on tracks.
std::vector<RobotNumber> wheel_numbers(const physics::RobotDescription& robot);

// Why parse_robot() would reject the wheels; empty if it would accept them, or the robot is on tracks.
std::string why_impossible_wheels(const physics::RobotDescription& robot);

}  // namespace kenaf::gap::candidates
