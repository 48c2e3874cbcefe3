#include "can/canlog/drive_frames.hpp"

namespace kenaf::canlog {

std::optional<DriveCommand> drive_command_from(const canopen::Frame& frame, const PdoInForce* pdo) {
  if (pdo == nullptr || pdo->transmit || !pdo->drive) return std::nullopt;
  const auto word = value_of(*pdo, frame, canopen::object::controlword.object);
  auto target = value_of(*pdo, frame, canopen::object::target_velocity.object);
  if (!target) target = value_of(*pdo, frame, canopen::object::target_position.object);
  if (!word || !target) return std::nullopt;
  return DriveCommand{*pdo->drive, static_cast<std::uint16_t>(*word), static_cast<std::int32_t>(*target)};
}

std::optional<DriveStatus> drive_status_from(const canopen::Frame& frame, const PdoInForce* pdo) {
  if (pdo == nullptr || !pdo->transmit || !pdo->drive) return std::nullopt;
  const auto word = value_of(*pdo, frame, canopen::object::statusword.object);
  const auto position = value_of(*pdo, frame, canopen::object::position_actual.object);
  if (!word || !position) return std::nullopt;
  return DriveStatus{*pdo->drive, static_cast<std::uint16_t>(*word), static_cast<std::int32_t>(*position)};
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
