// The machine that figures were measured on, and its clocks.
#pragma once

#include <string>

namespace kenaf::bench {

struct Machine {
  std::string processor;  // as /proc/cpuinfo names it
  unsigned cores;         // that this process may use
  std::string compiler;
};
Machine this_machine();

// Pins the calling thread to the n-th core that the process may use. Returns false if that is not allowed.
bool pin_to_core(unsigned n);

struct Clocks {
  double cpu_s, wall_s;  // of the calling thread; since some point in the past
};
Clocks read_clocks();

}  // namespace kenaf::bench
