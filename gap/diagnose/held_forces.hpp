// Forces between belts and flippers of a robot that stands. Friction holds whatever it was put down with: the motors'
// currents before the first command to move follow from how the robot came to stand, which no log records (a
// statically indeterminate contact, whose tangential forces depend on the history of loading: Johnson 1985, Contact
// Mechanics, ch. 7).
//
// Thread safety: pure functions.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

#include "gap/diagnose/stage_features.hpp"

namespace kenaf::gap::diagnose {

// Those of `channels` that are currents of motors.
std::vector<std::size_t> motor_currents(std::span<const std::size_t> channels);

// For each of `currents`, in columns: by how much its bins shift if the robot holds twice what it was measured to hold
// while it stood, or nothing (1 sigma either way, chosen); 0 after the first command to move.
Eigen::MatrixXd held_forces(const StageFeatures& run, std::span<const std::size_t> currents);

}  // namespace kenaf::gap::diagnose
