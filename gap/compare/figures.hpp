// The figures of one compared run, after figures 9 to 16 of the paper: both paths in the vertical plane, pitch, and the
// errors of position and angle per frame.
//
// Thread safety: pure functions.
#pragma once

#include <optional>

#include "gap/compare/comparison.hpp"
#include "gap/plot/chart.hpp"
#include "physics/world_description.hpp"

namespace kenaf::gap::compare {

// Side view, to scale, with the world's section behind; `world` may be null. Runs that are compared in the ground plane
// have a top view, without a world.
plot::Chart path_figure(const ComparedRun& run, const physics::WorldDescription* world, double width_px);
// Top view, to scale, of runs that are compared in the vertical plane. Empty if the robots stay near a line along x or
// y was not measured.
std::optional<plot::Chart> plan_figure(const ComparedRun& run, double width_px);
// Draws the simulated pitch at the time of the real frame that it is matched with; the yaw of runs that are compared in
// the ground plane.
plot::Chart angle_figure(const ComparedRun& run, double width_px);
plot::Chart position_error_figure(const ComparedRun& run, double width_px);
plot::Chart angle_error_figure(const ComparedRun& run, double width_px);

}  // namespace kenaf::gap::compare
