#include "can/canlog/log.hpp"

#include <utility>

namespace kenaf::canlog {

Log read_log(std::istream& in, const std::string& interface) {
  Log log{.interface = interface};
  std::string text;
  for (std::size_t number = 1; std::getline(in, text); ++number) {
    const std::size_t first = text.find_first_not_of(" \t\r");
    if (first == std::string::npos || text[first] == '#') continue;
    try {
      const canopen::CandumpLine line = canopen::parse_candump_line(text);
      if (log.interface.empty()) log.interface = line.interface;
      if (line.interface == log.interface) {
        log.frames.push_back({number, line.at, line.kind, line.frame});
      } else {
        ++log.other_interfaces;
      }
    } catch (const canopen::BadCandumpLine& bad) {
      log.bad_lines.push_back({number, bad.what()});
    }
  }
  return log;
}

}  // namespace kenaf::canlog
