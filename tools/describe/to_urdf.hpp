// A URDF of a robot's description, for rviz, Gazebo and other tools.
//
// Thread safety: a pure function.
#pragma once

#include <string>
#include <vector>

#include "physics/robot_description.hpp"

namespace kenaf::describe {

struct MadeUrdf {
  std::string xml;
  std::vector<std::string> left_out;  // what a URDF of this robot does not hold
};

// Makes the URDF of a robot:
// - Frames are those of REP 103 and REP 105: base_link is B, base_footprint below it on level ground, the root. Joints
//   are at 0 with flippers straight out; a flipper's positive position is tip up.
// - Tracks are fixed links of a box and two cylinders, without mass of their own. Wheels are on continuous joints about
//   y, with the limits of the drive: each wheel of a side has the same part of its effort. Casters are fixed, without
//   mass.
// - A wheel is a solid cylinder whose inertia is its share of moving_mass_kg at the rim, so twice that share of mass;
//   base_link has the rest of [body], so that all links together have its mass, centre and inertia. If no rigid body
//   has that rest, the wheels have a half of their mass, or a quarter, and so on, which `left_out` says.
// - Flippers have the inertia of uniform bodies of their shape.
// - Sensors with a place and cameras are links without mass, fixed to base_link, of the sensor's name, and <sensor> for
//   Gazebo where that has the type. Cameras also have a frame NAME_optical with z ahead (REP 103). Cameras on a
//   mission package are at its position 0.
// - Friction is <mu1> and <mu2> for Gazebo.
MadeUrdf to_urdf(const physics::RobotDescription& robot);

}  // namespace kenaf::describe
