#include "libkenaf_real/drive_watches.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "can/canbus/bus_layout.hpp"
#include "can/canbus/node_setup.hpp"
#include "hrt/error.hpp"
#include "hrt/warnings.hpp"
#include "libkenaf_real/commissioning.hpp"

namespace kenaf::real {
namespace {

using canbus::RobotBus;
using canopen::ObjectType;
using canopen::Pdo;
using canopen::SdoWrite;
using hrt::Error;

constexpr double kCommandsOfGap = 3;

std::optional<std::int64_t> read_event_timer(Master& master, const NamedNode& node, const Pdo& command) {
  const SdoWrite timer = canbus::read_of_event_timer(command).what;
  return master.read_if_there(node, {timer.object, timer.type});
}

// "0x1400:05", of the RPDO that has the drive's command.
std::string event_timer_in_words(const RobotBus& bus, std::size_t drive) {
  return fmt::format("0x{:X}:05", 0x1400 + canbus::pdos_of(bus, drive).command.number - 1);
}

// Returns whether the timer then has the value. Some drives change it only while the PDO is invalid.
bool write_event_timer(Master& master, const NamedNode& node, const Pdo& command, std::int64_t ms) {
  const auto is_written = [&] {
    try {
      master.write(node, canbus::write_of_event_timer(command, ms).what);
      return read_event_timer(master, node, command) == ms;
    } catch (const Error& error) {
      if (error.code() != HRT_E_DEVICE) throw;
      return false;
    }
  };
  if (is_written()) return true;
  const canopen::ObjectAddress id{static_cast<std::uint16_t>(0x1400 + command.number - 1), 1};
  const std::uint32_t valid = cob_id(command, node.node);
  const auto switch_to = [&](std::uint32_t value, const char* purpose) {
    master.write(node, {id, ObjectType::unsigned32, value, purpose});
  };
  switch_to(valid | canopen::kPdoInvalid, "switching the command's PDO off");
  const bool written = is_written();
  switch_to(valid, "switching the command's PDO on");
  return written;
}

// "its master's heartbeat (0x1016, 0.1 s) and its commands (0x1400:05, 0.1 s)"
std::string in_words(const DriveWatches& watches, const RobotBus& bus, std::size_t drive, double period_s) {
  const bool guarded = bus.drives[drive].device.error_control == canbus::ErrorControl::node_guarding;
  const std::string master = fmt::format("its master's {} ({}, {:.3g} s)", guarded ? "requests" : "heartbeat",
                                         guarded ? "0x100D" : "0x1016", bus.master_silence_s),
                    commands = fmt::format("its commands ({}, {:.3g} s)", event_timer_in_words(bus, drive),
                                           longest_command_gap_s(bus, drive, period_s));
  if (watches.heartbeat && watches.event_timer) return master + " and " + commands;
  return (watches.heartbeat ? master : commands) + " alone";
}

}  // namespace

double longest_command_gap_s(const RobotBus& bus, std::size_t drive, double period_s) {
  return std::max(bus.master_silence_s, kCommandsOfGap * bus.drives[drive].device.command_every * period_s);
}

DriveWatches find_watches(Master& master, const RobotBus& bus, std::size_t drive, double period_s) {
  const NamedNode node = drive_node(bus, drive);
  const std::string timer = event_timer_in_words(bus, drive);
  DriveWatches watches;
  const std::optional<canbus::SdoStep> watch = canbus::begin_of_watch(bus, bus.drives[drive].device);
  watches.heartbeat = !watch || master.write_if_there(node, watch->what);
  if (bus.event_timer != false) {
    const Pdo command = canbus::pdos_of(bus, drive).command;
    const std::optional<std::int64_t> ms = read_event_timer(master, node, command);
    watches.event_timer = ms.has_value();
    // a time that the maker or a user has stored would end the set-up
    if (ms && *ms != 0) master.write(node, canbus::write_of_event_timer(command, 0).what);
  }
  if (bus.event_timer == true && !watches.event_timer)
    throw Error(HRT_E_DEVICE, fmt::format("{} has no event timer of its commands (object {}), which `event_timer = "
                                          "true` in [can] requires",
                                          to_string(node), timer));
  if (!watches.heartbeat && !watches.event_timer)
    throw Error(
        HRT_E_DEVICE,
        fmt::format("{} watches neither its master's heartbeat (object 0x1016) nor its commands ({}{}): nothing "
                    "would stop it if this program ended; it cannot be used{}",
                    to_string(node), timer, bus.event_timer == false ? ", `event_timer = false` in [can]" : "",
                    canbus::advice(bus.drives[drive].device, "error_control = \"node guarding\"")));

  // A track's drive that takes few commands may wait for them longer than the description's check of the stop has
  // counted.
  const double gap_s = longest_command_gap_s(bus, drive, period_s), stop_s = longest_stop_s(bus, gap_s);
  if (!watches.heartbeat && !bus.drives[drive].is_flipper() && stop_s > bus.stop_within_s)
    throw Error(HRT_E_DEVICE,
                fmt::format("{} watches its commands alone ({}), and three of them take {:.3g} s: the robot would rest "
                            "{:.3f} s after this program ended, and must within {} s (can.stop_within_s)",
                            to_string(node), timer, gap_s, stop_s, bus.stop_within_s));
  return watches;
}

void begin_event_timers(BusCycle& cycle, AllWatches& watches, double period_s) {
  for (std::size_t i = 0; i < watches.size(); ++i) {
    if (!watches[i].event_timer) continue;
    const double gap_s = longest_command_gap_s(cycle.bus(), i, period_s);
    const auto gap_ms = static_cast<std::int64_t>(std::ceil(1e3 * gap_s - 1e-6));
    const NamedNode node = drive_node(cycle.bus(), i);
    watches[i].event_timer = write_event_timer(cycle.master(), node, canbus::pdos_of(cycle.bus(), i).command, gap_ms);
    if (!watches[i].event_timer && (!watches[i].heartbeat || cycle.bus().event_timer == true))
      throw Error(HRT_E_DEVICE, fmt::format("{} does not accept {} ms as the event timer of its commands ({})",
                                            to_string(node), gap_ms, event_timer_in_words(cycle.bus(), i)));
    if (!cycle.wait()) throw Error(HRT_E_CLOSED, "hrt_close() was called while the robot was being set up");
    cycle.send(cycle.sent());
  }
}

void end_watches(BusCycle& cycle, const std::vector<std::size_t>& drives, const DriveOrders& meanwhile) {
  const RobotBus& bus = cycle.bus();
  const auto end = [&](std::size_t drive, const canbus::SdoStep& step) {
    try {
      cycle.master().write_if_there(drive_node(bus, drive), step.what);
    } catch (const Error&) {
      // at rest all the same
    }
  };
  std::vector<std::size_t> flippers_first = drives;
  std::stable_partition(flippers_first.begin(), flippers_first.end(),
                        [&](std::size_t drive) { return bus.drives[drive].is_flipper(); });
  if (bus.event_timer != false) {
    for (const std::size_t drive : flippers_first) {
      end(drive, canbus::write_of_event_timer(canbus::pdos_of(bus, drive).command, 0));
      cycle.wait();
      cycle.send(meanwhile);
    }
  }
  // No commands are needed any more, and the heartbeat goes on meanwhile.
  for (const std::size_t drive : flippers_first) end(drive, canbus::end_of_watch(bus.drives[drive].device));
  cycle.wait();
}

std::string describe_watches(const RobotBus& bus, const AllWatches& watches, double period_s) {
  std::string text;
  for (std::size_t i = 0; i < watches.size(); ++i)
    text += fmt::format("{}{} watches {}", i == 0 ? "" : "\n", to_string(drive_node(bus, i)),
                        in_words(watches[i], bus, i, period_s));
  return text;
}

std::string warning_of_watches(const RobotBus& bus, const AllWatches& watches) {
  std::string no_heartbeat, no_timer, timers;
  for (std::size_t i = 0; i < watches.size(); ++i) {
    const std::string name = to_string(drive_node(bus, i));
    if (!watches[i].heartbeat) no_heartbeat += (no_heartbeat.empty() ? "" : ", ") + name;
    if (watches[i].event_timer || bus.event_timer == false) continue;
    no_timer += (no_timer.empty() ? "" : ", ") + name;
    const std::string timer = event_timer_in_words(bus, i);
    if (timers.find(timer) == std::string::npos) timers += (timers.empty() ? "" : ", ") + timer;
  }
  std::string text;
  if (!no_heartbeat.empty())
    text = fmt::format("no watch of the master's heartbeat (0x1016), only of commands: {}", no_heartbeat);
  if (!no_timer.empty())
    text = hrt::joined(text, fmt::format("no watch of commands ({}), only of the master's heartbeat: {}; if that "
                                         "is known: `event_timer = false` in [can]",
                                         timers, no_timer));
  return text;
}

}  // namespace kenaf::real
