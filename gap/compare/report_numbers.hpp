// How a report writes its numbers, and the rows of its summary: what text and page share.
#pragma once

#include <string>
#include <vector>

#include "gap/compare/comparison.hpp"

namespace kenaf::gap::compare {

inline constexpr double kMillimetres = 1e3, kDegrees = 57.29577951308232;

// With so many decimals; "-" where not known.
std::string number(double value, int decimals);

// "step-200-flippers" or "step-200-flippers #2" where the manoeuvre has repeats; "run-003.csv" where it has no name.
std::string run_title(const Comparison& comparison, std::size_t run);

struct SummaryRow {
  enum class Kind { run, manoeuvre, all } kind;
  std::string title;
  std::size_t run;  // of Kind::run: its index in Comparison::runs
  ErrorSummary matched, same_time;
};

// Each run; after the last of a manoeuvre that has several the manoeuvre; where there are several manoeuvres, all.
std::vector<SummaryRow> summary_rows(const Comparison& comparison);

}  // namespace kenaf::gap::compare
