// Reads friction and sensors from <gazebo reference="LINK">, which liburdfdom leaves out.
//
// Thread safety: pure functions.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/describe/draft.hpp"
#include "tools/describe/urdf_model.hpp"

namespace kenaf::describe {

struct Friction {
  double along, across;
};

// <mu1> and <mu2> of the first of `links` that has them: mu1 is along <fdir1>, which is in the frame of the link's
// collision shape; without <fdir1>, mu1 counts as that along. Outside of 0 to 10 it becomes the nearest of them, with a
// warning.
std::optional<Friction> friction_of(const UrdfModel& model, const std::vector<std::size_t>& links,
                                    std::vector<std::string>& warnings);

// Adds a table [[sensor]] for each <sensor> of type imu, gps or navsat, contact, sonar, ray or lidar (also gpu_), and
// after those a [[camera]] for each camera (also depth, rgbd and the like). Other types, and more than a description
// can have, go to `warnings`. X_FB: the body's frame in F.
void append_gazebo_sensors(const UrdfModel& model, const physics::Pose& X_FB, Draft& draft,
                           std::vector<std::string>& warnings);

}  // namespace kenaf::describe
