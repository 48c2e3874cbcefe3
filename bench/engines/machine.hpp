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

// Keeps the calling thread on the n-th core that the process may use. false: not allowed, it runs where it will.
bool pin_to_core(unsigned n);

struct Clocks {
  double cpu_s, wall_s;  // of the calling thread; since some point in the past
};
Clocks read_clocks();

}  // namespace kenaf::bench
