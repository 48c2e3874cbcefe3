// How far an engine is from closed forms, at the time step that it is timed at.
#pragma once

#include <vector>

#include "bench/engines/compared_engines.hpp"

namespace kenaf::bench {

struct AccuracyFigure {
  const char* name;  // also the CSV's column, unit included
  const char* what;
  const char* format;  // of a table's cell
  double tolerance;    // of the project's own tests of this closed form
};
// Errors; 0 is right, the sign says which way.
const std::vector<AccuracyFigure>& accuracy_figures();

// In the order of accuracy_figures().
std::vector<double> measure_accuracy(const Engine& engine);

}  // namespace kenaf::bench
