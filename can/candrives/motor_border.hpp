// The border between the plant, in SI units at tracks and flippers, and the drives, in counts of their encoders.
//
// As canbus::position_to_drive and its kin, but not rounded to what an object holds: an encoder and a ramp of a drive
// are finer than its objects.
#pragma once

#include "can/canbus/robot_bus.hpp"
#include "can/candrives/drive.hpp"
#include "can/candrives/plant.hpp"

namespace kenaf::candrives {

DriveSetup drive_setup(const canbus::RobotBus& bus, std::size_t drive);

// Limit switches of a flipper close 1 mrad before the ends of its range, so that a joint that stops there has closed
// them.
inline constexpr double kSwitchBeforeEnd_rad = 0.001;
Measured measure(const canbus::RobotBus& bus, std::size_t drive, const PlantState& state);

// What the motor of `drive` is told. A track turns at the speed demanded, and in a mode that holds a position at what
// leads to it too; without power its brake stops it. A flipper is held where it is demanded, and without power where it
// was.
void command(const canbus::RobotBus& bus, std::size_t drive, const Drive& from, const Measured& motor,
             PlantCommand& to);

}  // namespace kenaf::candrives
