// Errors of an engine against closed forms, at the time step at which it is timed.
#pragma once

#include <vector>

#include "bench/engines/compared_engines.hpp"

namespace kenaf::bench {

struct AccuracyFigure {
  const char* name;  // also the CSV's column, unit included
  const char* what;
  const char* format;  // of a table's cell
  double tolerance;    // in the project's own tests of this closed form
};
// Signed errors; 0 is exact.
const std::vector<AccuracyFigure>& accuracy_figures();

// In the order of accuracy_figures().
std::vector<double> measure_accuracy(const Engine& engine);

}  // namespace kenaf::bench
