// A recorded bus in memory: the frames of a `candump -L` log, with their line numbers.
#pragma once

#include <cstddef>
#include <istream>
#include <string>
#include <vector>

#include "can/canopen/candump_line.hpp"

namespace kenaf::canlog {

struct LogFrame {
  std::size_t line;  // counted from 1
  canopen::Time at;
  canopen::CandumpKind kind;
  canopen::Frame frame;  // for kind data; otherwise empty
};

struct BadLine {
  std::size_t line;
  std::string words;  // the error in the line
};

struct Log {
  std::string interface {};        // empty: no line was read
  std::vector<LogFrame> frames{};  // in the order of the file
  std::vector<BadLine> bad_lines{};
  std::size_t other_interfaces = 0;  // lines skipped
};

// Skips empty lines and those that begin with '#'; an unreadable line is dropped and reported. Reads frames of
// `interface` only or, if that is empty, of the interface of the first line: a log of two buses is two logs.
Log read_log(std::istream& in, const std::string& interface = {});

}  // namespace kenaf::canlog
