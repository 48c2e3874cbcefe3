// Logs as they are written by hand: a time in ms and a frame as candump has it, one a line. And the robot they are of.
#pragma once

#include <fmt/format.h>

#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "can/canlog/describe.hpp"
#include "can/canlog/log.hpp"
#include "can/canlog/network.hpp"
#include "can/canlog/rules.hpp"
#include "tests/can/candrives/easy_robot.hpp"

namespace kenaf::canlog {

// 10000 counts for 1 m of track and 1 rad of flipper; nodes 1 and 2 tracks, 3 to 6 flippers, 7 inclinometer, 8 gyro.
inline const Network& easy_network() {
  static const Network network(candrives::easy_robot());
  return network;
}

struct Line {
  double ms;
  std::string_view frame;  // "181#2704"
};
using Lines = std::vector<Line>;

inline Log log_from(const std::string& text) {
  std::stringstream in(text);
  return read_log(in);
}

inline Log log_of(const Lines& lines) {
  std::stringstream text;
  for (const Line& line : lines) text << fmt::format("({:.6f}) vcan0 {}\n", 1e-3 * line.ms, line.frame);
  Log log = read_log(text);
  if (!log.bad_lines.empty()) throw std::runtime_error("a test's own line: " + log.bad_lines.front().words);
  return log;
}

// The description of each line.
inline std::vector<std::string> words_of(const Lines& lines) {
  Describer describer(easy_network());
  std::vector<std::string> words;
  for (const LogFrame& frame : log_of(lines).frames) words.push_back(describer.describe(frame));
  return words;
}

inline std::string words_of_frame(std::string_view frame) {
  return words_of({{0, frame}}).front();
}

// "line: rule" of each violation.
inline std::vector<std::string> broken(const Lines& lines, const CheckOptions& options = {}) {
  std::vector<std::string> found;
  for (const Violation& one : check_rules(log_of(lines), easy_network(), options))
    found.push_back(fmt::format("{}: {}", one.line, one.rule.name));
  return found;
}

inline Lines operator+(Lines first, const Lines& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

using Broken = std::vector<std::string>;

}  // namespace kenaf::canlog
