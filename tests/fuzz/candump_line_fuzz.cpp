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
    const RecordedFrame line = parse_candump_line({reinterpret_cast<const char*>(data), size});
    require(line.at >= Time::zero() && !line.interface.empty());
    require((line.kind == FrameKind::error) || line.error_class == 0);
    if (line.kind == FrameKind::extended || line.kind == FrameKind::fd) require(line.frame == Frame{});
    if (line.kind == FrameKind::remote) require(line.frame == Frame{.id = line.frame.id, .length = line.frame.length});
    if (line.kind != FrameKind::data) return 0;
    const RecordedFrame again = parse_candump_line(candump_line(line.at, line.interface, line.frame));
    require(again.kind == FrameKind::data && again.frame == line.frame && again.interface == line.interface);
    require(line.at - again.at >= Time::zero() && line.at - again.at < std::chrono::microseconds(1));
  } catch (const BadLogLine& bad) {
    require(!std::string_view(bad.what()).empty());
  }
  return 0;
}
