#include "libkenaf_real/commissioning.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include "can/canbus/bus_layout.hpp"
#include "can/canopen/device.hpp"
#include "hrt/error.hpp"

namespace kenaf::real {
namespace {

using canbus::DriveOnBus;
using canbus::RobotBus;
using canopen::DriveMode;
using canopen::MappedObject;
using canopen::NodeId;
using canopen::ObjectType;
using canopen::Pdo;
using canopen::PdoDirection;
using canopen::SdoWrite;
using canopen::Time;
using hrt::Error;
namespace object = canopen::object;

constexpr Time kAskAgain = std::chrono::milliseconds(500);
constexpr int kLastPdo = 4;
constexpr std::int64_t kFaultReactionQuickStop = 2;  // CiA 402, 0x605E: slow down on the quick stop ramp

std::vector<NamedNode> nodes_of(const RobotBus& bus) {
  std::vector<NamedNode> nodes;
  for (std::size_t i = 0; i < bus.drives.size(); ++i) nodes.push_back(drive_node(bus, i));
  if (bus.inclinometer) nodes.push_back({bus.inclinometer->node, "inclinometer"});
  if (bus.gyro) nodes.push_back({bus.gyro->node, "gyro"});
  return nodes;
}

std::string names(const std::vector<NamedNode>& nodes) {
  std::string out;
  for (const NamedNode& node : nodes) out += (out.empty() ? "" : ", ") + to_string(node);
  return out;
}

// A heartbeat with the master's node id is rejected by every wait for frames (Master::receive).
void refuse_other_master(Master& master, const RobotBus& bus) {
  const Time until = master.now() + to_time(bus.master_silence_s);
  while (const auto received = master.receive(until)) {
    if (!is_sync(received->frame)) continue;
    throw Error(HRT_E_REFUSED, fmt::format("another program controls the robot: there is already a SYNC on {}; end "
                                           "that program first, or, if it is dead, a child process that it left behind",
                                           bus.interface));
  }
}

// Waits for boot-up messages.
void await_start(Master& master, std::vector<NamedNode>& missing, Time until) {
  while (!missing.empty()) {
    const auto received = master.receive(until);
    if (!received) break;
    const auto heartbeat = canopen::heartbeat_from(received->frame);
    if (!heartbeat || heartbeat->state != canopen::NmtState::boot_up) continue;
    std::erase_if(missing, [&](const NamedNode& node) { return node.node == heartbeat->node; });
  }
  if (master.was_interrupted()) throw Error(HRT_E_CLOSED, "hrt_close() was called while the robot was being set up");
}

// A bus that accepts no frame has no powered node yet: it is waited for like a node.
void reset_communication(Master& master, const RobotBus& bus, double patience_s) {
  // All nodes are missing until their boot-up message has come.
  std::vector<NamedNode> missing = nodes_of(bus);
  const Time until = master.now() + to_time(patience_s);
  Time ask_at = master.now();
  std::string bus_says;

  // Each missing node gets its own order, repeated every kAskAgain: a node powered late has missed the first ones.
  while (!missing.empty()) {
    try {
      if (master.now() >= ask_at) {
        ask_at = master.now() + kAskAgain;
        for (const NamedNode& node : missing)
          master.send(encode(canopen::NmtOrder{canopen::NmtCommand::reset_communication, node.node}));
        bus_says.clear();
      }
      await_start(master, missing, std::min(until, ask_at));
    } catch (const canopen::BusFull& error) {
      bus_says = fmt::format(" ({})", error.what());
    }

    // The bus's own report is part of the message: a missing acknowledgement usually means missing power.
    if (!missing.empty() && master.now() >= until) {
      throw Error(HRT_E_DEVICE, fmt::format("on {} these nodes did not start within {} s: {}{}; check their power, the "
                                            "bit rate and the node numbers in [can] of the robot's description",
                                            bus.interface, patience_s, names(missing), bus_says));
    }
  }
}

void check_profile(Master& master, const NamedNode& node, std::uint16_t profile, std::string_view what) {
  const std::int64_t type = master.read(node, object::device_type, "device type");
  const std::uint16_t its = canopen::profile_of(static_cast<std::uint32_t>(type));
  if (its != profile)
    throw Error(HRT_E_DEVICE, fmt::format("{} is not a {} (its device type is {:#010x}, of CiA {}, not {})",
                                          to_string(node), what, type, its, profile));
}

void check_modes(Master& master, const NamedNode& node, const DriveOnBus& drive) {
  const auto supported =
      static_cast<std::uint32_t>(master.read(node, object::supported_modes, "supported drive modes"));
  const auto check = [&](DriveMode mode) {
    if (!is_supported(mode, supported))
      throw Error(HRT_E_DEVICE,
                  fmt::format("{} cannot do {} (its object 0x6502 is {:#x}); `mode` in the robot's description",
                              to_string(node), describe(mode), supported));
  };
  check(drive.mode);
  if (drive.homing) check(DriveMode::homing);
}

SdoWrite make_write(const MappedObject& object, std::int64_t value, std::string purpose) {
  return {object.object, object.type, value, std::move(purpose)};
}

void write_heartbeat(Master& master, const NamedNode& node, const RobotBus& bus) {
  master.write(node,
               make_write(object::producer_heartbeat_ms, std::lround(1e3 * bus.node_heartbeat_s), "own heartbeat"));
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

// An object that CiA 402 leaves optional, and its key in [can].
std::string_view key_without(const Pdo& pdo) {
  for (const MappedObject& mapped : pdo.objects) {
    if (mapped.object == object::dc_link_voltage.object) return "battery";
    if (mapped.object == object::current_actual.object) return "currents";
  }
  return "";
}

void write_pdo(Master& master, const NamedNode& node, const Pdo& pdo, const std::vector<SdoWrite>& writes) try {
  for (const SdoWrite& write : writes) master.write(node, write);
} catch (const Error& error) {
  const std::string_view key = key_without(pdo);
  if (error.code() != HRT_E_DEVICE || key.empty()) throw;
  throw Error(error.code(),
              fmt::format("{}; where its drives have no such object: `{} = false` in [can]", error.what(), key));
}

// Switches off PDOs that the manufacturer may have enabled but nobody here uses: no unknown frames on the bus.
void write_pdos(Master& master, const NamedNode& node, const std::vector<Pdo>& used) {
  for (const PdoDirection direction : {PdoDirection::transmit, PdoDirection::receive}) {
    for (int number = 1; number <= kLastPdo; ++number) {
      const auto found = std::ranges::find_if(
          used, [&](const Pdo& pdo) { return pdo.direction == direction && pdo.number == number; });
      const Pdo pdo = found == used.end() ? Pdo{direction, static_cast<std::uint8_t>(number), 1, {}} : *found;
      const std::vector<SdoWrite> writes = configuration_of(pdo, node.node);
      if (found == used.end()) {
        master.write_if_there(node, writes.front());  // "made invalid"
      } else {
        write_pdo(master, node, pdo, writes);
      }
    }
  }
}

// Returns the rated current in A; nullopt if the drive does not report it or is not asked.
std::optional<double> set_up_drive(Master& master, const RobotBus& bus, std::size_t i, double period_s) {
  const NamedNode node = drive_node(bus, i);
  check_profile(master, node, canopen::kProfileDrive, "drive");
  check_modes(master, node, bus.drives[i]);
  for (const SdoWrite& write : parameters_of(bus, i, period_s)) master.write(node, write);
  // not every drive has these, and their default values are acceptable
  master.write_if_there(
      node, make_write(object::communication_error_behaviour, 1, "stay operational when the heartbeat is lost"));
  master.write_if_there(node, make_write(object::fault_reaction_option, kFaultReactionQuickStop, "fault reaction"));
  const canbus::DrivePdos pdos = canbus::pdos_of(bus, i);
  std::vector<Pdo> used{pdos.state, pdos.command};
  if (pdos.has_effort) used.push_back(pdos.effort);
  if (pdos.has_battery) used.push_back(pdos.battery);
  write_pdos(master, node, used);
  write_heartbeat(master, node, bus);
  const std::optional<std::int64_t> rated_ma =
      bus.has_currents ? master.read_if_there(node, object::rated_current) : std::nullopt;
  return rated_ma ? std::optional(1e-3 * static_cast<double>(*rated_ma)) : std::nullopt;
}

double set_up_inclinometer(Master& master, const RobotBus& bus) {
  const NamedNode node{bus.inclinometer->node, "inclinometer"};
  check_profile(master, node, canopen::kProfileInclinometer, "inclinometer");
  const std::int64_t millidegrees = master.read(node, object::slope_resolution, "resolution of its slopes");
  if (millidegrees != 1 && millidegrees != 10 && millidegrees != 100 && millidegrees != 1000)
    throw Error(HRT_E_DEVICE, fmt::format("{}: object 0x6000 (resolution) is {}, which CiA 410 does not define",
                                          to_string(node), millidegrees));
  write_pdos(master, node, {canbus::inclinometer_pdo()});
  write_heartbeat(master, node, bus);
  return 1e-3 * static_cast<double>(millidegrees) * std::numbers::pi / 180;
}

}  // namespace

NamedNode drive_node(const RobotBus& bus, std::size_t drive) {
  return {bus.drives[drive].node, bus.drives[drive].name};
}

std::vector<SdoWrite> parameters_of(const RobotBus& bus, std::size_t i, double period_s) {
  const DriveOnBus& drive = bus.drives[i];
  const canbus::DriveUnits& units = drive.units;
  const std::int64_t full_speed = std::abs(std::int64_t{velocity_to_drive(units, drive.max_speed)});
  const std::int64_t acceleration = acceleration_to_drive(units, drive.acceleration);
  const std::int64_t stop = acceleration_to_drive(units, drive.quick_stop_deceleration);
  std::vector<SdoWrite> writes{
      make_write(object::abort_connection_option, canopen::kAbortByQuickStop, "quick stop when the master is lost"),
      make_write(object::quick_stop_option, canopen::kQuickStopAndStay, "hold after a quick stop"),
      make_write(object::quick_stop_deceleration, stop, "quick stop deceleration"),
      make_write(object::max_profile_velocity, full_speed, "speed limit"),
      make_write(object::profile_acceleration, acceleration, "acceleration"),
      // motions ramp by themselves; a track commanded to stop in any other case must stop at once
      make_write(object::profile_deceleration, drive.is_flipper() ? acceleration : stop, "deceleration"),
  };
  if (is_position(drive.mode)) {
    const std::int32_t ends[] = {position_to_drive(units, drive.min_position),
                                 position_to_drive(units, drive.max_position)};
    writes.push_back(make_write(object::profile_velocity, full_speed, "speed"));
    writes.push_back(
        make_write(object::position_limit_min, std::min(ends[0], ends[1]), "lower end of the flipper's range"));
    writes.push_back(
        make_write(object::position_limit_max, std::max(ends[0], ends[1]), "upper end of the flipper's range"));
  }
  if (drive.mode == DriveMode::cyclic_position || drive.mode == DriveMode::cyclic_velocity) {
    const auto [number, exponent] = interpolation_time(period_s);
    writes.push_back(make_write(object::interpolation_period, number, "time between targets"));
    writes.push_back(make_write(object::interpolation_exponent, exponent, "time between targets, power of ten"));
  }
  writes.push_back(make_write(object::mode, static_cast<std::int64_t>(drive.mode), "mode of operation"));
  return writes;
}

NodeFacts commission(Master& master, const RobotBus& bus, double period_s, double patience_s) {
  refuse_other_master(master, bus);
  master.start_heartbeat();  // from here on, so that nodes watching for it while starting see a master
  reset_communication(master, bus, patience_s);
  NodeFacts facts;
  for (std::size_t i = 0; i < bus.drives.size(); ++i) {
    const std::optional<double> rated_a = set_up_drive(master, bus, i, period_s);
    facts.rated_current_a.push_back(rated_a.value_or(0));
    facts.has_currents = facts.has_currents && rated_a;
    facts.watches.push_back(find_watches(master, bus, i));
  }
  if (bus.inclinometer) facts.slope_unit_rad = set_up_inclinometer(master, bus);
  for (const NamedNode& node : nodes_of(bus))
    master.send(encode(canopen::NmtOrder{canopen::NmtCommand::start, node.node}));
  return facts;
}

}  // namespace kenaf::real
