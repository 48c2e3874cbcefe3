// Any text is a line of a log or refused in words; a data frame that was read is written as a line that reads the same.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "can/canopen/candump_line.hpp"
#include "tests/fuzz/can_input.hpp"

using namespace kenaf::canopen;
using kenaf::fuzz::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const CandumpLine line = parse_candump_line({reinterpret_cast<const char*>(data), size});
    require(line.at >= Time::zero() && !line.interface.empty());
    if (line.kind != CandumpKind::data) {
      require(line.frame == Frame{});
      return 0;
    }
    const CandumpLine again = parse_candump_line(candump_line(line.at, line.interface, line.frame));
    require(again.kind == CandumpKind::data && again.frame == line.frame && again.interface == line.interface);
    require(line.at - again.at >= Time::zero() && line.at - again.at < std::chrono::microseconds(1));
  } catch (const BadCandumpLine& bad) {
    require(!std::string_view(bad.what()).empty());
  }
  return 0;
}
