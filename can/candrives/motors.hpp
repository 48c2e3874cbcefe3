// The motors behind the drives of kenaf-candrives, as its command line asks for them. Of these functions a build has
// one of two versions: motors_in_world.cpp, or motors_alone.cpp if it is a build without the simulator.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "can/canbus/robot_bus.hpp"
#include "can/candrives/plant.hpp"

namespace kenaf::candrives {

struct MotorOptions {
  std::string robot = "kenaf";  // a shipped name or a file
  bool ideal = false;           // motors that follow exactly, on level ground, without physics
  std::string world = "flat", log;
  double time_step_s = 0;  // of the physics
};

struct Motors {
  std::unique_ptr<Plant> plant;
  std::string in_words;  // "robot kenaf in world flat"
};

// Adds --ideal and, with the simulator, the options of its world. `options` gets their values and must outlive `app`.
void add_motor_options(CLI::App& app, MotorOptions& options);

// Throws DescriptionError or std::runtime_error: a robot, world or log that cannot be read or written, or, in a build
// without the simulator, motors that are not ideal.
Motors make_motors(const MotorOptions& options, const canbus::RobotBus& bus);

// Ideal motors, which both versions have.
Motors make_ideal_motors(const MotorOptions& options, const canbus::RobotBus& bus);

}  // namespace kenaf::candrives
