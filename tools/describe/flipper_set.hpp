// The four flippers of a URDF as one, of which the others are mirror images. Thread safety: as running_gear.hpp.
#pragma once

#include "tools/describe/running_gear.hpp"

namespace kenaf::describe {

// `y_m`: of the plane of symmetry in F. Throws as find_running_gear().
FlipperSet find_flippers(const UrdfModel& model, const std::vector<std::size_t>& heads, double y_m, Meshes& meshes,
                         double tolerance_m, std::vector<std::string>& warnings);

}  // namespace kenaf::describe
