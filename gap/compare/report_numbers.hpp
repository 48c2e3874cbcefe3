// The number format of a report and the rows of its summary, shared by text and page.
#pragma once

#include <string>
#include <vector>

#include "gap/compare/comparison.hpp"

namespace kenaf::gap::compare {

inline constexpr double kMillimetres = 1e3, kDegrees = 57.29577951308232;

// Formats with the given number of decimals; "-" if unknown.
std::string number(double value, int decimals);

// "(x, z)" or "(x, y)".
std::string coordinates(Plane plane);

// "step-200-flippers", "step-200-flippers #2" if the manoeuvre has repeats, "run-003.csv" if it has no name.
std::string run_title(const Comparison& comparison, std::size_t run);

struct SummaryRow {
  enum class Kind { run, manoeuvre, all } kind;
  std::string title;
  std::size_t run;  // of Kind::run: its index in Comparison::runs
  ErrorSummary matched, same_time;
};

// Returns a row for each run, one after the last run of a manoeuvre with several runs, and one for all runs if there
// are several manoeuvres.
std::vector<SummaryRow> summary_rows(const Comparison& comparison);

}  // namespace kenaf::gap::compare
