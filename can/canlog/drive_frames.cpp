#include "can/canlog/drive_frames.hpp"

#include <array>

namespace kenaf::canlog {

namespace {

struct Pair {
  std::size_t drive;
  std::int64_t first, second;
};

// Both frames are a 16-bit word and a 32-bit number.
std::optional<Pair> pair_from(const canopen::Frame& frame, const Network& network, const canopen::MappedObject& word) {
  const KnownPdo* known = network.pdo(frame.id);
  if (known == nullptr || !known->drive || known->pdo.objects.front().object != word.object) return std::nullopt;
  std::array<std::int64_t, 2> values{};
  if (!unpack(known->pdo, frame, values)) return std::nullopt;
  return Pair{*known->drive, values[0], values[1]};
}

}  // namespace

std::optional<DriveCommand> drive_command_from(const canopen::Frame& frame, const Network& network) {
  const auto pair = pair_from(frame, network, canopen::object::controlword);
  if (!pair) return std::nullopt;
  return DriveCommand{pair->drive, static_cast<std::uint16_t>(pair->first), static_cast<std::int32_t>(pair->second)};
}

std::optional<DriveStatus> drive_status_from(const canopen::Frame& frame, const Network& network) {
  const auto pair = pair_from(frame, network, canopen::object::statusword);
  if (!pair) return std::nullopt;
  return DriveStatus{pair->drive, static_cast<std::uint16_t>(pair->first), static_cast<std::int32_t>(pair->second)};
}

DriveOrder order_of(std::uint16_t controlword) {
  if ((controlword & canopen::kControlFaultReset) != 0) return DriveOrder::fault_reset;
  if ((controlword & 0x02) == 0) return DriveOrder::disable_voltage;
  if ((controlword & 0x04) == 0) return DriveOrder::quick_stop;
  if ((controlword & 0x01) == 0) return DriveOrder::shutdown;
  return (controlword & 0x08) == 0 ? DriveOrder::switch_on : DriveOrder::enable;
}

std::string_view describe(DriveOrder order) {
  switch (order) {
    case DriveOrder::disable_voltage:
      return "disable voltage";
    case DriveOrder::quick_stop:
      return "quick stop";
    case DriveOrder::shutdown:
      return "shutdown";
    case DriveOrder::switch_on:
      return "switch on";
    case DriveOrder::enable:
      return "enable";
    case DriveOrder::fault_reset:
      return "fault reset";
  }
  return "unknown order";
}

}  // namespace kenaf::canlog
