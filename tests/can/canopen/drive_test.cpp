#include <catch2/catch.hpp>
#include <map>
#include <utility>

#include "can/canopen/drive.hpp"

using namespace kenaf::canopen;

namespace {

// A drive by the rules of CiA 402-2: controlword commands and the transitions that they cause (its tables of the
// controlword's bits and of the transitions), one for each controlword that it gets.
class RuleDrive {
 public:
  PowerState state = PowerState::switch_on_disabled;

  void control(std::uint16_t word) {
    const bool reset_edge = (word & 0x80) != 0 && (last_ & 0x80) == 0;
    last_ = word;
    if (state == PowerState::fault) {
      if (reset_edge) state = PowerState::switch_on_disabled;  // 15
      return;
    }
    if ((word & 0x80) != 0) return;  // no command of bits 0 to 3
    const bool disable_voltage = (word & 0x02) == 0;
    const bool quick_stop = (word & 0x06) == 0x02;
    const bool shutdown = (word & 0x07) == 0x06;
    const bool switch_on = (word & 0x0f) == 0x07;
    const bool enable = (word & 0x0f) == 0x0f;
    switch (state) {
      case PowerState::switch_on_disabled:
        if (shutdown) state = PowerState::ready_to_switch_on;  // 2
        break;
      case PowerState::ready_to_switch_on:
        if (disable_voltage || quick_stop) state = PowerState::switch_on_disabled;  // 7
        if (switch_on || enable) state = PowerState::switched_on;                   // 3
        break;
      case PowerState::switched_on:
        if (disable_voltage || quick_stop) state = PowerState::switch_on_disabled;  // 10
        if (shutdown) state = PowerState::ready_to_switch_on;                       // 6
        if (enable) state = PowerState::operation_enabled;                          // 4
        break;
      case PowerState::operation_enabled:
        if (disable_voltage) state = PowerState::switch_on_disabled;  // 9
        if (quick_stop) state = PowerState::quick_stop_active;        // 11
        if (shutdown) state = PowerState::ready_to_switch_on;         // 8
        if (switch_on) state = PowerState::switched_on;               // 5
        break;
      case PowerState::quick_stop_active:
        if (disable_voltage) state = PowerState::switch_on_disabled;  // 12
        break;
      default:
        break;
    }
  }

 private:
  std::uint16_t last_ = 0;
};

int cycles_to_operation(RuleDrive& drive, std::uint16_t& control) {
  int cycles = 0;
  while (drive.state != PowerState::operation_enabled && cycles < 20) {
    control = control_towards_operation(drive.state, control);
    drive.control(control);
    ++cycles;
  }
  return cycles;
}

}  // namespace

TEST_CASE("Power states of statuswords as drives send them") {
  // High byte and bits 4 and 7 do not count: voltage enabled 0x10, warning 0x80, remote 0x200, target reached 0x400.
  CHECK(power_state_of(0x0000) == PowerState::not_ready);
  CHECK(power_state_of(0x0250) == PowerState::switch_on_disabled);
  CHECK(power_state_of(0x0270) == PowerState::switch_on_disabled);  // bit 5 is open in this state
  CHECK(power_state_of(0x0231) == PowerState::ready_to_switch_on);
  CHECK(power_state_of(0x0233) == PowerState::switched_on);
  CHECK(power_state_of(0x0637) == PowerState::operation_enabled);
  CHECK(power_state_of(0x16b7) == PowerState::operation_enabled);
  CHECK(power_state_of(0x0617) == PowerState::quick_stop_active);
  CHECK(power_state_of(0x021f) == PowerState::fault_reaction_active);
  CHECK(power_state_of(0x0218) == PowerState::fault);
  CHECK(power_state_of(0x0238) == PowerState::fault);
}

