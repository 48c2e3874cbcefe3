// The drive's power state machine, transition by transition, as numbered in CiA 402-2 (IEC 61800-7-201), 10.
#include "can/candrives/power_states.hpp"

#include <catch2/catch.hpp>
#include <vector>

using namespace kenaf::candrives;
using kenaf::canopen::power_state_of;
using kenaf::canopen::PowerState;

namespace {

PowerStates in(PowerState state) {
  PowerStates machine;
  const auto go = [&](std::initializer_list<std::uint16_t> words) {
    machine.self_test_passed();
    for (const auto word : words) machine.on_controlword(word);
  };
  switch (state) {
    case PowerState::not_ready:
      break;
    case PowerState::ready_to_switch_on:
      go({0x06});
      break;
    case PowerState::switched_on:
      go({0x06, 0x07});
      break;
    case PowerState::operation_enabled:
      go({0x06, 0x07, 0x0f});
      break;
    case PowerState::quick_stop_active:
      go({0x06, 0x07, 0x0f, 0x02});
      break;
    case PowerState::fault_reaction_active:
      go({});
      machine.fault();
      break;
    case PowerState::fault:
      go({});
      machine.fault();
      machine.reaction_done();
      break;
    default:
      go({});
  }
  return machine;
}

struct Case {
  PowerState from;
  std::uint16_t controlword;
  PowerState to;
};

}  // namespace

TEST_CASE("Every state can be had, and its statusword is read as that state", "[power]") {
  for (int i = 0; i <= static_cast<int>(PowerState::fault); ++i) {
    const auto state = static_cast<PowerState>(i);
    CAPTURE(describe(state));
    CHECK(in(state).state() == state);
    CHECK(power_state_of(in(state).statusword_bits()) == state);
  }
}

TEST_CASE("Controlwords lead from state to state", "[power]") {
  using enum PowerState;
  const std::vector<Case> cases = {
      {switch_on_disabled, 0x06, ready_to_switch_on},  // 2
      {switch_on_disabled, 0x07, switch_on_disabled},
      {switch_on_disabled, 0x0f, switch_on_disabled},
      {ready_to_switch_on, 0x07, switched_on},         // 3
      {ready_to_switch_on, 0x0f, operation_enabled},   // 3 and 4
      {ready_to_switch_on, 0x00, switch_on_disabled},  // 7
      {ready_to_switch_on, 0x02, switch_on_disabled},  // 7
      {switched_on, 0x0f, operation_enabled},          // 4
      {switched_on, 0x06, ready_to_switch_on},         // 6
      {switched_on, 0x00, switch_on_disabled},         // 10
      {switched_on, 0x02, switch_on_disabled},         // 10
      {operation_enabled, 0x07, switched_on},          // 5
      {operation_enabled, 0x06, ready_to_switch_on},   // 8
      {operation_enabled, 0x00, switch_on_disabled},   // 9
      {operation_enabled, 0x02, quick_stop_active},    // 11
      {operation_enabled, 0x1f, operation_enabled},    // bits of the mode are no command
      {operation_enabled, 0x8f, operation_enabled},    // with bit 7 it is none
      {quick_stop_active, 0x00, switch_on_disabled},   // 12
      {quick_stop_active, 0x0f, operation_enabled},    // 16
      {quick_stop_active, 0x06, quick_stop_active},
      {quick_stop_active, 0x07, quick_stop_active},
      {fault_reaction_active, 0x80, fault_reaction_active},
      {fault, 0x80, switch_on_disabled},  // 15
      {fault, 0x0f, fault},
      {not_ready, 0x06, not_ready},
  };
  for (const Case& one : cases) {
    PowerStates machine = in(one.from);
    machine.on_controlword(one.controlword);
    CAPTURE(describe(one.from), one.controlword);
    CHECK(describe(machine.state()) == describe(one.to));
  }
}

TEST_CASE("A fault is reset by the rising edge of bit 7 alone", "[power]") {
  PowerStates machine = in(PowerState::operation_enabled);
  machine.on_controlword(0x8f);  // bit 7 rises before the fault
  machine.fault();
  machine.reaction_done();
  machine.on_controlword(0x80);  // and is still set
  CHECK(machine.state() == PowerState::fault);
  machine.on_controlword(0x00);
  machine.on_controlword(0x80);
  CHECK(machine.state() == PowerState::switch_on_disabled);
}

TEST_CASE("Who repeats enable does not start a drive again that stopped by itself", "[power]") {
  PowerStates machine = in(PowerState::operation_enabled);
  machine.quick_stop();
  for (int i = 0; i < 3; ++i) machine.on_controlword(0x0f);
  CHECK(machine.state() == PowerState::quick_stop_active);
  machine.on_controlword(0x02);
  machine.on_controlword(0x0f);
  CHECK(machine.state() == PowerState::operation_enabled);
}
