#include "can/canlog/frame_rules.hpp"

namespace kenaf::canlog {
namespace {

std::string_view name_of(Service service) {
  switch (service) {
    case Service::nmt:
      return "NMT";
    case Service::sync:
      return "SYNC";
    case Service::time_stamp:
      return "TIME";
    case Service::emergency:
      return "EMCY";
    case Service::sdo_answer:
      return "an SDO answer";
    case Service::sdo_request:
      return "an SDO request";
    case Service::heartbeat:
      return "a heartbeat";
    case Service::transmit_pdo:
    case Service::receive_pdo:
      return "a PDO";
    case Service::none:
      break;
  }
  return "a frame";
}

}  // namespace

bool FrameRules::check(const LogFrame& logged, const Address& address) {
  return check_kind(logged) && check_identifier(logged, address) && check_length(logged, address) &&
         check_content(logged, address);
}

bool FrameRules::check_kind(const LogFrame& logged) {
  if (logged.kind == canopen::FrameKind::data) return true;
  // driver messages about the wire are not frames on it
  if (logged.kind != canopen::FrameKind::error && strange_kinds_.insert(logged.kind).second)
    findings_.add(logged, rule::identifier, "{} is on the bus", describe(logged.kind));
  return false;
}

bool FrameRules::check_identifier(const LogFrame& logged, const Address& address) {
  const std::uint16_t id = logged.frame.id;
  std::string words;
  const bool is_pdo = address.service == Service::transmit_pdo || address.service == Service::receive_pdo;
  if (address.service == Service::none) {
    words = "which CANopen does not assign";
  } else if (address.node != 0 && !network_.is_known(address.node)) {
    words = fmt::format("of node {}, which the robot's description does not have", address.node);
  } else if (is_pdo && network_.pdo(id) == nullptr && !setup_.mapped_bytes(id)) {
    words = fmt::format("{}PDO{} of {}, which was not configured", address.service == Service::receive_pdo ? 'R' : 'T',
                        address.pdo, network_.name(address.node));
  }
  if (words.empty()) return true;
  if (strange_ids_.insert(id).second)
    findings_.add(logged, rule::identifier, "identifier {:#05x} is on the bus, {}", id, words);
  return false;
}

bool FrameRules::check_length(const LogFrame& logged, const Address& address) {
  const auto expect = [&](std::size_t least, std::size_t most) {
    const std::size_t length = logged.frame.length;
    if (length >= least && length <= most) return true;
    findings_.add(logged, rule::length, "{}{} has {} bytes, not {}", name_of(address.service),
                  address.node == 0 ? "" : fmt::format(" ({})", network_.name(address.node)), length,
                  least == most ? fmt::format("{}", most) : fmt::format("{} to {}", least, most));
    return false;
  };
  switch (address.service) {
    case Service::nmt:
      return expect(2, 2);
    case Service::sync:
      return expect(0, 1);
    case Service::time_stamp:
      return expect(6, 6);
    case Service::heartbeat:
      return expect(1, 1);
    case Service::sdo_answer:
    case Service::sdo_request:
    case Service::emergency:
      return expect(8, 8);
    case Service::transmit_pdo:
    case Service::receive_pdo: {
      const auto mapped = setup_.mapped_bytes(logged.frame.id);
      if (mapped) return expect(*mapped, *mapped);
      if (!network_.is_gyro(logged.frame.id)) return true;
      // the rest of the frame is manufacturer-specific
      const canbus::GyroOnBus& gyro = *network_.bus().gyro;
      return expect((gyro.first_bit + gyro.bits + 7u) / 8, canopen::kMaxFrameBytes);
    }
    case Service::none:
      break;
  }
  return true;
}

bool FrameRules::check_content(const LogFrame& logged, const Address& address) {
  const canopen::Frame& frame = logged.frame;
  if (address.service == Service::nmt && !canopen::nmt_order_from(frame)) {
    findings_.add(logged, rule::content, "NMT order {:#04x} for node {}, which CiA 301 does not define", frame.data[0],
                  frame.data[1]);
    return false;
  }
  if (address.service == Service::heartbeat && !canopen::heartbeat_from(frame)) {
    findings_.add(logged, rule::content, "a heartbeat of {} reports state {:#04x}, which CiA 301 does not define",
                  network_.name(address.node), frame.data[0]);
    return false;
  }
  return true;
}

}  // namespace kenaf::canlog
