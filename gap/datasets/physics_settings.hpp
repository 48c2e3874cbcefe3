// Physics settings from a command line, so that two sides of a comparison need not share them.
#pragma once

#include <string>
#include <string_view>

#include "physics/world.hpp"

namespace kenaf::gap::datasets {

// "KEY=VALUE", KEY a member of PhysicsSettings: time_step_s, solver_iterations, contact_stiffness_npm,
// contact_damping_nspm. Throws std::invalid_argument that says what is wrong and what there is.
void set_physics(physics::PhysicsSettings& settings, std::string_view assignment);
std::string physics_text(const physics::PhysicsSettings& settings);  // "time_step_s=0.001 ..."

}  // namespace kenaf::gap::datasets
