// Checks that a log is plausible: units, signs, clocks, dead sensors, poses that jump. The format cannot refuse these,
// and a diagnosis would take them for a difference between robot and simulator.
//
// A certain fault is refused, a likely one gives a warning, and of a sensor that is certainly dead only the column is
// useless. A correct log has no finding, also if the robot slips, falls, stands still or already moves in its first
// row.
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
    held,  // rows repeat a value that came more rarely: a diagnosis treats the repeats as not measured
    dead,  // the column holds no measurement: a diagnosis treats it as never measured
    refuse,
  };
  Severity severity;
  std::string file;    // as the dataset names it; "dataset.toml" if it concerns all runs
  std::size_t line;    // in the file, from 1, as read_run() counts; 0: the whole column or file
  std::string column;  // empty: no single one
  std::string text;    // what is wrong, and what to do
};

// "run-000.csv:17: x_m: jumps ..."; without a line "run-000.csv: x_m: ...".
std::string in_words(const Finding& finding);
bool any_refused(std::span<const Finding> findings);

// Collects the findings of Severity::held, which all runs of a log share: one remains for each column and says in how
// many runs.
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

// Checks one run against the limits of `robot`; null: unknown, and fewer findings are certain.
std::vector<Finding> check_run(const runs::Run& run, const std::string& file, const physics::RobotDescription* robot);

// Checks only whether the numbers of a run are in the units of its columns, as far as that shows without a robot.
std::vector<Finding> check_units(const runs::Run& run, const std::string& file);

// Checks the noise of a dataset, without check_run(). `columns_of_runs` in the order of Dataset::runs.
std::vector<Finding> check_noise(const runs::Dataset& dataset,
                                 std::span<const std::vector<std::string>> columns_of_runs);

// check_run() of all runs without a fault, and check_noise().
std::vector<Finding> check_plausibility(const runs::Dataset& dataset, std::span<const runs::Run> runs,
                                        const physics::RobotDescription* robot);

}  // namespace kenaf::gap::logs
