// The phases of a run, found from what was measured: stand, speed change, slow down, cruise, turn, flippers, contact,
// climb, descend, tip, land, fall. phases.cpp has the limits of each.
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
  double x_m, y_m;  // where the robot is in its middle, NaN where that was not measured
};

// In the order of time, without gaps, none shorter than 0.1 s. What was not measured is taken as not happening: without
// pitch no climb.
std::vector<PhaseSpan> phases_of(const Observation& observation);

}  // namespace kenaf::gap::diagnose
