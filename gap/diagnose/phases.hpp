// The phases of a run, derived from its measurements: stand, speed change, slow down, cruise, turn, flippers, contact,
// climb, descend, tip, land, fall. phases.cpp has the limits.
//
// Thread safety: pure functions.
#pragma once

#include <string_view>
#include <vector>

#include "gap/diagnose/observation.hpp"

namespace kenaf::gap::diagnose {

struct PhaseSpan {
  std::string_view name;
  double from_s, to_s;
  double x_m, y_m;  // the robot's position in its middle, NaN if not measured
};

// Returns phases in the order of time, without gaps, none shorter than 0.1 s. Phases that need a missing measurement do
// not occur: no climb without pitch.
std::vector<PhaseSpan> phases_of(const Observation& observation);

}  // namespace kenaf::gap::diagnose
