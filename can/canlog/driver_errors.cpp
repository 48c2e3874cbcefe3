#include "can/canlog/driver_errors.hpp"

#include <fmt/format.h>

#include <iterator>
#include <span>
#include <string_view>
#include <vector>

namespace kenaf::canlog {
namespace {

// Classes.
constexpr std::uint32_t kSendTimeout = 0x001, kLostArbitration = 0x002, kController = 0x004, kProtocol = 0x008,
                        kTransceiver = 0x010, kNoAcknowledge = 0x020, kBusOffClass = 0x040, kBusError = 0x080,
                        kRestarted = 0x100, kCounters = 0x200;
// Bytes.
constexpr std::size_t kControllerByte = 1, kProtocolByte = 2, kPlaceByte = 3, kTransceiverByte = 4, kSendCount = 6,
                      kReceiveCount = 7;

struct BitName {
  std::uint8_t bit;
  std::string_view words;
};

constexpr BitName kControllerNames[] = {
    {0x01, "receive buffer overflow"}, {0x02, "send buffer overflow"},     {0x04, "error warning, receiving"},
    {0x08, "error warning, sending"},  {0x10, "error passive, receiving"}, {0x20, "error passive, sending"},
    {0x40, "error active again"},
};
constexpr std::uint8_t kOverflow = 0x01, kWarning = 0x0c, kPassive = 0x30, kActive = 0x40;

constexpr BitName kProtocolNames[] = {
    {0x01, "bit"},           {0x02, "form"},     {0x04, "stuff"},        {0x08, "dominant bit"},
    {0x10, "recessive bit"}, {0x20, "overload"}, {0x40, "active error"}, {0x80, "while sending"},
};

std::string names_of(std::uint8_t bits, std::span<const BitName> names, std::string_view none) {
  std::vector<std::string_view> found;
  for (const BitName& name : names) {
    if ((bits & name.bit) != 0) found.push_back(name.words);
  }
  return found.empty() ? std::string(none) : fmt::format("{}", fmt::join(found, ", "));
}

// linux/can/error.h, data[3]: the places at which an error of the acknowledgement or of the CRC is found.
std::string place_words(std::uint8_t place) {
  switch (place) {
    case 0x00:
      return "";
    case 0x08:
      return " in the CRC";
    case 0x18:
      return " at the CRC delimiter";
    case 0x19:
      return " at the acknowledgement";
    case 0x1b:
      return " at the acknowledgement delimiter";
    default:
      return fmt::format(" at place {:#04x}", place);
  }
}

}  // namespace

void set_error(canopen::RecordedFrame& line, const DriverError& error) {
  std::uint8_t bits = 0;
  if (error.overflow) bits |= kOverflow;
  if (error.warning) bits |= kWarning;
  if (error.passive) bits |= kPassive;
  if (error.active) bits |= kActive;
  line.kind = canopen::FrameKind::error;
  line.frame = {.id = 0, .length = canopen::kMaxFrameBytes};
  line.frame.data[kControllerByte] = bits;
  line.frame.data[kProtocolByte] = error.protocol;
  line.frame.data[kSendCount] = error.send_count.value_or(0);
  line.frame.data[kReceiveCount] = error.receive_count.value_or(0);
  line.error_class = (error.bus_off ? kBusOffClass : 0) | (bits != 0 ? kController : 0) |
                     (error.is_protocol ? kProtocol : 0) | (error.send_count || error.receive_count ? kCounters : 0);
}

bool is_bus_off(std::uint32_t error_class) {
  return (error_class & kBusOffClass) != 0;
}

std::string driver_error_words(std::uint32_t error_class, const canopen::Frame& frame) {
  std::vector<std::string> words;
  const auto has = [error_class](std::uint32_t bit) { return (error_class & bit) != 0; };
  const auto& data = frame.data;
  if (has(kBusOffClass)) words.emplace_back("bus-off");
  if (has(kRestarted)) words.emplace_back("restarted after bus-off");
  if (has(kController)) words.push_back(names_of(data[kControllerByte], kControllerNames, "controller error"));
  if (has(kSendTimeout)) words.emplace_back("sending timed out");
  if (has(kLostArbitration)) {
    words.push_back(data[0] == 0 ? "arbitration lost" : fmt::format("arbitration lost at bit {}", data[0]));
  }
  if (has(kProtocol)) {
    words.push_back(fmt::format("protocol error ({}){}", names_of(data[kProtocolByte], kProtocolNames, "unspecified"),
                                place_words(data[kPlaceByte])));
  }
  if (has(kTransceiver)) words.push_back(fmt::format("transceiver error {:#04x}", data[kTransceiverByte]));
  if (has(kNoAcknowledge)) words.emplace_back("no acknowledgement");
  if (has(kBusError)) words.emplace_back("bus error");

  // Drivers older than the class of the counters give them too.
  if (has(kCounters) || (has(kController | kProtocol | kBusError) && (data[kSendCount] | data[kReceiveCount]) != 0))
    words.push_back(fmt::format("error counters {} sending, {} receiving", data[kSendCount], data[kReceiveCount]));
  return words.empty() ? "unspecified" : fmt::format("{}", fmt::join(words, "; "));
}

}  // namespace kenaf::canlog
