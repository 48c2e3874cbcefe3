// What a report.json tells, as far as it is scored.
// Thread safety: values and pure functions.
#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace kenaf::gap {

struct ToldEffect {
  std::string effect, parameter;
  double value = 0, from = 0, to = 0;  // its 95 % interval
};

struct Told {
  std::string verdict;  // "none", "named", "ambiguous", "unknown"
  std::vector<std::string> named;
  std::vector<std::vector<std::string>> ambiguous_sets;
  std::vector<ToldEffect> effects;
  double shrink = std::numeric_limits<double>::quiet_NaN();  // on held-out runs
  bool interrupted = false;                                  // then its verdict is none that counts
  // The isolability table.
  std::vector<std::string> table;
  std::vector<std::vector<double>> angle_deg;
};

// Throws std::runtime_error in words where it is none of the format kenaf-gap-report/1.
Told told_by(const std::string& report_json);
// Nothing where there is no such file, as of a diagnosis that failed, or it is what an interrupted one left.
std::optional<Told> read_told(const std::filesystem::path& report_json);

}  // namespace kenaf::gap
