// The process data that each node of a robot's bus sends and receives, and the bus load of a cycle. docs/can-robot.md
// has it as a table; no other code knows the position of a value in a frame.
//
// A cycle begins with SYNC: the nodes latch and send their measurements; the master answers with commands, which take
// effect at the next SYNC.
#pragma once

#include <cstdint>
#include <vector>

#include "can/canbus/robot_bus.hpp"
#include "can/canopen/pdo.hpp"

namespace kenaf::canbus {

// PDOs of one drive. All frames of a cycle fit 500 kbit/s at 100 Hz in less than half of its time.
struct DrivePdos {
  canopen::Pdo state;            // TPDO1, each SYNC: statusword, position
  canopen::Pdo effort;           // TPDO2: tracks, wheels each SYNC velocity, current; flippers each fifth SYNC current
  canopen::Pdo battery;          // TPDO3, each tenth SYNC, first drive only: its supply voltage
  canopen::Pdo command;          // RPDO1, in force from SYNC: controlword and target velocity or position
  bool has_effort, has_battery;  // false: not used, if the description says that drives have no currents or no voltage
};
DrivePdos pdos_of(const RobotBus& bus, std::size_t drive);
canopen::Pdo inclinometer_pdo();  // TPDO1, each SYNC: longitudinal, lateral slope

// Returns the identifiers that the master must receive: its nodes' frames, SYNC, and another master's heartbeat.
std::vector<std::uint16_t> ids_to_hear(const RobotBus& bus);

// Returns bits per second on the wire, with the maximum of stuff bits, at this period; heartbeats included, and the
// traffic of devices of others as far as the description has it.
double worst_case_bits_per_s(const RobotBus& bus, double period_s);
double frames_per_s(const RobotBus& bus, double period_s);  // of the robot's own

}  // namespace kenaf::canbus
