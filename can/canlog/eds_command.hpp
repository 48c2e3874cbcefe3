// `kenaf-canlog eds FILE`: prints an electronic data sheet and compares it with what the library does with such a
// drive.
#pragma once

#include <string>

namespace kenaf::canlog {

struct EdsOptions {
  std::string file;
  std::string robot;       // a name or a TOML file; "": the file is only printed
  int node = 0;            // of the drive; 0: every drive of the robot
  double period_s = 0.01;  // of the library's cycle
};

// Prints to standard output. Returns true if the file has no error and nothing contradicts it. Throws
// std::runtime_error if it cannot be read, or the robot has no such drive.
bool print_eds(const EdsOptions& options);

}  // namespace kenaf::canlog
