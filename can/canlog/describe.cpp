#include "can/canlog/describe.hpp"

#include <fmt/format.h>

#include <numbers>

#include "can/canlog/describe_sdo.hpp"
#include "can/canlog/driver_errors.hpp"
#include "can/canlog/lss.hpp"
#include "can/canopen/device.hpp"
#include "can/canopen/drive.hpp"
#include "can/canopen/emergency.hpp"
#include "can/canopen/nmt.hpp"

namespace kenaf::canlog {
namespace {

using canopen::Frame;
using canopen::NmtCommand;
using canopen::NmtState;
using canopen::PowerState;
namespace object = canopen::object;

std::string bytes_of(const Frame& frame) {
  return fmt::format("{:02X}", fmt::join(frame.data.begin(), frame.data.begin() + frame.length, " "));
}

std::string malformed(const std::string& what, const Frame& frame) {
  return fmt::format("{}, malformed: {} bytes {}", what, frame.length, bytes_of(frame));
}

std::string_view order_words(NmtCommand command) {
  switch (command) {
    case NmtCommand::start:
      return "start";
    case NmtCommand::stop:
      return "stop";
    case NmtCommand::enter_pre_operational:
      return "enter pre-operational";
    case NmtCommand::reset_node:
      return "reset node";
    case NmtCommand::reset_communication:
      return "reset communication";
  }
  return "unknown order";
}

std::string nmt_words(const Frame& frame, const Network& network) {
  const auto order = canopen::nmt_order_from(frame);
  if (!order) return malformed("NMT", frame);
  return fmt::format("NMT {}: {}", order_words(order->command),
                     order->node == 0 ? "all nodes" : network.name(order->node));
}

std::string sync_words(const Frame& frame) {
  if (!canopen::is_sync(frame)) return malformed("SYNC", frame);
  return frame.length == 0 ? "SYNC" : fmt::format("SYNC {}", frame.data[0]);
}

std::string emergency_words(const Frame& frame, const std::string& name) {
  const auto emergency = canopen::emergency_from(frame);
  if (!emergency) return malformed(name + ": EMCY", frame);
  return fmt::format("{}: EMCY {}", name, describe(*emergency));
}

// ---- process data ----

// Avoids "-0" for a drive that counts backwards.
double without_minus_zero(double value) {
  return value + 0.0;
}

std::string position_words(std::int64_t counts, std::size_t drive, const Network& network) {
  const canbus::DriveOnBus& on_bus = network.bus().drives[drive];
  const double position = without_minus_zero(position_from_drive(on_bus.units, static_cast<std::int32_t>(counts)));
  if (!on_bus.is_flipper()) return fmt::format("{} counts ({:.4f} m)", counts, position);
  return fmt::format("{} counts ({:.2f} deg)", counts, position * 180 / std::numbers::pi);
}

std::string velocity_words(std::int64_t velocity, std::size_t drive, const Network& network) {
  const canbus::DriveOnBus& on_bus = network.bus().drives[drive];
  const double speed = without_minus_zero(velocity_from_drive(on_bus.units, static_cast<std::int32_t>(velocity)));
  return fmt::format("{:.3g} {}", speed, on_bus.is_flipper() ? "rad/s" : "m/s");
}

// The statusword bits, beyond the state, that have the same meaning in every mode.
std::string status_words(std::uint16_t statusword) {
  std::string words(describe(canopen::power_state_of(statusword)));
  if ((statusword & canopen::kStatusWarning) != 0) words += ", warning";
  if ((statusword & canopen::kStatusTargetReached) != 0) words += ", target reached";
  if ((statusword & canopen::kStatusInternalLimit) != 0) words += ", limit active";
  return words;
}

// CiA 402-2, controlword: table of commands.
std::string control_words(std::uint16_t controlword) {
  if ((controlword & canopen::kControlFaultReset) != 0) return "fault reset";
  if ((controlword & 0x02) == 0) return "disable voltage";
  if ((controlword & 0x04) == 0) return "quick stop";
  if ((controlword & 0x01) == 0) return "shutdown";
  if ((controlword & 0x08) == 0) return "switch on";
  std::string words = "enable";
  if ((controlword & canopen::kControlNewSetPoint) != 0) words += ", new set-point";
  if ((controlword & canopen::kControlHalt) != 0) words += ", halt";
  return words;
}

std::string value_words(const canopen::MappedObject& mapped, std::int64_t value, const PdoInForce& pdo,
                        const Network& network) {
  const canopen::ObjectAddress at = mapped.object;
  if (at == object::statusword.object) return status_words(static_cast<std::uint16_t>(value));
  if (at == object::controlword.object) return control_words(static_cast<std::uint16_t>(value));
  if (at == object::current_actual.object)
    return fmt::format("current {:.1f} % of rated", 0.1 * static_cast<double>(value));
  if (at == object::dc_link_voltage.object) return fmt::format("supply {:.1f} V", 1e-3 * static_cast<double>(value));
  if (at == object::slope_longitudinal.object) return fmt::format("slope longitudinal {}", value);
  if (at == object::slope_lateral.object) return fmt::format("lateral {}", value);
  if (pdo.drive) {
    if (at == object::position_actual.object) return "position " + position_words(value, *pdo.drive, network);
    if (at == object::target_position.object) return "to " + position_words(value, *pdo.drive, network);
    if (at == object::velocity_actual.object) return "speed " + velocity_words(value, *pdo.drive, network);
    if (at == object::target_velocity.object) return velocity_words(value, *pdo.drive, network);
  }
  return fmt::format("{} = {}", to_string(at), value);
}

std::string gyro_words(const Frame& frame, const std::string& name, const canbus::GyroOnBus& gyro) {
  const auto rate = canopen::bits_of(frame, gyro.first_bit, gyro.bits);
  if (!rate) return malformed(name, frame);
  return fmt::format("{}: yaw rate {} units ({:.4f} rad/s)", name, *rate, *rate / gyro.units_per_radps);
}

std::string pdo_words(const Frame& frame, const Address& address, const PdoInForce* pdo, const Network& network) {
  const bool receive = address.service == Service::receive_pdo;
  const std::string name = (receive ? "command " : "") + network.name(address.node);
  const std::string which = fmt::format("{}: {}PDO{}", name, receive ? 'R' : 'T', address.pdo);
  if (pdo == nullptr) return fmt::format("{}, not one of this robot's: {}", which, bytes_of(frame));
  if (pdo->is_gyro) return gyro_words(frame, name, *network.bus().gyro);
  if (pdo->bytes && frame.length != *pdo->bytes) return malformed(name, frame);
  const std::vector<std::int64_t> values = values_of(*pdo, frame);
  if (values.empty()) return fmt::format("{}: {}", which, bytes_of(frame));
  std::string words = name + ": ";
  for (std::size_t i = 0; i < values.size(); ++i)
    words += (i == 0 ? "" : ", ") + value_words(pdo->objects[i], values[i], *pdo, network);
  return words;
}

}  // namespace

std::string Describer::describe(const LogFrame& logged) {
  const Address address = bus_.setup().address_of(logged.frame.id);
  if (logged.kind == canopen::FrameKind::remote) return remote_words(logged.frame, address);
  if (logged.kind == canopen::FrameKind::error)
    return fmt::format("CAN controller: {}", driver_error_words(logged.error_class, logged.frame));
  if (logged.kind != canopen::FrameKind::data) return std::string(canopen::describe(logged.kind));
  const bool is_sdo = address.service == Service::sdo_request || address.service == Service::sdo_answer;
  if (is_sdo && logged.frame.length == canopen::kMaxFrameBytes) return sdo_words(logged, address);
  bus_.on_frame(logged);
  return data_words(logged.frame, address);
}

// By the service that the identifier stands for.
std::string Describer::data_words(const Frame& frame, const Address& address) {
  const std::string name = network_.name(address.node);
  switch (address.service) {
    case Service::nmt:
      return nmt_words(frame, network_);
    case Service::sync:
      return sync_words(frame);
    case Service::time_stamp:
      return "TIME " + bytes_of(frame);
    case Service::emergency:
      return emergency_words(frame, name);
    case Service::transmit_pdo:
    case Service::receive_pdo:
      return pdo_words(frame, address, bus_.setup().pdo(frame.id), network_);
    case Service::sdo_request:
      return malformed("SDO request to " + name, frame);
    case Service::sdo_answer:
      return malformed("SDO answer of " + name, frame);
    case Service::heartbeat:
      return heartbeat_words(frame, address);
    case Service::lss_request:
    case Service::lss_answer:
      return lss_words(frame);
    case Service::none:
      break;
  }
  return fmt::format("identifier {:#05x}, which CANopen does not assign: {}", frame.id, bytes_of(frame));
}

std::string Describer::remote_words(const Frame& frame, const Address& address) {
  const std::string name = network_.name(address.node);
  if (address.service == Service::heartbeat) {
    asked_.insert(address.node);
    return name + ": node guarding, request";
  }
  if (address.service == Service::transmit_pdo) return fmt::format("{}: request of TPDO{}", name, address.pdo);
  return fmt::format("a remote frame, identifier {:#05x}", frame.id);
}

std::string Describer::heartbeat_words(const Frame& frame, const Address& address) {
  const std::string name = network_.name(address.node);
  const bool asked = asked_.erase(address.node) > 0;
  const auto answer = canopen::error_control_from(frame);
  if (!answer) return malformed(name + ": heartbeat", frame);
  if (answer->state == NmtState::boot_up) return name + ": boot-up";
  if (!asked && !answer->toggle) return fmt::format("{}: heartbeat, {}", name, canopen::describe(answer->state));
  return fmt::format("{}: node guarding, {}, toggle bit {}", name, canopen::describe(answer->state),
                     answer->toggle ? 1 : 0);
}

// What a frame of a block transfer is depends on those before it, and the end gives what was transferred.
std::string Describer::sdo_words(const LogFrame& logged, const Address& address) {
  const bool answer = address.service == Service::sdo_answer;
  const std::string name = network_.name(address.node);
  const SdoBlock* before = bus_.dialogue().block(address.node);
  const bool segment = before != nullptr && before->is_segment(logged.frame, answer);
  bus_.on_frame(logged);
  if (segment) return block_segment_words(logged.frame, name, answer);
  const SdoBlock* after = bus_.dialogue().block(address.node);
  if (after != nullptr && after->is_ended() && after->is_download() != answer)
    return block_end_words(*after, logged.frame, name);
  return answer ? sdo_answer_words(logged.frame, name) : sdo_request_words(logged.frame, name);
}

}  // namespace kenaf::canlog
