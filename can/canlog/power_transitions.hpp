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
      orders;  // any of them; empty: the drive may do it by itself, for a fault, a limit or an end switch

  bool by_itself() const { return orders.empty(); }
  bool ordered_by(const std::set<DriveOrder>& given) const;
};

// As two statuswords of one SYNC after another show it: also two transitions at once where the drive makes the second
// by itself, or one order makes both.
std::optional<PowerTransition> transition_between(canopen::PowerState from, canopen::PowerState to);

// Whether an order means something in a state: a transition, or that the state stays. Orders to stop ("disable
// voltage", "quick stop") do in each: whoever stops all drives need not know their states.
bool has_transition(canopen::PowerState state, DriveOrder order);

}  // namespace kenaf::canlog
