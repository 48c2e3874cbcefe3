// The length of a path from measured positions. The sum of all steps grows with the noise and the rate of the positions
// instead of with the way: 2 mm of noise at 100 Hz add 0.2 m a second to a robot that stands.
//
// Positions in m, in one frame, in order of time, evenly spaced to within a few times.
#pragma once

#include <span>

#include <Eigen/Core>

namespace kenaf::draw {

// Returns the length of the path through the positions: steps from one position to the first that is 15 times the noise
// of noise.hpp away, each less what noise adds on average. The error by noise is below 1 % of the length; a step of d
// cuts up to 0.3 d off a corner of 90 degrees, and (d / R)^2 / 24 of an arc of radius R. A robot that stands, or turns
// about its centre, has driven nothing.
double path_length_m(std::span<const Eigen::Vector3d> positions);

}  // namespace kenaf::draw
