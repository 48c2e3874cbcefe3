#include "libkenaf_real/drive_watches.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "can/canbus/bus_layout.hpp"
#include "can/canopen/device.hpp"
#include "hrt/error.hpp"
#include "libkenaf_real/commissioning.hpp"

namespace kenaf::real {
namespace {

using canbus::RobotBus;
using canopen::MappedObject;
using canopen::ObjectType;
using canopen::Pdo;
using canopen::SdoWrite;
using hrt::Error;
namespace object = canopen::object;

constexpr double kCyclesOfGap = 3;

MappedObject communication_object(const Pdo& command, std::uint8_t sub, ObjectType type) {
  return {{static_cast<std::uint16_t>(0x1400 + command.number - 1), sub}, type};
}
MappedObject event_timer_of(const Pdo& command) {
  return communication_object(command, 5, ObjectType::unsigned16);
}

SdoWrite watch_write(const MappedObject& object, std::int64_t value, std::string purpose) {
  return {object.object, object.type, value, std::move(purpose)};
}

// Returns whether the timer then has the value. Some drives change it only while the PDO is invalid.
bool write_event_timer(Master& master, const NamedNode& node, const Pdo& command, std::int64_t ms) {
  const SdoWrite timer = watch_write(event_timer_of(command), ms, "longest time without a command");
  const auto is_written = [&] {
    try {
      master.write(node, timer);
      return master.read(node, event_timer_of(command), timer.purpose) == ms;
    } catch (const Error& error) {
      if (error.code() != HRT_E_DEVICE) throw;
      return false;
    }
  };
  if (is_written()) return true;
  const MappedObject id = communication_object(command, 1, ObjectType::unsigned32);
  const std::uint32_t valid = cob_id(command, node.node);
  master.write(node, watch_write(id, valid | canopen::kPdoInvalid, "switching RPDO1 off"));
  const bool written = is_written();
  master.write(node, watch_write(id, valid, "switching RPDO1 on"));
  return written;
}

std::string in_words(const DriveWatches& watches, double heartbeat_s, double gap_s) {
  const std::string heartbeat = fmt::format("its master's heartbeat (0x1016, {:.3g} s)", heartbeat_s),
                    timer = fmt::format("its commands (0x1400:05, {:.3g} s)", gap_s);
  if (watches.heartbeat && watches.event_timer) return heartbeat + " and " + timer;
  return (watches.heartbeat ? heartbeat : timer) + " alone";
}

}  // namespace

double longest_command_gap_s(const RobotBus& bus, double period_s) {
  return std::max(bus.master_silence_s, kCyclesOfGap * period_s);
}

DriveWatches find_watches(Master& master, const RobotBus& bus, std::size_t drive) {
  const NamedNode node = drive_node(bus, drive);
  const auto silence_ms = static_cast<std::uint16_t>(std::lround(1e3 * bus.master_silence_s));
  DriveWatches watches;
  watches.heartbeat = master.write_if_there(
      node, watch_write(object::consumer_heartbeat_1, canopen::consumer_heartbeat(bus.master, silence_ms),
                        "master's heartbeat, whose loss stops the drive"));
  if (bus.event_timer != false) {
    const MappedObject timer = event_timer_of(canbus::pdos_of(bus, drive).command);
    const std::optional<std::int64_t> ms = master.read_if_there(node, timer);
    watches.event_timer = ms.has_value();
    // a time that the maker or a user has stored would end the set-up
    if (ms && *ms != 0) master.write(node, watch_write(timer, 0, "event timer, off during the set-up"));
  }
  if (bus.event_timer == true && !watches.event_timer)
    throw Error(HRT_E_DEVICE,
                fmt::format("{} has no event timer of its commands (object 0x1400:05), which `event_timer = "
                            "true` in [can] requires",
                            to_string(node)));
  if (!watches.heartbeat && !watches.event_timer)
    throw Error(HRT_E_DEVICE,
                fmt::format("{} watches neither its master's heartbeat (object 0x1016) nor its commands (0x1400:05): "
                            "nothing would stop it if this program ended; it cannot be used",
                            to_string(node)));
  return watches;
}

void begin_event_timers(BusCycle& cycle, AllWatches& watches, double period_s) {
  const auto gap_ms = static_cast<std::int64_t>(std::ceil(1e3 * longest_command_gap_s(cycle.bus(), period_s) - 1e-6));
  for (std::size_t i = 0; i < watches.size(); ++i) {
    if (!watches[i].event_timer) continue;
    const NamedNode node = drive_node(cycle.bus(), i);
    watches[i].event_timer = write_event_timer(cycle.master(), node, canbus::pdos_of(cycle.bus(), i).command, gap_ms);
    if (!watches[i].event_timer && (!watches[i].heartbeat || cycle.bus().event_timer == true))
      throw Error(HRT_E_DEVICE, fmt::format("{} does not accept {} ms as the event timer of its commands (0x1400:05)",
                                            to_string(node), gap_ms));
    if (!cycle.wait()) throw Error(HRT_E_CLOSED, "hrt_close() was called while the robot was being set up");
    cycle.send(cycle.sent());
  }
}

void end_watches(BusCycle& cycle, std::size_t drive) {
  const NamedNode node = drive_node(cycle.bus(), drive);
  for (const MappedObject& watch :
       {event_timer_of(canbus::pdos_of(cycle.bus(), drive).command), object::consumer_heartbeat_1}) {
    try {
      cycle.master().write_if_there(node, watch_write(watch, 0, "end of the watch for the master"));
    } catch (const Error&) {
      // at rest all the same
    }
  }
}

std::string describe_watches(const RobotBus& bus, const AllWatches& watches, double period_s) {
  std::string text;
  for (std::size_t i = 0; i < watches.size(); ++i)
    text += fmt::format("{}{} watches {}", i == 0 ? "" : "\n", to_string(drive_node(bus, i)),
                        in_words(watches[i], bus.master_silence_s, longest_command_gap_s(bus, period_s)));
  return text;
}

std::string warning_of_watches(const RobotBus& bus, const AllWatches& watches) {
  std::string no_heartbeat, no_timer;
  for (std::size_t i = 0; i < watches.size(); ++i) {
    const std::string name = to_string(drive_node(bus, i));
    if (!watches[i].heartbeat) no_heartbeat += (no_heartbeat.empty() ? "" : ", ") + name;
    if (!watches[i].event_timer && bus.event_timer != false) no_timer += (no_timer.empty() ? "" : ", ") + name;
  }
  std::string text;
  if (!no_heartbeat.empty())
    text = fmt::format("no watch of the master's heartbeat (0x1016), only of commands: {}", no_heartbeat);
  if (!no_timer.empty())
    text += fmt::format(
        "{}no watch of commands (0x1400:05), only of the master's heartbeat: {}; if that is known: "
        "`event_timer = false` in [can]",
        text.empty() ? "" : "; ", no_timer);
  return text;
}

}  // namespace kenaf::real
