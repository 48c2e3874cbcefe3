// The frames of a drive in the control loop, decoded.
#pragma once

#include <cstdint>
#include <optional>

#include "can/canlog/pdo_in_force.hpp"
#include "can/canopen/drive.hpp"

namespace kenaf::canlog {

struct DriveCommand {
  std::size_t drive;
  std::uint16_t controlword;
  std::int32_t target;  // position or velocity, in the drive's units
};
// `pdo` is what the frame's identifier carries, nullptr for nothing. nullopt: no PDO of a drive with a controlword and
// a target, or the wrong length.
std::optional<DriveCommand> drive_command_from(const canopen::Frame& frame, const PdoInForce* pdo);

struct DriveStatus {
  std::size_t drive;
  std::uint16_t statusword;
  std::int32_t position;
};
// nullopt: no PDO of a drive with its statusword and position, or the wrong length.
std::optional<DriveStatus> drive_status_from(const canopen::Frame& frame, const PdoInForce* pdo);

// CiA 402-2, controlword: commands, by bits 0 to 3 and 7.
enum class DriveOrder : std::uint8_t { disable_voltage, quick_stop, shutdown, switch_on, enable, fault_reset };
DriveOrder order_of(std::uint16_t controlword);
std::string_view describe(DriveOrder order);  // "quick stop"

}  // namespace kenaf::canlog
