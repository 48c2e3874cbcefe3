// From nodes that are powered to nodes that are set up and operational: NMT, identity, parameters, heartbeats, PDOs.
// Nothing moves: the drives are not enabled here (power.hpp does that).
#pragma once

#include <array>

#include "can/canbus/robot_bus.hpp"
#include "libkenaf_real/master.hpp"

namespace kenaf::real {

// What the nodes say of themselves, beyond the description.
struct NodeFacts {
  std::array<double, canbus::kDriveCount> rated_current_a{};
  bool has_currents =
      true;  // false: without the rated current, in thousandths of which a drive says its own, that says nothing
  double slope_unit_rad = 0;  // of the inclinometer's numbers
};

// Refuses a bus that already has a master; begins the master's heartbeat, which goes on from here; resets the
// communication of each node, and waits for all, `patience_s` at most; writes everything that the description says;
// starts them. Throws hrt::Error: HRT_E_REFUSED another program has the robot; HRT_E_DEVICE by name who does not
// answer, is not what it should be, or refuses a value, and why.
NodeFacts commission(Master& master, const canbus::RobotBus& bus, double period_s, double patience_s);

// The objects written to a drive before its PDOs, in this order.
std::vector<canopen::SdoWrite> parameters_of(const canbus::RobotBus& bus, std::size_t drive, double period_s);

NamedNode drive_node(const canbus::RobotBus& bus, std::size_t drive);

}  // namespace kenaf::real