TEST_CASE("Each pattern of the state bits is the state of CiA 402 or none") {
  // Bits 6, 5, 3, 2, 1, 0; bit 5 = 0 and 1 where the standard leaves it open.
  const std::map<std::uint16_t, PowerState> states{
      {0b0'0000, PowerState::not_ready},
      {0b010'0000, PowerState::not_ready},
      {0b100'0000, PowerState::switch_on_disabled},
      {0b110'0000, PowerState::switch_on_disabled},
      {0b010'0001, PowerState::ready_to_switch_on},
      {0b010'0011, PowerState::switched_on},
      {0b010'0111, PowerState::operation_enabled},
      {0b000'0111, PowerState::quick_stop_active},
      {0b000'1111, PowerState::fault_reaction_active},
      {0b010'1111, PowerState::fault_reaction_active},
      {0b000'1000, PowerState::fault},
      {0b010'1000, PowerState::fault},
  };
  for (std::uint32_t word = 0; word <= 0xffff; ++word) {
    const auto found = states.find(static_cast<std::uint16_t>(word & 0b110'1111));
    const PowerState expected = found == states.end() ? PowerState::undefined : found->second;
    if (power_state_of(static_cast<std::uint16_t>(word)) != expected) FAIL("statusword " << word);
  }
}

TEST_CASE("The controlword of each state towards operation enabled") {
  CHECK(control_towards_operation(PowerState::not_ready, 0) == 0x0000);
  CHECK(control_towards_operation(PowerState::switch_on_disabled, 0) == 0x0006);
  CHECK(control_towards_operation(PowerState::ready_to_switch_on, 0x06) == 0x0007);
  CHECK(control_towards_operation(PowerState::switched_on, 0x07) == 0x000f);
  CHECK(control_towards_operation(PowerState::operation_enabled, 0x0f) == 0x000f);
  CHECK(control_towards_operation(PowerState::quick_stop_active, 0x02) == 0x0000);
  CHECK(control_towards_operation(PowerState::fault_reaction_active, 0x0f) == 0x0000);
  CHECK(control_towards_operation(PowerState::undefined, 0x0f) == 0x0000);
}

TEST_CASE("Fault reset is an edge, again and again until it is taken") {
  std::uint16_t control = kControlEnable;
  control = control_towards_operation(PowerState::fault, control);
  CHECK(control == 0x0080);  // bit 7 was 0 in what was sent last: this is the edge
  control = control_towards_operation(PowerState::fault, control);
  CHECK(control == 0x0000);
  control = control_towards_operation(PowerState::fault, control);
  CHECK(control == 0x0080);
  // after it the way leads on, bit 7 low again
  CHECK(control_towards_operation(PowerState::switch_on_disabled, control) == 0x0006);
}

TEST_CASE("From every state of the standard's drive to operation enabled") {
  std::uint16_t control = 0;
  RuleDrive drive;
  SECTION("from switch on disabled, by transitions 2, 3, 4") {
    CHECK(cycles_to_operation(drive, control) == 3);
  }
  SECTION("from ready to switch on, by 3, 4") {
    drive.state = PowerState::ready_to_switch_on;
    CHECK(cycles_to_operation(drive, control) == 2);
  }
  SECTION("from switched on, by 4") {
    drive.state = PowerState::switched_on;
    CHECK(cycles_to_operation(drive, control) == 1);
  }
  SECTION("from quick stop active, by 12, 2, 3, 4") {
    drive.state = PowerState::operation_enabled;
    drive.control(kControlQuickStop);
    REQUIRE(drive.state == PowerState::quick_stop_active);  // 11
    CHECK(cycles_to_operation(drive, control) == 4);
  }
  SECTION("from fault, by 15, 2, 3, 4") {
    drive.state = PowerState::fault;
    CHECK(cycles_to_operation(drive, control) == 4);
  }
  SECTION("from fault, the reset's bit being up already: one cycle more, for its edge") {
    drive.state = PowerState::fault;
    drive.control(kControlFaultReset);
    drive.state = PowerState::fault;  // the fault is still there
    control = kControlFaultReset;
    CHECK(cycles_to_operation(drive, control) == 5);
  }
}

TEST_CASE("The controlwords of the ways down do what they are named for") {
  RuleDrive drive;
  const auto after = [&](std::uint16_t word) {
    drive.state = PowerState::operation_enabled;
    drive.control(word);
    return drive.state;
  };
  CHECK(after(kControlShutdown) == PowerState::ready_to_switch_on);        // 8
  CHECK(after(kControlSwitchOn) == PowerState::switched_on);               // 5
  CHECK(after(kControlQuickStop) == PowerState::quick_stop_active);        // 11
  CHECK(after(kControlDisableVoltage) == PowerState::switch_on_disabled);  // 9
  CHECK(after(kControlEnable | kControlHalt) == PowerState::operation_enabled);
  CHECK(after(kControlEnable | kControlNewSetPoint | kControlChangeAtOnce) == PowerState::operation_enabled);
}

TEST_CASE("Modes of operation and the bits that say which a drive has") {
  // CiA 402-2, object 0x6502: bit 0 profile position, 2 profile velocity, 5 homing, 7 cyclic position, 8 cyclic
  // velocity.
  const std::pair<DriveMode, std::uint32_t> bits[] = {{DriveMode::profile_position, 0x001},
                                                      {DriveMode::profile_velocity, 0x004},
                                                      {DriveMode::homing, 0x020},
                                                      {DriveMode::cyclic_position, 0x080},
                                                      {DriveMode::cyclic_velocity, 0x100}};
  for (const auto& [mode, bit] : bits) {
    INFO(describe(mode));
    CHECK(is_supported(mode, bit));
    CHECK_FALSE(is_supported(mode, ~bit));
  }
  CHECK(is_position(DriveMode::profile_position));
  CHECK(is_position(DriveMode::cyclic_position));
  CHECK_FALSE(is_position(DriveMode::profile_velocity));
  CHECK_FALSE(is_position(DriveMode::cyclic_velocity));
  CHECK_FALSE(is_position(DriveMode::homing));
}

TEST_CASE("States and modes are put in words") {
  CHECK(describe(PowerState::switch_on_disabled) == "switch on disabled");
  CHECK(describe(PowerState::operation_enabled) == "operation enabled");
  CHECK(describe(PowerState::fault_reaction_active) == "fault reaction active");
  CHECK(describe(DriveMode::cyclic_velocity) == "cyclic velocity");
}
