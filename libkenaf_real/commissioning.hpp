// From powered nodes to configured, operational nodes: NMT, identity, parameters, heartbeats, PDOs. Nothing moves: the
// drives are not enabled here (power.hpp does that).
#pragma once

#include <vector>

#include "can/canbus/robot_bus.hpp"
#include "libkenaf_real/drive_watches.hpp"
#include "libkenaf_real/master.hpp"

namespace kenaf::real {

// Facts reported by the nodes, beyond the description.
struct NodeFacts {
  std::vector<double> rated_current_a;  // of each drive
  bool has_currents =
      true;  // false: a rated current is missing, without which a drive's current in thousandths of it has no meaning
  double slope_unit_rad = 0;  // unit of the inclinometer's numbers
  AllWatches watches;
};

// Refuses a bus that already has a master; starts the master's heartbeat, which continues from here; resets the
// communication of each node and waits for all, `can_timeout_s` at most, and as long again as a device file gives a
// drive to boot; writes all parameters of the description; starts the nodes. Throws hrt::Error: HRT_E_REFUSED if
// another program has the robot; HRT_E_DEVICE naming a node that does not answer, is not of the expected kind, or
// refuses a value, and why.
NodeFacts commission(Master& master, const canbus::RobotBus& bus, double period_s, double can_timeout_s);

NamedNode drive_node(const canbus::RobotBus& bus, std::size_t drive);

}  // namespace kenaf::real
