// Checks that a log is plausible: units, signs, clocks, dead sensors, poses that jump. The format cannot refuse these,
// and a diagnosis would take them for a difference between robot and simulator.
//
// A certain fault is refused, a likely one gives a warning, and of a sensor that is certainly dead only the column is
// useless. A correct log has no finding, also if the robot slips, falls, stands still or already moves in its first
// row: the shipped manoeuvres, three of them with each effect at the ends of its range, and 120 runs of a real robot
// have none.
//
// Units and signs are judged where two quantities go together (correlation of their mean rates over 0.2 s at least 0.8)
// and differ by more than slip and gears explain: 20 times for lengths, 15 for angles. Smaller factors are judged where
// both go in proportion (scale_factor.hpp, is_certain()): travel over speed of a track beyond 0.8 to 1.25, yaw over
// gyro beyond 1.5 times, commands over speeds of both tracks beyond 2.1 times, and below that only if the drives follow
// in proportion or the factor is a unit's; the pose's path on level ground over the tracks' beyond 0.4 to 1.5; turns
// over those of belts without slip beyond 0.08 to 1.5. Factors that are far beyond, or a unit's, are refused, others
// warned of. The column that others contradict is named, or both. Euler angles count only within 1 rad of upright. A
// pose's sign against the tracks is refused if it is wrong on level ground too (roll and pitch below 0.1 rad, where
// measured) and the pose goes 0.5 to 1.25 times as far (yaw: 0.15 to 1.25 times, by the robot's gauge). A yaw that
// never changes is refused if the gyro, or without one the tracks, show a turn. A live sensor in whole counts is not
// taken for a held one: it changes in each row while its quantity moves by more than four counts. A run that no
// simulation can repeat (rollout::replay_of()) is refused, too.
//
// Thread safety: pure functions.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
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

// Says what to do with runs that a finding refuses.
struct RefusedRuns {
  bool unchecked = false;  // take them nevertheless, findings are warnings
  bool strict = false;     // let one refuse the whole dataset
  // Whether `refused` of `all` runs refuse the dataset: more than a tenth of them (chosen), or one if strict. Fewer are
  // left out: in a hundred runs one always has something.
  bool too_many(std::size_t refused, std::size_t all) const;
};

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

// Reads a run. One that cannot be read is one more finding that refuses it, so that the checks of the others go on.
std::optional<runs::Run> read_or_refuse(const std::filesystem::path& path, const std::string& file,
                                        std::vector<Finding>& findings);

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
