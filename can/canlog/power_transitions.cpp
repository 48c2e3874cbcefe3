#include "can/canlog/power_transitions.hpp"

#include <algorithm>

namespace kenaf::canlog {

using canopen::PowerState;

namespace {

// A drive may also leave operation by itself: on supply failure, loss of its master, or as an option code says.
const std::vector<PowerTransition>& table() {
  using enum PowerState;
  using enum DriveOrder;
  static const std::vector<PowerTransition> transitions{
      {not_ready, switch_on_disabled, {}},                     // 1
      {switch_on_disabled, ready_to_switch_on, {shutdown}},    // 2
      {ready_to_switch_on, switched_on, {switch_on, enable}},  // 3
      {switched_on, operation_enabled, {enable}},              // 4
      {ready_to_switch_on, operation_enabled, {enable}},       // 3 and 4
      {operation_enabled, switched_on, {}},                    // 5
      {switched_on, ready_to_switch_on, {}},                   // 6
      {ready_to_switch_on, switch_on_disabled, {}},            // 7
      {operation_enabled, ready_to_switch_on, {}},             // 8
      {operation_enabled, switch_on_disabled, {}},             // 9, or 11 and 12
      {switched_on, switch_on_disabled, {}},                   // 10
      {operation_enabled, quick_stop_active, {}},              // 11
      {quick_stop_active, switch_on_disabled, {}},             // 12
      {fault_reaction_active, fault, {}},                      // 14
      {fault, switch_on_disabled, {fault_reset}},              // 15
      {quick_stop_active, operation_enabled, {enable}},        // 16
  };
  return transitions;
}

}  // namespace

bool PowerTransition::ordered_by(const std::set<DriveOrder>& given) const {
  return std::ranges::any_of(orders, [&](DriveOrder order) { return given.contains(order); });
}

std::optional<PowerTransition> transition_between(PowerState from, PowerState to) {
  const auto found =
      std::ranges::find_if(table(), [&](const PowerTransition& one) { return one.from == from && one.to == to; });
  if (found != table().end()) return *found;
  // 13, and 13 and 14
  const bool is_fault = to == PowerState::fault || to == PowerState::fault_reaction_active;
  if (is_fault && from != PowerState::fault) return PowerTransition{from, to, {}};
  return std::nullopt;
}

bool has_transition(PowerState state, DriveOrder order) {
  using enum PowerState;
  switch (order) {
    case DriveOrder::disable_voltage:
    case DriveOrder::quick_stop:
    case DriveOrder::fault_reset:  // has its own rule
      return true;
    case DriveOrder::shutdown:
      return state == switch_on_disabled || state == ready_to_switch_on || state == switched_on ||
             state == operation_enabled;
    case DriveOrder::switch_on:
      return state == ready_to_switch_on || state == switched_on || state == operation_enabled;
    case DriveOrder::enable:
      return state == ready_to_switch_on || state == switched_on || state == operation_enabled ||
             state == quick_stop_active;
  }
  return false;
}

}  // namespace kenaf::canlog
