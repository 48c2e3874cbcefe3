// A recorded bus in memory: the frames of a log, with their line numbers, in one continuous time.
#pragma once

#include <cstddef>
#include <istream>
#include <string>
#include <vector>

#include "can/canopen/recorded_frame.hpp"

namespace kenaf::canlog {

struct LogFrame {
  std::size_t line;  // counted from 1
  canopen::Time at;  // never decreases
  canopen::FrameKind kind;
  canopen::Frame frame;           // as in canopen::RecordedFrame
  std::uint32_t error_class = 0;  // for kind error
  std::size_t clock_steps = 0;    // of the recorder's clock, before this frame: times of two frames are only
                                  // comparable if they have the same
};

struct BadLine {
  std::size_t line;
  std::string words;  // the error in the line
};

// The recorder's clock was set back. The time that passed meanwhile is unknown; the log's time stands still over it.
struct ClockStep {
  std::size_t line;    // of the first frame after it
  canopen::Time back;  // greater than 0
};

struct Log {
  std::string interface {};        // empty: no line was read
  std::vector<LogFrame> frames{};  // in the order of the file
  std::vector<BadLine> bad_lines{};
  std::vector<ClockStep> clock_steps{};
  std::size_t other_interfaces = 0;  // lines skipped
  bool has_times = true;             // false: plain `candump`; every time is 0
  bool summed_times = false;         // the file has the time since the frame before (`candump -td`)
};

// Reads the formats of log_format.hpp. Skips empty lines and those that begin with '#'; an unreadable line is dropped
// and reported. Reads frames of `interface` only or, if that is empty, of the interface of the first line: a log of two
// buses is two logs. Throws std::runtime_error, with its name, for a format that is not read.
Log read_log(std::istream& in, const std::string& interface = {});

}  // namespace kenaf::canlog
