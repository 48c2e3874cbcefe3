// One row of the validation: what a measurement or a closed form says, and what the simulation does.
#pragma once

#include <string>

namespace kenaf::validation {

struct ComparisonRow {
  std::string what, reference;  // reference: its source, or the formula
  double expected, simulated;
  std::string unit;
};

// A row of a Markdown table: what, reference, expected, simulated, simulated over expected.
std::string markdown(const ComparisonRow& row);

}  // namespace kenaf::validation
