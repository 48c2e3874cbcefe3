// The section of a world by a vertical plane along x: the ground that a path in (x, z) is drawn against.
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "gap/plot/chart.hpp"
#include "physics/world_description.hpp"

namespace kenaf::gap::compare {

struct WorldSection {
  std::vector<std::vector<Eigen::Vector2d>> solids;                   // convex polygons (x, z) in m: boxes and planes
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> surfaces;  // lines of meshes
};

// Returns the section at `y_m` of fixed boxes, of planes from low.x to high.x and down to low.z, and of meshes. Movable
// boxes are left out. low < high in both coordinates.
WorldSection world_section(const physics::WorldDescription& world, double y_m, const Eigen::Vector2d& low,
                           const Eigen::Vector2d& high);

// Draws that section behind the contents of a chart in (x, z).
void draw_section(plot::Chart& chart, const physics::WorldDescription& world, double y_m, const Eigen::Vector2d& low,
                  const Eigen::Vector2d& high);

}  // namespace kenaf::gap::compare
