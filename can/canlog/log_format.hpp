// The formats of recorded buses: told by a file's first line, read line by line.
//
// Read: candump with and without -L (python-can's .log too), PCAN traces 1.1, 2.0 and 2.1, Vector's ASCII logs,
// python-can's CSV. Known, and refused by name: binary logs, compressed files, and texts of other programs.
#pragma once

#include <functional>
#include <optional>
#include <string_view>

#include "can/canopen/recorded_frame.hpp"

namespace kenaf::canlog {

// Takes the lines of one file in their order. nullopt: a line without a frame. Throws canopen::BadLogLine for a line
// that cannot be read, std::runtime_error for a file that cannot.
using LineReader = std::function<std::optional<canopen::RecordedFrame>(std::string_view line)>;

// By the first line that is neither empty nor begins with '#'. Throws std::runtime_error with the format's name.
LineReader reader_of(std::string_view first_line);

}  // namespace kenaf::canlog
