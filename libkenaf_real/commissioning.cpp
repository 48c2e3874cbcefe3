#include "libkenaf_real/commissioning.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <numbers>
#include <vector>

#include "can/canbus/node_setup.hpp"
#include "can/canopen/device.hpp"
#include "hrt/error.hpp"
#include "libkenaf_real/advice.hpp"

namespace kenaf::real {
namespace {

using canbus::DriveOnBus;
using canbus::RobotBus;
using canbus::SdoStep;
using canopen::DriveMode;
using canopen::MappedObject;
using canopen::NodeId;
using canopen::Time;
using hrt::Error;
namespace object = canopen::object;

constexpr Time kAskAgain = std::chrono::milliseconds(500);

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

// The longest time that a drive takes from a reset to its boot-up message.
double boot_s(const RobotBus& bus) {
  double longest_s = 0;
  for (const DriveOnBus& drive : bus.drives) longest_s = std::max(longest_s, drive.device.boot_s);
  return longest_s;
}

// A bus that accepts no frame has no powered node yet: it is waited for like a node.
void reset_communication(Master& master, const RobotBus& bus, double can_timeout_s) {
  // All nodes are missing until their boot-up message has come.
  std::vector<NamedNode> missing = nodes_of(bus);
  const double patience_s = can_timeout_s + boot_s(bus);
  const Time until = master.now() + to_time(patience_s), ask_again = kAskAgain + to_time(boot_s(bus));
  Time ask_at = master.now();
  std::string bus_says;

  // Each missing node gets its own order, repeated: a node powered late has missed the first ones. A node that boots is
  // not asked meanwhile: it might begin anew.
  while (!missing.empty()) {
    try {
      if (master.now() >= ask_at) {
        ask_at = master.now() + ask_again;
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
      throw Error(HRT_E_DEVICE,
                  fmt::format("on {} these nodes did not start within {} s: {}{}; check their power, the "
                              "bit rate and the node numbers in [can] of the robot's description{}",
                              bus.interface, patience_s, names(missing), bus_says, advice_on_boot(bus, missing)));
    }
  }
}

// What a node reads as must be what is expected of it.
void check_profile(const NamedNode& node, std::int64_t type, std::uint16_t profile, std::string_view what) {
  const std::uint16_t its = canopen::profile_of(static_cast<std::uint32_t>(type));
  if (its != profile)
    throw Error(HRT_E_DEVICE, fmt::format("{} is not a {} (its device type is {:#010x}, of CiA {}, not {})",
                                          to_string(node), what, type, its, profile));
}

void check_modes(const NamedNode& node, const DriveOnBus& drive, std::uint32_t supported) {
  const auto check = [&](DriveMode mode) {
    if (!is_supported(mode, supported))
      throw Error(HRT_E_DEVICE,
                  fmt::format("{} cannot do {} (its object 0x6502 is {:#x}); `mode` in the robot's description",
                              to_string(node), describe(mode), supported));
  };
  check(drive.mode);
  if (drive.homing) check(DriveMode::homing);
}

// Carries out the steps; `on_read` gets each object that is read, before the next step.
void carry_out(Master& master, const NamedNode& node, const std::vector<SdoStep>& steps,
               const std::function<void(canopen::ObjectAddress, std::int64_t)>& on_read) {
  for (const SdoStep& step : steps) {
    const canopen::SdoWrite& what = step.what;
    const MappedObject object{what.object, what.type};
    if (step.kind == SdoStep::Kind::write) {
      if (step.optional)
        master.write_if_there(node, what);
      else
        master.write(node, what);
      continue;
    }
    const std::optional<std::int64_t> value =
        step.optional ? master.read_if_there(node, object) : std::optional(master.read(node, object, what.purpose));
    if (step.kind == SdoStep::Kind::expect && value != what.value)
      throw Error(HRT_E_DEVICE, fmt::format("{}: object {} ({}) is {:#x}, not {:#x}, so its fixed mapping is not the "
                                            "default one of CiA 402, of which `mapping` in its device file speaks",
                                            to_string(node), to_string(what.object), what.purpose, *value, what.value));
    if (value) on_read(what.object, *value);
  }
}

// Returns the rated current in A; nullopt if the drive does not report it or is not asked.
std::optional<double> set_up_drive(Master& master, const RobotBus& bus, std::size_t i, double period_s) {
  const NamedNode node = drive_node(bus, i);
  const DriveOnBus& drive = bus.drives[i];
  std::optional<double> rated_a;
  try {
    carry_out(master, node, canbus::set_up_of_drive(bus, i, period_s),
              [&](canopen::ObjectAddress object, std::int64_t value) {
                if (object == object::device_type.object)
                  check_profile(node, value, canopen::kProfileDrive, "drive");
                else if (object == object::supported_modes.object)
                  check_modes(node, drive, static_cast<std::uint32_t>(value));
                else if (object == object::rated_current.object)
                  rated_a = 1e-3 * static_cast<double>(value);
              });
  } catch (const SdoRefused& refused) {
    throw Error(HRT_E_DEVICE, refused.what() + advice_on_refusal(drive.device, refused));
  }
  if (drive.device.error_control == canbus::ErrorControl::node_guarding) master.guard(drive.node);
  return rated_a;
}

// Returns the unit that is then in force, in thousandths of a degree.
std::int64_t coarser_slopes(Master& master, const NamedNode& node) {
  const canopen::SdoWrite write = canbus::write_of_slope_resolution().what;
  const auto fail = [&](const std::string& why) {
    throw Error(HRT_E_DEVICE,
                fmt::format("{}: its slopes are in thousandths of a degree (object 0x6000 = 1), so that those beyond "
                            "32.767 degrees would be wrong, and {}; set it to 10 with its maker's tool",
                            to_string(node), why));
  };
  try {
    master.write(node, write);
  } catch (const SdoRefused& refused) {
    fail(fmt::format("it does not take hundredths ({})", describe(refused.abort)));
  }
  const std::int64_t in_force = master.read(node, {write.object, write.type}, write.purpose);
  if (in_force == canbus::kTooFineSlope) fail("it keeps that though hundredths were written");
  return in_force;
}

double set_up_inclinometer(Master& master, const RobotBus& bus) {
  const NamedNode node{bus.inclinometer->node, "inclinometer"};
  double unit_rad = 0;
  carry_out(master, node, canbus::set_up_of_inclinometer(bus), [&](canopen::ObjectAddress object, std::int64_t value) {
    if (object == object::device_type.object)
      return check_profile(node, value, canopen::kProfileInclinometer, "inclinometer");
    if (object != object::slope_resolution.object) return;
    if (value == canbus::kTooFineSlope) value = coarser_slopes(master, node);
    if (value != 1 && value != 10 && value != 100 && value != 1000)
      throw Error(HRT_E_DEVICE, fmt::format("{}: object 0x6000 (resolution) is {}, which CiA 410 does not define",
                                            to_string(node), value));
    unit_rad = 1e-3 * static_cast<double>(value) * std::numbers::pi / 180;
  });
  return unit_rad;
}

}  // namespace

NamedNode drive_node(const RobotBus& bus, std::size_t drive) {
  return {bus.drives[drive].node, bus.drives[drive].name};
}

NodeFacts commission(Master& master, const RobotBus& bus, double period_s, double can_timeout_s) {
  refuse_other_master(master, bus);
  master.start_heartbeat();  // from here on, so that nodes watching for it while starting see a master
  reset_communication(master, bus, can_timeout_s);
  NodeFacts facts;
  for (std::size_t i = 0; i < bus.drives.size(); ++i) {
    const std::optional<double> rated_a = set_up_drive(master, bus, i, period_s);
    facts.rated_current_a.push_back(rated_a.value_or(0));
    facts.has_currents = facts.has_currents && rated_a;
    facts.watches.push_back(find_watches(master, bus, i, period_s));
  }
  if (bus.inclinometer) facts.slope_unit_rad = set_up_inclinometer(master, bus);
  for (const NamedNode& node : nodes_of(bus))
    master.send(encode(canopen::NmtOrder{canopen::NmtCommand::start, node.node}));
  return facts;
}

}  // namespace kenaf::real
