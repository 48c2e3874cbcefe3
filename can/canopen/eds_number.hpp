// Numbers in electronic data sheets: CiA 306-1, 4.3 (decimal, 0x hexadecimal, 0 octal) and 4.6.3.2 ($NODEID).
//
// Thread safety: values and pure functions.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "can/canopen/nmt.hpp"

namespace kenaf::canopen {

// `value`, plus the node's number if the file says so: "$NODEID+0x180".
struct EdsNumber {
  std::int64_t value = 0;
  bool plus_node = false;
  bool operator==(const EdsNumber&) const = default;
};
constexpr std::int64_t value_for(const EdsNumber& number, NodeId node) {
  return number.value + (number.plus_node ? node : 0);
}

// One number of at most 64 bits, with a sign or not, before or after $NODEID and a plus; nullopt for anything else,
// also for an empty text. Upper and lower case are the same.
std::optional<EdsNumber> eds_number(std::string_view text);

}  // namespace kenaf::canopen
