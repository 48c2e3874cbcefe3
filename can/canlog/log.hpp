// A recorded bus in memory: the frames of a log of `candump -L`, each with its line.
#pragma once

#include <cstddef>
#include <istream>
#include <string>
#include <vector>

#include "can/canopen/candump_line.hpp"

namespace kenaf::canlog {

struct LogFrame {
  std::size_t line;  // from 1 on
  canopen::Time at;
  canopen::CandumpKind kind;
  canopen::Frame frame;  // of kind data; else empty
};

struct BadLine {
  std::size_t line;
  std::string words;  // what is wrong with it
};

struct Log {
  std::string interface {};        // empty: no line was read
  std::vector<LogFrame> frames{};  // in the order of the file
  std::vector<BadLine> bad_lines{};
  std::size_t other_interfaces = 0;  // lines that were left out
};

// Empty lines and those that begin with '#' are passed over; a line that cannot be read costs that line. Of `interface`
// alone, or, where that is empty, of the interface of the first line: a log of two buses is two logs.
Log read_log(std::istream& in, const std::string& interface = {});

}  // namespace kenaf::canlog
