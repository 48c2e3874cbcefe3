// Reads the scored parts of a report.json.
//
// Thread safety: values and pure functions.
#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace kenaf::gap::challenge {

struct ReadEffect {
  std::string effect, parameter;
  double value = 0, from = 0, to = 0;                          // its 95 % interval
  double explains = std::numeric_limits<double>::quiet_NaN();  // share of the stage's squared gap
};

// The isolability table.
struct ReadTable {
  std::vector<std::string> effects;
  std::vector<std::vector<double>> angle_deg;
};

struct ReadStage {
  std::string stage;    // "command to drive"; empty for a report of version 1, which has all stages as one
  std::string verdict;  // "none", "named", "ambiguous", "unknown"
  std::vector<std::string> named;
  std::vector<std::vector<std::string>> ambiguous_sets;
  std::vector<ReadEffect> effects;
  double shrink = std::numeric_limits<double>::quiet_NaN();  // on held-out runs
  ReadTable table{};
};

struct ReadReport {
  std::string verdict;
  std::vector<std::string> named;                        // of all stages together
  std::vector<std::vector<std::string>> ambiguous_sets;  // likewise
  bool complete = false;
  std::vector<ReadStage> stages;
  bool interrupted = false;  // then its verdict does not count
  ReadTable table;           // of the stage that holds most of the gap
};

// Throws std::runtime_error with words for the user if it has neither format kenaf-gap-report/1 nor
// kenaf-gap-report/2.
ReadReport report_of(const std::string& report_json);
// Empty if there is no such file, as after a failed diagnosis, or an interrupted one wrote it.
std::optional<ReadReport> read_report(const std::filesystem::path& report_json);

}  // namespace kenaf::gap::challenge
