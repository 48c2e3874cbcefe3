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
      if (std::string words = fault_of(step, *object, node); !words.empty() && !step.optional)
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
