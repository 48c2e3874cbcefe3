// A fuzzer's bytes as the lines of a recorded bus.
#pragma once

#include <optional>
#include <stdexcept>
#include <string_view>

#include "can/canopen/recorded_frame.hpp"
#include "tests/fuzz/can_input.hpp"

namespace kenaf::fuzz {

// What every reader promises of a frame.
inline void require_sound(const canopen::RecordedFrame& line) {
  using canopen::FrameKind;
  require(line.at >= canopen::Time::zero());
  require(line.frame.length <= canopen::kMaxFrameBytes && line.frame.id <= 0x7ff);
  require(line.kind == FrameKind::error || line.error_class == 0);
  if (line.kind == FrameKind::extended || line.kind == FrameKind::fd) require(line.frame == canopen::Frame{});
  for (std::size_t i = line.kind == FrameKind::remote ? 0 : line.frame.length; i < canopen::kMaxFrameBytes; ++i)
    require(line.frame.data[i] == 0);
}

// Gives each line to the reader, which returns a frame, or nothing, or refuses the line or the file in words.
template <class Read>
void read_lines(std::string_view text, Read read) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    try {
      if (const auto line = read(text.substr(0, end))) require_sound(*line);
    } catch (const canopen::BadLogLine& bad) {
      require(!std::string_view(bad.what()).empty());
    } catch (const std::runtime_error& refused) {
      require(!std::string_view(refused.what()).empty());
      return;
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

}  // namespace kenaf::fuzz
