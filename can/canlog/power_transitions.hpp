// The transitions of CiA 402-2's power state machine, as a table.
#pragma once

#include <optional>
#include <set>
#include <vector>

#include "can/canlog/drive_frames.hpp"

namespace kenaf::canlog {

struct PowerTransition {
  canopen::PowerState from, to;
  std::vector<DriveOrder>
      orders;  // any of them; empty: the drive may do it by itself, on a fault, a limit or an end switch

  bool by_itself() const { return orders.empty(); }
  bool ordered_by(const std::set<DriveOrder>& given) const;
};

// Transition between the statuswords of two successive SYNCs: possibly two transitions at once, if the drive makes the
// second by itself or one order makes both.
std::optional<PowerTransition> transition_between(canopen::PowerState from, canopen::PowerState to);

// True if an order is valid in a state: it causes a transition, or keeps the state. Orders to stop ("disable voltage",
// "quick stop") are valid in each: stopping all drives must not require knowing their states.
bool has_transition(canopen::PowerState state, DriveOrder order);

}  // namespace kenaf::canlog
