#include "can/canlog/log.hpp"

#include <utility>

#include "can/canlog/log_clock.hpp"
#include "can/canlog/log_format.hpp"

namespace kenaf::canlog {

using canopen::RecordedFrame;
using canopen::Stamp;

namespace {

struct Lines {
  std::vector<std::size_t> numbers;
  std::vector<RecordedFrame> frames;  // as many
  std::vector<BadLine> bad;
};

// A log is recorded with times or without: a line that differs from the first is damaged.
void keep(Lines& lines, std::size_t number, RecordedFrame frame) {
  const bool first = lines.frames.empty(), timed = frame.stamp != Stamp::none;
  if (!first && timed != (lines.frames.front().stamp != Stamp::none))
    throw canopen::BadLogLine(timed ? "a time, where the first frame has none"
                                    : "no time, where the first frame has one");
  lines.numbers.push_back(number);
  lines.frames.push_back(std::move(frame));
}

Lines read_lines(std::istream& in) {
  Lines lines;
  LineReader read;
  std::string text;
  for (std::size_t number = 1; std::getline(in, text); ++number) {
    const std::size_t first = text.find_first_not_of(" \t\r");
    if (first == std::string::npos || text[first] == '#') continue;
    if (!read) read = reader_of(text);
    try {
      if (auto frame = read(text)) keep(lines, number, std::move(*frame));
    } catch (const canopen::BadLogLine& bad) {
      lines.bad.push_back({number, bad.what()});
    }
  }
  return lines;
}

}  // namespace

Log read_log(std::istream& in, const std::string& interface) {
  Lines lines = read_lines(in);
  Log log{.interface = interface, .bad_lines = std::move(lines.bad)};
  if (lines.frames.empty()) return log;
  log.has_times = lines.frames.front().stamp != Stamp::none;

  // An interval counts from the line before, whatever its interface.
  log.summed_times = are_intervals(lines.frames);
  if (log.summed_times) sum_up(lines.frames);

  if (log.interface.empty()) log.interface = lines.frames.front().interface;
  for (std::size_t i = 0; i < lines.frames.size(); ++i) {
    const RecordedFrame& line = lines.frames[i];
    if (line.interface == log.interface) {
      log.frames.push_back({lines.numbers[i], line.at, line.kind, line.frame, line.error_class});
    } else {
      ++log.other_interfaces;
    }
  }
  log.clock_steps = remove_steps(log.frames);
  return log;
}

}  // namespace kenaf::canlog
