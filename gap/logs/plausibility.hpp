// Is a log what it says it is? Units, signs, clocks, sensors that are dead, poses that jump: what the format cannot
// refuse and a diagnosis would take for a difference between robot and simulator.
//
// What is certain is refused, what is likely is warned of, and of a sensor that is certainly dead the column alone is
// no use; a log that is right has no finding. A robot that slips, falls or stands still is right, and so is one that
// already moves in its first row.
//
// Thread safety: pure functions.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "formats/runs/dataset.hpp"
#include "formats/runs/run_file.hpp"
#include "physics/robot_description.hpp"

namespace kenaf::gap::logs {

struct Finding {
  enum class Severity {
    warn,
    held,  // rows repeat a value that came more rarely: a diagnosis takes the repeats for rows in which nothing was
           // measured
    dead,  // the column holds no measurement: a diagnosis takes it for one that was never measured
    refuse,
  };
  Severity severity;
  std::string file;    // as the dataset names it; "dataset.toml" where it is of all runs
  std::size_t line;    // of the file, from 1, as read_run() counts; 0: of the whole column or file
  std::string column;  // empty: of none alone
  std::string text;    // what is wrong, and what to do
};

// "run-000.csv:17: x_m: jumps ..."; without a line "run-000.csv: x_m: ...".
std::string in_words(const Finding& finding);
bool any_refused(std::span<const Finding> findings);

// Takes those of Severity::held off what was found in a run, since all runs of a log have the same: one remains of each
// column, which says in how many runs.
class HeldInRuns {
 public:
  void take_off(std::vector<Finding>& found);
  std::vector<Finding> findings() const;

 private:
  struct OfColumn {
    Finding first;
    std::size_t runs;
  };
  std::vector<OfColumn> columns_;
};

// Of one run. `robot`: whose limits it has; null: not known, and fewer things are certain.
std::vector<Finding> check_run(const runs::Run& run, const std::string& file, const physics::RobotDescription* robot);

// Of one run, only whether its numbers are in the units that its columns say, as far as that shows without a robot.
std::vector<Finding> check_units(const runs::Run& run, const std::string& file);

// Of a dataset as a whole: its noise. `runs` as Dataset::runs lists them. Without those of check_run().
std::vector<Finding> check_noise(const runs::Dataset& dataset,
                                 std::span<const std::vector<std::string>> columns_of_runs);

// Both, of all runs but those with a fault.
std::vector<Finding> check_plausibility(const runs::Dataset& dataset, std::span<const runs::Run> runs,
                                        const physics::RobotDescription* robot);

}  // namespace kenaf::gap::logs
