// Conversion between the plant, in SI units at tracks and flippers, and the drives, in encoder counts.
//
// As canbus::position_to_drive and its siblings, but without rounding to an object's resolution: encoder and ramp of a
// drive are finer than its objects.
#pragma once

#include "can/canbus/robot_bus.hpp"
#include "can/candrives/drive.hpp"
#include "can/candrives/plant.hpp"

namespace kenaf::candrives {

DriveSetup drive_setup(const canbus::RobotBus& bus, std::size_t drive);

// Limit switches of a flipper close 1 mrad before the ends of its range, so that a joint at its stop has closed them.
inline constexpr double kSwitchBeforeEnd_rad = 0.001;
Measured measure(const canbus::RobotBus& bus, std::size_t drive, const PlantState& state);

// Adds the command of the motor of `drive` to one whose track speeds are 0 at first. A track turns at the demanded
// speed, plus a correction towards the demanded position in modes that hold one; without power its brake stops it.
// Several drives of a side are coupled by the ground or by a belt: the side turns at the mean of their speeds. A
// flipper is held at its demand, and without power where it was.
void add_command(const canbus::RobotBus& bus, std::size_t drive, const Drive& from, const Measured& motor,
                 PlantCommand& to);

}  // namespace kenaf::candrives
