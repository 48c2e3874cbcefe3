#include "can/canbus/node_setup.hpp"

#include <algorithm>
#include <cmath>

#include "can/canbus/bus_layout.hpp"
#include "can/canopen/device.hpp"
#include "can/canopen/drive.hpp"

namespace kenaf::canbus {
namespace {

using canopen::DriveMode;
using canopen::MappedObject;
using canopen::Pdo;
using canopen::PdoDirection;
using Kind = SdoStep::Kind;
namespace object = canopen::object;

constexpr int kLastPdo = 4;
// Of canopen::configuration_of: "switching TPDO4 off", "emptying the mapping of TPDO4".
constexpr std::size_t kSwitchedOffAt = 0, kEmptiedAt = 2;
constexpr std::int64_t kFaultReactionQuickStop = 2;  // CiA 402, 0x605E: slow down on the quick stop ramp
constexpr std::int64_t kStayOperational = 1;         // CiA 301, 0x1029: no change of the NMT state

SdoStep write_step(const MappedObject& at, std::int64_t value, std::string purpose) {
  return {{at.object, at.type, value, std::move(purpose)}, Kind::write, false};
}

SdoStep read_step(const MappedObject& at, std::string purpose) {
  return {{at.object, at.type, 0, std::move(purpose)}, Kind::read, false};
}

SdoStep optional_step(SdoStep step) {
  step.optional = true;
  return step;
}

// CiA 301, 7.5.2.35.
MappedObject event_timer_of(const Pdo& command) {
  return {{static_cast<std::uint16_t>(0x1400 + command.number - 1), 5}, canopen::ObjectType::unsigned16};
}

// CiA 402, 0x60C2: a time as number * 10^exponent s, with an 8-bit number. In milliseconds if it is a whole number of
// them, since many drives accept only the default exponent -3; otherwise the finest exponent that fits.
struct InterpolationTime {
  std::int64_t number;
  int exponent;
};
InterpolationTime interpolation_time(double period_s) {
  const double milliseconds = 1e3 * period_s, whole = std::round(milliseconds);
  if (whole >= 1 && whole <= 255 && std::abs(milliseconds - whole) < 1e-6) return {std::lround(whole), -3};
  int exponent = -6;
  while (period_s / std::pow(10.0, exponent) > 255) ++exponent;
  return {std::lround(period_s / std::pow(10.0, exponent)), exponent};
}

void add_parameters(const RobotBus& bus, std::size_t i, double period_s, std::vector<SdoStep>& steps) {
  const DriveOnBus& drive = bus.drives[i];
  const DriveUnits& units = drive.units;
  const std::int64_t full_speed = std::abs(std::int64_t{velocity_to_drive(units, drive.max_speed)});
  const std::int64_t acceleration = acceleration_to_drive(units, drive.acceleration);
  const std::int64_t stop = acceleration_to_drive(units, drive.quick_stop_deceleration);
  const auto write = [&](const MappedObject& at, std::int64_t value, const char* purpose) {
    steps.push_back(write_step(at, value, purpose));
  };
  write(object::abort_connection_option, canopen::kAbortByQuickStop, "quick stop when the master is lost");
  write(object::quick_stop_option, canopen::kQuickStopAndStay, "hold after a quick stop");
  write(object::quick_stop_deceleration, stop, "quick stop deceleration");
  write(object::max_profile_velocity, full_speed, "speed limit");
  write(object::profile_acceleration, acceleration, "acceleration");
  // motions ramp by themselves; a track commanded to stop in any other case must stop at once
  write(object::profile_deceleration, drive.is_flipper() ? acceleration : stop, "deceleration");
  if (is_position(drive.mode)) {
    const std::int32_t ends[] = {position_to_drive(units, drive.min_position),
                                 position_to_drive(units, drive.max_position)};
    write(object::profile_velocity, full_speed, "speed");
    write(object::position_limit_min, std::min(ends[0], ends[1]), "lower end of the flipper's range");
    write(object::position_limit_max, std::max(ends[0], ends[1]), "upper end of the flipper's range");
  } else if (drive.device.zero_target_by_sdo) {
    write(object::target_velocity, 0, "target velocity before the drive is enabled");
  }
  if (drive.mode == DriveMode::cyclic_position || drive.mode == DriveMode::cyclic_velocity) {
    const auto [number, exponent] = interpolation_time(drive.device.command_every * period_s);
    write(object::interpolation_period, number, "time between targets");
    write(object::interpolation_exponent, exponent, "time between targets, power of ten");
  }
  if (!drive.device.halt_blocks_mode) steps.push_back(write_of_mode(first_mode(drive)));
  // not every drive has these, and their default values are acceptable
  steps.push_back(optional_step(write_step(object::communication_error_behaviour, kStayOperational,
                                           "stay operational when the heartbeat is lost")));
  steps.push_back(optional_step(write_step(object::fault_reaction_option, kFaultReactionQuickStop, "fault reaction")));
}

bool is_mapping(canopen::ObjectAddress at) {
  return (at.index >= 0x1600 && at.index < 0x1800) || (at.index >= 0x1a00 && at.index < 0x1c00);
}

// A mapping that cannot be written must be what it is to be.
void add_fixed_pdo(const Pdo& pdo, canopen::NodeId node, std::vector<SdoStep>& steps) {
  for (canopen::SdoWrite& write : configuration_of(pdo, node)) {
    if (!is_mapping(write.object)) {
      steps.push_back({std::move(write), Kind::write, false});
    } else if (write.object.sub > 0) {
      steps.push_back({std::move(write), Kind::expect, false});
    } else if (write.value > 0) {
      write.purpose = "how many objects are mapped";
      steps.push_back({std::move(write), Kind::expect, false});
    }
  }
}

void add_pdo(const Pdo& pdo, canopen::NodeId node, const Device& device, std::vector<SdoStep>& steps) {
  if (device.mapping == Mapping::cia402) return add_fixed_pdo(pdo, node, steps);
  std::vector<canopen::SdoWrite> writes = configuration_of(pdo, node);
  if (device.mapping_count_first) {
    std::rotate(writes.begin(), writes.begin() + kEmptiedAt, writes.begin() + kEmptiedAt + 1);
  }
  for (canopen::SdoWrite& write : writes) steps.push_back({std::move(write), Kind::write, false});
}

// Switches off PDOs that the manufacturer may have enabled but nobody here uses: no unknown frames on the bus.
void add_pdos(const std::vector<Pdo>& used, canopen::NodeId node, const Device& device, std::vector<SdoStep>& steps) {
  for (const PdoDirection direction : {PdoDirection::transmit, PdoDirection::receive}) {
    for (int number = 1; number <= kLastPdo; ++number) {
      const auto found = std::ranges::find_if(
          used, [&](const Pdo& pdo) { return pdo.direction == direction && pdo.number == number; });
      if (found != used.end()) {
        add_pdo(*found, node, device, steps);
      } else {
        const Pdo unused{direction, static_cast<std::uint8_t>(number), 1, {}};
        std::vector<canopen::SdoWrite> writes = configuration_of(unused, node);
        if (device.mapping_count_first) steps.push_back({writes[kEmptiedAt], Kind::write, true});
        steps.push_back({writes[kSwitchedOffAt], Kind::write, true});
      }
    }
  }
}

void add_heartbeats(const RobotBus& bus, const Device& device, std::vector<SdoStep>& steps) {
  if (device.error_control == ErrorControl::node_guarding) {
    steps.push_back(write_step(object::guard_time_ms, std::lround(1e3 * bus.master_heartbeat_s),
                               "time between the master's requests, node guarding"));
    steps.push_back(write_step(object::life_time_factor, life_time_factor(bus),
                               "requests that may be missing, whose loss stops the drive"));
    return;
  }
  steps.push_back(write_step(object::producer_heartbeat_ms, std::lround(1e3 * bus.node_heartbeat_s), "own heartbeat"));
}

}  // namespace

SdoStep write_of_mode(DriveMode mode) {
  return write_step(object::mode, static_cast<std::int64_t>(mode), "mode of operation");
}

SdoStep read_of_mode() {
  return read_step(object::mode_display, "mode in force");
}

SdoStep read_of_target_velocity() {
  return optional_step(read_step(object::target_velocity, "target velocity before the drive is enabled"));
}

std::optional<SdoStep> begin_of_watch(const RobotBus& bus, const Device& device) {
  if (device.error_control == ErrorControl::node_guarding) return std::nullopt;
  const auto silence_ms = static_cast<std::uint16_t>(std::lround(1e3 * bus.master_silence_s));
  return optional_step(write_step(object::consumer_heartbeat_1, canopen::consumer_heartbeat(bus.master, silence_ms),
                                  "master's heartbeat, whose loss stops the drive"));
}

SdoStep end_of_watch(const Device& device) {
  const bool guarded = device.error_control == ErrorControl::node_guarding;
  return optional_step(write_step(guarded ? object::life_time_factor : object::consumer_heartbeat_1, 0,
                                  "end of the watch for the master"));
}

SdoStep read_of_event_timer(const Pdo& command) {
  return optional_step(read_step(event_timer_of(command), "longest time without a command"));
}

SdoStep write_of_event_timer(const Pdo& command, std::int64_t ms) {
  return optional_step(write_step(event_timer_of(command), ms, "longest time without a command"));
}

std::vector<SdoStep> set_up_of_drive(const RobotBus& bus, std::size_t i, double period_s) {
  const DriveOnBus& drive = bus.drives[i];
  std::vector<SdoStep> steps{read_step(object::device_type, "device type"),
                             read_step(object::supported_modes, "supported drive modes")};
  add_parameters(bus, i, period_s, steps);
  const DrivePdos pdos = pdos_of(bus, i);
  std::vector<Pdo> used{pdos.state, pdos.command};
  if (pdos.has_effort) used.push_back(pdos.effort);
  if (pdos.has_battery) used.push_back(pdos.battery);
  add_pdos(used, drive.node, drive.device, steps);
  add_heartbeats(bus, drive.device, steps);
  if (bus.has_currents) steps.push_back(optional_step(read_step(object::rated_current, "unit of the current")));
  return steps;
}

std::vector<SdoStep> set_up_of_inclinometer(const RobotBus& bus) {
  std::vector<SdoStep> steps{read_step(object::device_type, "device type"),
                             read_step(object::slope_resolution, "resolution of its slopes")};
  add_pdos({inclinometer_pdo()}, bus.inclinometer->node, {}, steps);
  add_heartbeats(bus, {}, steps);
  return steps;
}

SdoStep write_of_slope_resolution() {
  return write_step(object::slope_resolution, kSlopeInHundredths, "slopes in hundredths of a degree");
}

std::vector<SdoStep> homing_of_drive(const DriveOnBus& drive) {
  const Homing& homing = *drive.homing;
  const std::int64_t speed = std::abs(std::int64_t{velocity_to_drive(drive.units, homing.speed_radps)});
  return {write_step(object::homing_method, homing.method, "homing method"),
          write_step(object::home_offset,
                     std::int64_t{homing.offset_direction} * position_to_drive(drive.units, homing.home_rad),
                     "position at home"),
          write_step(object::homing_speed_switch, speed, "homing speed"),
          write_step(object::homing_speed_zero, speed, "homing speed"),
          write_step(object::homing_acceleration, acceleration_to_drive(drive.units, homing.acceleration_radps2),
                     "homing acceleration")};
}

std::vector<SdoStep> all_steps_of_drive(const RobotBus& bus, std::size_t i, double period_s) {
  const DriveOnBus& drive = bus.drives[i];
  std::vector<SdoStep> steps = set_up_of_drive(bus, i, period_s);
  if (drive.homing) {
    std::ranges::move(homing_of_drive(drive), std::back_inserter(steps));
    steps.push_back(write_of_mode(DriveMode::homing));
  }
  steps.push_back(write_of_mode(drive.mode));
  steps.push_back(read_of_mode());
  if (!is_position(drive.mode)) steps.push_back(read_of_target_velocity());
  if (std::optional<SdoStep> watch = begin_of_watch(bus, drive.device)) steps.push_back(std::move(*watch));
  if (bus.event_timer != false) {
    const Pdo command = pdos_of(bus, i).command;
    steps.push_back(read_of_event_timer(command));
    steps.push_back(write_of_event_timer(command, 0));
  }
  steps.push_back(end_of_watch(drive.device));
  return steps;
}

}  // namespace kenaf::canbus
