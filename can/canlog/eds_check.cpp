#include "can/canlog/eds_check.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "can/canbus/bus_layout.hpp"
#include "can/canbus/node_setup.hpp"

namespace kenaf::canlog {
namespace {

using canbus::SdoStep;
using canopen::EdsAccess;
using canopen::EdsFile;
using canopen::EdsNumber;
using canopen::EdsObject;
using canopen::NodeId;

std::string words_of(const EdsNumber& number, NodeId node) {
  if (number.plus_node && node == 0) return fmt::format("$NODEID+{:#x}", number.value);
  return fmt::format("{}", value_for(number, node));
}

int line_of(const EdsFile& file, canopen::ObjectAddress at) {
  const EdsObject* object = file.find(at);
  return object != nullptr ? object->line : 0;
}

std::string limits_of(const EdsObject& object, NodeId node) {
  if (!object.low && !object.high) return {};
  return fmt::format("  {} to {}", object.low ? words_of(*object.low, node) : "",
                     object.high ? words_of(*object.high, node) : "");
}

// What is wrong with one transfer; "": nothing.
std::string fault_of(const SdoStep& step, const EdsObject& object, NodeId node) {
  const bool writes = step.kind == SdoStep::Kind::write;
  const unsigned bits = static_cast<unsigned>(8 * canopen::byte_count(step.what.type));
  const std::string purpose = " (" + step.what.purpose + ")";
  if (writes && object.access == EdsAccess::read_only) return "is read only, but is written" + purpose;
  if (!writes && object.access == EdsAccess::write_only) return "is write only, but is read" + purpose;
  if (object.type.number != 0 && object.type.bits() != bits)
    return fmt::format("is {}, but has {} bits in the profile{}", describe(object.type), bits, purpose);
  if (step.kind == SdoStep::Kind::expect && object.value && value_for(*object.value, node) != step.what.value)
    return fmt::format("is {:#x} and cannot be written, but must be {:#x}{}", value_for(*object.value, node),
                       step.what.value, purpose);
  if (!writes) return {};
  if (object.low && step.what.value < value_for(*object.low, node))
    return fmt::format("is at least {}, but {} is written{}", value_for(*object.low, node), step.what.value, purpose);
  if (object.high && step.what.value > value_for(*object.high, node))
    return fmt::format("is at most {}, but {} is written{}", value_for(*object.high, node), step.what.value, purpose);
  return {};
}

void check_mapped(const EdsFile& file, const canopen::Pdo& pdo, std::vector<EdsFinding>& found) {
  const char* kind = pdo.direction == canopen::PdoDirection::transmit ? "TPDO" : "RPDO";
  for (const canopen::MappedObject& mapped : pdo.objects) {
    const EdsObject* object = file.find(mapped.object);
    if (object == nullptr) {
      found.push_back({mapped.object, 0, fmt::format("is not in the file, but belongs in {}{}", kind, pdo.number)});
    } else if (!object->mappable) {
      found.push_back(
          {mapped.object, object->line, fmt::format("has PDOMapping=0, but belongs in {}{}", kind, pdo.number)});
    } else if (object->type.number != 0 && object->type.bits() != 8 * canopen::byte_count(mapped.type)) {
      found.push_back({mapped.object, object->line,
                       fmt::format("is {}, but has {} bits in {}{}", describe(object->type),
                                   8 * canopen::byte_count(mapped.type), kind, pdo.number)});
    }
  }
}

// A transfer that the library can do without can be done with this drive: the object is there, and fits.
bool is_possible(const EdsFile& file, const SdoStep& step, NodeId node) {
  const EdsObject* object = file.find(step.what.object);
  return object != nullptr && fault_of(step, *object, node).empty();
}

// Of the objects that a drive may lack, the library takes a refusal for a lack only where it ends or sets a watch.
bool may_be_refused(const SdoStep& step, const canbus::RobotBus& bus, std::size_t drive) {
  const SdoStep end = canbus::end_of_watch(bus.drives[drive].device),
                timer = canbus::write_of_event_timer(pdos_of(bus, drive).command, 0);
  return (step.what.object == end.what.object && step.what.value == end.what.value) ||
         step.what.object == timer.what.object;
}

// The library's own rule (libkenaf_real/drive_watches.hpp): a drive without any watch for its master is refused, as is
// one without the event timer that the description requires.
void check_watches(const EdsFile& file, const canbus::RobotBus& bus, std::size_t drive,
                   std::vector<EdsFinding>& found) {
  const canbus::DriveOnBus& one = bus.drives[drive];
  const SdoStep timer = canbus::write_of_event_timer(pdos_of(bus, drive).command, 0);
  const bool has_timer = is_possible(file, timer, one.node);
  if (bus.event_timer == true && !has_timer)
    found.push_back({timer.what.object, line_of(file, timer.what.object),
                     "is no event timer that can be written, which `event_timer = true` in [can] requires"});

  const std::optional<SdoStep> heartbeat = canbus::begin_of_watch(bus, one.device);
  const bool watches_commands = has_timer && bus.event_timer != false;
  if (!heartbeat || watches_commands || is_possible(file, *heartbeat, one.node)) return;
  found.push_back(
      {heartbeat->what.object, line_of(file, heartbeat->what.object),
       fmt::format("cannot be written, nor is a watch of commands possible ({}{}): nothing would stop the drive if the "
                   "program ended, and the library refuses it{}",
                   to_string(timer.what.object), bus.event_timer == false ? ", `event_timer = false` in [can]" : "",
                   canbus::advice(one.device, "error_control = \"node guarding\""))});
}

}  // namespace

std::string to_text(const EdsFile& file, NodeId node) {
  std::string out;
  for (const auto& [address, object] : file.objects) {
    out += fmt::format("{}  {:<14}  {:<14}  {}{}{}  {}\n", to_string(address), describe(object.type),
                       describe(object.access), object.mappable ? "PDO" : "   ", limits_of(object, node),
                       object.value ? "  = " + words_of(*object.value, node) : "", object.name);
  }
  return out;
}

std::vector<EdsFinding> check_eds(const EdsFile& file, const canbus::RobotBus& bus, std::size_t drive,
                                  double period_s) {
  std::vector<EdsFinding> found;
  const NodeId node = bus.drives[drive].node;
  for (const SdoStep& step : all_steps_of_drive(bus, drive, period_s)) {
    const EdsObject* object = file.find(step.what.object);
    if (object != nullptr) {
      if (std::string words = fault_of(step, *object, node); !words.empty() && !may_be_refused(step, bus, drive))
        found.push_back({step.what.object, object->line, std::move(words)});
    } else if (!step.optional) {
      const char* verb = step.kind == SdoStep::Kind::write ? "written" : "read";
      found.push_back(
          {step.what.object, 0, fmt::format("is not in the file, but is {} ({})", verb, step.what.purpose)});
    }
  }
  const canbus::DrivePdos pdos = pdos_of(bus, drive);
  check_mapped(file, pdos.state, found);
  if (pdos.has_effort) check_mapped(file, pdos.effort, found);
  if (pdos.has_battery) check_mapped(file, pdos.battery, found);
  check_mapped(file, pdos.command, found);
  check_watches(file, bus, drive, found);

  // The mode is written more than once.
  std::vector<EdsFinding> once;
  for (EdsFinding& one : found) {
    const bool is_known = std::ranges::any_of(
        once, [&](const EdsFinding& other) { return other.object == one.object && other.words == one.words; });
    if (!is_known) once.push_back(std::move(one));
  }
  return once;
}

}  // namespace kenaf::canlog
