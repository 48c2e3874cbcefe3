// Which process data each node of a robot's bus sends and takes, and what a cycle of it costs. docs/can-robot.md has it
// as a table; nothing else knows where in a frame a value stands.
//
// A cycle begins with SYNC: the nodes latch and send what they measured at it; the master answers with commands, which
// the drives take at the next SYNC.
#pragma once

#include <cstdint>
#include <vector>

#include "can/canbus/robot_bus.hpp"
#include "can/canopen/pdo.hpp"

namespace kenaf::canbus {

// Of one drive. All of a cycle's frames fit 500 kbit/s at 100 Hz in less than half of its time.
struct DrivePdos {
  canopen::Pdo state;            // TPDO1, each SYNC: statusword, position
  canopen::Pdo effort;           // TPDO2: tracks at each SYNC velocity, current; flippers at each fifth current
  canopen::Pdo battery;          // TPDO3, each tenth SYNC, of the left track alone: the voltage of its supply
  canopen::Pdo command;          // RPDO1, taken at SYNC: controlword and target velocity or position
  bool has_effort, has_battery;  // false: not used, where the description says that drives have no currents, no voltage
};
DrivePdos pdos_of(const RobotBus& bus, std::size_t drive);
canopen::Pdo inclinometer_pdo();  // TPDO1, each SYNC: longitudinal, lateral slope

// The identifiers that the master has to hear: what its nodes send, SYNC, and another master's heartbeat.
std::vector<std::uint16_t> ids_to_hear(const RobotBus& bus);

// Bits a second on the wire, with as many stuff bits as there can be, at this period; heartbeats are part of it.
double worst_case_bits_per_s(const RobotBus& bus, double period_s);
double frames_per_s(const RobotBus& bus, double period_s);

}  // namespace kenaf::canbus
