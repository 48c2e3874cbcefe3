#include "can/canlog/frame_rules.hpp"

#include "can/canlog/driver_errors.hpp"

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
    case Service::lss_request:
    case Service::lss_answer:
      return "LSS";
    case Service::none:
      break;
  }
  return "a frame";
}

}  // namespace

bool FrameRules::check(const LogFrame& logged, const Address& address) {
  if (logged.kind != canopen::FrameKind::data) {
    check_other_kind(logged, address);
    return false;
  }
  return check_identifier(logged, address) && check_length(logged, address) && check_content(logged, address);
}

void FrameRules::check_other_kind(const LogFrame& logged, const Address& address) {
  if (logged.kind == canopen::FrameKind::error) {
    if (is_bus_off(logged.error_class)) {
      findings_.add(logged, rule::bus_off, "the recorder's CAN controller is off the bus: it sends and hears nothing");
    }
  } else if (logged.kind == canopen::FrameKind::remote) {
    check_remote(logged, address);
  } else if (strange_kinds_.insert(logged.kind).second) {
    findings_.add(logged, rule::identifier, "{} is on the bus", describe(logged.kind));
  }
}

// CiA 301 has remote frames for node guarding, and to ask for transmit PDOs that do not forbid it.
void FrameRules::check_remote(const LogFrame& logged, const Address& address) {
  const PdoInForce* pdo = setup_.pdo(logged.frame.id);
  std::string words = strangeness(logged.frame.id, address);
  if (words.empty() && address.service == Service::transmit_pdo && pdo != nullptr && pdo->no_remote)
    words = fmt::format("TPDO{} of {}, which forbids them", address.pdo, network_.name(address.node));
  if (words.empty() && address.service != Service::heartbeat && address.service != Service::transmit_pdo)
    words = fmt::format("which is {}", name_of(address.service));
  if (words.empty() || !strange_requests_.insert(logged.frame.id).second) return;
  findings_.add(logged, rule::identifier, "a remote frame asks for identifier {:#05x}, {}", logged.frame.id, words);
}

// Why the identifier is not to be expected; empty: it is.
std::string FrameRules::strangeness(std::uint16_t cob_id, const Address& address) const {
  if (address.service == Service::none) return "which CANopen does not assign";
  if (address.node != 0 && !network_.is_known(address.node))
    return fmt::format("of node {}, which the robot's description does not have", address.node);
  if (address.node != 0 && network_.is_other(address.node)) return {};
  const bool is_pdo = address.service == Service::transmit_pdo || address.service == Service::receive_pdo;
  if (!is_pdo || setup_.pdo(cob_id) != nullptr) return {};
  return fmt::format("{}PDO{} of {}, which {}", address.service == Service::receive_pdo ? 'R' : 'T', address.pdo,
                     network_.name(address.node),
                     setup_.is_given_up(cob_id) ? "was moved away or made invalid" : "was not configured");
}

bool FrameRules::check_identifier(const LogFrame& logged, const Address& address) {
  const std::string words = strangeness(logged.frame.id, address);
  if (words.empty()) return true;
  if (strange_ids_.insert(logged.frame.id).second)
    findings_.add(logged, rule::identifier, "identifier {:#05x} is on the bus, {}", logged.frame.id, words);
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
    case Service::lss_request:
    case Service::lss_answer:
      return expect(8, 8);
    case Service::transmit_pdo:
    case Service::receive_pdo: {
      const PdoInForce* pdo = setup_.pdo(logged.frame.id);
      if (pdo != nullptr && pdo->bytes) return expect(*pdo->bytes, *pdo->bytes);
      if (pdo == nullptr || !pdo->is_gyro) return true;
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
  if (address.service == Service::heartbeat && !canopen::error_control_from(frame)) {
    findings_.add(logged, rule::content, "a heartbeat of {} reports state {:#04x}, which CiA 301 does not define",
                  network_.name(address.node), frame.data[0]);
    return false;
  }
  return true;
}

}  // namespace kenaf::canlog
