#include "can/canlog/object_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace kenaf::canlog {
namespace {

struct Name {
  std::uint16_t index;
  std::string_view words;
};

constexpr Name kNames[] = {
    // CiA 301
    {0x1000, "device type"},
    {0x1001, "error register"},
    {0x1002, "manufacturer status register"},
    {0x1003, "error history"},
    {0x1005, "identifier of SYNC"},
    {0x1006, "communication cycle period"},
    {0x1007, "synchronous window length"},
    {0x1008, "device name"},
    {0x1009, "hardware version"},
    {0x100a, "software version"},
    {0x1010, "store parameters"},
    {0x1011, "restore default parameters"},
    {0x1014, "identifier of EMCY"},
    {0x1015, "EMCY inhibit time"},
    {0x1016, "consumer heartbeat time"},
    {0x1017, "producer heartbeat time"},
    {0x1018, "identity"},
    {0x1019, "SYNC counter overflow"},
    {0x1029, "error behaviour"},
    // CiA 302-3, program download
    {0x1f50, "program data"},
    {0x1f51, "program control"},
    {0x1f56, "program identification"},
    {0x1f57, "flash status"},
    // CiA 410, of an inclinometer
    {0x6000, "slope resolution"},
    {0x6010, "slope, longitudinal"},
    {0x6020, "slope, lateral"},
    {0x6110, "slope, longitudinal, 32 bits"},
    {0x6120, "slope, lateral, 32 bits"},
    // CiA 402, of a drive
    {0x6007, "abort connection option"},
    {0x603f, "error code"},
    {0x6040, "controlword"},
    {0x6041, "statusword"},
    {0x605a, "quick stop option"},
    {0x605b, "shutdown option"},
    {0x605c, "disable operation option"},
    {0x605d, "halt option"},
    {0x605e, "fault reaction option"},
    {0x6060, "mode of operation"},
    {0x6061, "mode of operation in force"},
    {0x6064, "position"},
    {0x6065, "following error window"},
    {0x606c, "velocity"},
    {0x6071, "target torque"},
    {0x6072, "torque limit"},
    {0x6075, "rated current"},
    {0x6076, "rated torque"},
    {0x6077, "torque"},
    {0x6078, "current"},
    {0x6079, "DC link voltage"},
    {0x607a, "target position"},
    {0x607c, "home offset"},
    {0x607d, "software position limit"},
    {0x607f, "velocity limit"},
    {0x6081, "profile velocity"},
    {0x6083, "profile acceleration"},
    {0x6084, "profile deceleration"},
    {0x6085, "quick stop deceleration"},
    {0x6098, "homing method"},
    {0x6099, "homing speed"},
    {0x609a, "homing acceleration"},
    {0x60c2, "interpolation time"},
    {0x60ff, "target velocity"},
    {0x6502, "supported drive modes"},
};

// Sub-indices of a PDO's communication record: CiA 301, 7.5.2.35 and 7.5.2.37.
std::string_view communication_name(std::uint8_t sub) {
  switch (sub) {
    case 1:
      return "identifier";
    case 2:
      return "transmission type";
    case 3:
      return "inhibit time";
    case 5:
      return "event timer";
    case 6:
      return "SYNC start value";
  }
  return "record";
}

std::string pdo_name(canopen::ObjectAddress object) {
  const unsigned number = (object.index & 0x1ff) + 1u;
  const char kind = object.index < 0x1800 ? 'R' : 'T';
  if ((object.index & 0x200) == 0) return fmt::format("{}PDO{} {}", kind, number, communication_name(object.sub));
  if (object.sub == 0) return fmt::format("{}PDO{} mapping, count", kind, number);
  return fmt::format("{}PDO{} mapping, entry {}", kind, number, object.sub);
}

}  // namespace

std::string object_name(canopen::ObjectAddress object) {
  if (object.index >= 0x1400 && object.index <= 0x1bff) return pdo_name(object);
  const auto* found = std::ranges::find(kNames, object.index, &Name::index);
  if (found == std::end(kNames)) return {};
  return object.sub == 0 ? std::string(found->words) : fmt::format("{}, {}", found->words, object.sub);
}

std::string object_words(canopen::ObjectAddress object) {
  const std::string name = object_name(object);
  return name.empty() ? to_string(object) : fmt::format("{} ({})", to_string(object), name);
}

}  // namespace kenaf::canlog
