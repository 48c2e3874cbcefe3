// Physics settings from a command line, so that the two sides of a comparison can differ in them.
#pragma once

#include <string>
#include <string_view>

#include "physics/world.hpp"

namespace kenaf::gap::datasets {

// Applies "KEY=VALUE", with a member of PhysicsSettings as KEY: time_step_s, solver_iterations, contact_stiffness_npm,
// contact_damping_nspm. Throws std::invalid_argument that says what is wrong and which keys exist.
void set_physics(physics::PhysicsSettings& settings, std::string_view assignment);
std::string physics_text(const physics::PhysicsSettings& settings);  // "time_step_s=0.001 ..."

}  // namespace kenaf::gap::datasets
