// The views that make up a picture. Each draws into its area, the labels beside it included.
#pragma once

#include <optional>
#include <vector>

#include "tools/draw/axes.hpp"
#include "tools/draw/view_parts.hpp"

namespace kenaf::draw {

struct Scene {
  physics::RobotDescription robot;
  physics::WorldDescription world;
  std::vector<DrivenPath> paths;  // the first is the run whose robot is drawn, the others are compared with it
};

// Whether the paths are so small compared with the robot that they need a view of their own.
bool needs_close_up(const Scene& scene);

// The world from above with the robot along its path. With `like`, the mapping of a side view along x, both views have
// the same x axis, if the path fits.
void draw_top_view(const Canvas& canvas, const Rectangle& area, const Scene& scene,
                   const std::optional<Mapping>& like = std::nullopt);

// The paths alone, as large as possible.
void draw_close_up(const Canvas& canvas, const Rectangle& area, const Scene& scene);

// The robot at several instants over the ground, seen at right angles to its main direction. Returns the mapping if the
// view is along y, so that x is to the right.
std::optional<Mapping> draw_side_view(const Canvas& canvas, const Rectangle& area, const Scene& scene);

}  // namespace kenaf::draw
