// Margins of the outcomes in the published table: critical sizes of the obstacles, and for every effect the values that
// turn the simulated row into the real one. docs/table1.md shows the results.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <optional>
#include <thread>

#include "command_line/checks.hpp"
#include "command_line/parse.hpp"
#include "gap/parallel.hpp"
#include "rollout/published_experiments.hpp"

namespace {

using namespace kenaf;
using physics::EffectInfo;
using physics::EffectParameter;
using physics::RobotDescription;
using rollout::Obstacle;
using rollout::PublishedExperiment;

constexpr double kTimeStep_s = 0.001;
constexpr int kValues = 8;         // of each effect on each side of its neutral value, evenly
constexpr double kSharpness = 32;  // a boundary between two values is found to within their distance / this

// The operator of the manoeuvres sees the robot itself, not what its sensors report.
bool acts(const EffectInfo& effect) {
  return effect.stage != physics::Stage::sensor;
}

// ---- critical sizes

// Sizes in millimetres between which the outcome changes. Bisection alone would miss a second change.
struct Critical {
  int largest_passed_mm = 0, smallest_failed_mm = 0;
  bool gave_up = false;    // the operator did, at the smallest failed size
  bool one_change = true;  // on the grid, no size above a failed one passes
};

Critical critical_size(Obstacle obstacle, const RobotDescription& robot, double time_step_s, int grid_mm) {
  // Before the first attempt, the bracket is the range of sizes, one grid step wider on each side.
  const bool step = obstacle == Obstacle::step;
  const int from_mm = step ? 50 : 100, to_mm = step ? 450 : 500;
  Critical found{from_mm - grid_mm, to_mm + grid_mm};
  const auto try_at = [&](int size_mm) { return rollout::attempt(obstacle, size_mm * 1e-3, robot, time_step_s); };
  const auto set_failed = [&](int size_mm, const rollout::RollOut& attempt) {
    found.smallest_failed_mm = size_mm;
    found.gave_up = attempt.gave_up;
  };

  // The grid: the last size that passes before the first that fails.
  bool failed = false;
  for (int size_mm = from_mm; size_mm <= to_mm; size_mm += grid_mm) {
    const rollout::RollOut attempt = try_at(size_mm);
    const bool pass = attempt.succeeded;
    if (pass && !failed) found.largest_passed_mm = size_mm;
    if (!pass && !failed) set_failed(size_mm, attempt);
    found.one_change &= !(pass && failed);
    failed |= !pass;
  }

  // Bisection between these two, down to 1 mm.
  while (found.smallest_failed_mm - found.largest_passed_mm > 1) {
    const int middle_mm = (found.largest_passed_mm + found.smallest_failed_mm) / 2;
    const rollout::RollOut attempt = try_at(middle_mm);
    if (attempt.succeeded)
      found.largest_passed_mm = middle_mm;
    else
      set_failed(middle_mm, attempt);
  }
  return found;
}

// ---- effects

// Outcomes of the 12 experiments, the first one in the lowest bit.
using Row = unsigned;

Row published_row(bool PublishedExperiment::*which) {
  Row row = 0;
  const auto experiments = rollout::published_experiments();
  for (std::size_t i = 0; i < experiments.size(); ++i) row |= Row{experiments[i].*which} << i;
  return row;
}

Row row_of(const RobotDescription& robot) {
  Row row = 0;
  const auto experiments = rollout::published_experiments();
  for (std::size_t i = 0; i < experiments.size(); ++i)
    row |= Row{rollout::attempt(experiments[i].obstacle, experiments[i].size_mm * 1e-3, robot, kTimeStep_s).succeeded}
           << i;
  return row;
}

Row row_with(const EffectParameter& parameter, double value) {
  RobotDescription robot = rollout::robot_of_the_experiments();
  robot.effects.*parameter.value = value;
  return row_of(robot);
}

std::string differences(Row row, Row from) {
  std::vector<std::string> names;
  const auto experiments = rollout::published_experiments();
  for (std::size_t i = 0; i < experiments.size(); ++i)
    if ((row ^ from) >> i & 1)
      names.push_back(fmt::format("{}{}{}", row >> i & 1 ? "+" : "-",
                                  experiments[i].obstacle == Obstacle::step ? "s" : "t", experiments[i].size_mm));
  return fmt::format("{}", fmt::join(names, " "));
}

// Bisects between `without`, for which `holds` is false, and `with`, for which it is true. Returns a value close to the
// boundary for which it holds.
double boundary(double without, double with, const std::function<bool(double)>& holds) {
  const double sharp = std::abs(with - without) / kSharpness;
  while (std::abs(with - without) > sharp) {
    const double middle = (with + without) / 2;
    (holds(middle) ? with : without) = middle;
  }
  return with;
}

// One effect, from its neutral value to one end of its range.
struct Side {
  const EffectInfo* effect;
  const EffectParameter* parameter;
  double end;
  struct Interval {
    double from, to;  // the real row; `from` is nearer to neutral
  };
  std::vector<Interval> real;
  std::optional<double> first_change;  // the smallest deviation found that changes the row
  Row row_at_first_change = 0, row_at_end = 0;
};

void study(Side& side) {
  // Values of the parameter on a grid, from neutral to the end of the range.
  const Row simulated = published_row(&PublishedExperiment::simulated),
            real = published_row(&PublishedExperiment::real);
  const EffectParameter& parameter = *side.parameter;
  const auto is_real = [&](double value) { return row_with(parameter, value) == real; };
  double before = parameter.neutral;
  Row row_before = simulated;
  for (int i = 1; i <= kValues; ++i) {
    const double value = parameter.neutral + (side.end - parameter.neutral) * i / kValues;
    const Row row = row_with(parameter, value);

    // The first grid value with another row: its boundary to the one before it, with the row there.
    if (!side.first_change && row != simulated) {
      side.row_at_first_change = row;
      side.first_change = boundary(before, value, [&](double v) {
        const Row here = row_with(parameter, v);
        if (here != simulated) side.row_at_first_change = here;
        return here != simulated;
      });
    }

    // Intervals of the real row: begun, continued and ended, with boundaries between grid values.
    if (row == real && row_before != real) side.real.push_back({boundary(before, value, is_real), value});
    if (row == real) side.real.back().to = value;
    if (row != real && row_before == real) side.real.back().to = boundary(value, before, is_real);
    before = value;
    row_before = row;
  }
  side.row_at_end = row_before;
}

// ---- output

void in_parallel(std::size_t count, unsigned jobs, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> done = 0;
  gap::for_each_job(count, jobs, [&](std::size_t i) {
    work(i);
    fmt::print(stderr, "\r{} of {} ", ++done, count);
  });
  fmt::print(stderr, "\n");
}

void write_critical_sizes(const std::filesystem::path& file, unsigned jobs) {
  struct Case {
    Obstacle obstacle;
    double time_step_s;
    const EffectInfo* effect;  // null: nominal
    const EffectParameter* parameter;
    double value;
    Critical found;
  };
  std::vector<Case> cases;
  for (const Obstacle obstacle : {Obstacle::step, Obstacle::trench}) {
    for (const double time_step_s : {0.002, 0.001, 0.0005}) cases.push_back({obstacle, time_step_s, {}, {}, 0, {}});
    for (const EffectInfo& effect : physics::effect_catalogue())
      for (const EffectParameter& parameter : effect.parameters)
        for (const double end : {parameter.min, parameter.max})
          if (end != parameter.neutral && acts(effect))
            cases.push_back({obstacle, kTimeStep_s, &effect, &parameter, end, {}});
  }
  in_parallel(cases.size(), jobs, [&](std::size_t i) {
    RobotDescription robot = rollout::robot_of_the_experiments();
    if (cases[i].parameter) robot.effects.*cases[i].parameter->value = cases[i].value;
    cases[i].found = critical_size(cases[i].obstacle, robot, cases[i].time_step_s, cases[i].parameter ? 20 : 5);
  });
  std::ofstream out(file);
  out << "obstacle,time_step_s,effect,parameter,value,largest_passed_mm,smallest_failed_mm,gave_up,one_change\n";
  for (const Case& c : cases)
    out << fmt::format("{},{:g},{},{},{:g},{},{},{},{}\n", c.obstacle == Obstacle::step ? "step" : "trench",
                       c.time_step_s, c.effect ? c.effect->name : "none", c.parameter ? c.parameter->name : "", c.value,
                       c.found.largest_passed_mm, c.found.smallest_failed_mm, c.found.gave_up ? "yes" : "no",
                       c.found.one_change ? "yes" : "no");
}

void write_effects(const std::filesystem::path& file, unsigned jobs) {
  const Row simulated = published_row(&PublishedExperiment::simulated);
  if (row_of(rollout::robot_of_the_experiments()) != simulated)
    throw std::runtime_error("without effects the row is not the simulated one");
  std::vector<Side> sides;
  for (const EffectInfo& effect : physics::effect_catalogue())
    for (const EffectParameter& parameter : effect.parameters)
      for (const double end : {parameter.min, parameter.max})
        if (end != parameter.neutral && acts(effect)) sides.push_back({&effect, &parameter, end, {}, {}, 0, 0});
  in_parallel(sides.size(), jobs, [&](std::size_t i) { study(sides[i]); });
  std::ofstream out(file);
  out << "effect,parameter,unit,neutral,end,real_row,first_change,changes_there,changes_at_end\n";
  for (const Side& side : sides) {
    std::vector<std::string> real;
    for (const Side::Interval& interval : side.real)
      real.push_back(fmt::format("{:.3g} to {:.3g}", interval.from, interval.to));
    out << fmt::format("{},{},{},{:g},{:g},{},{},{},{}\n", side.effect->name, side.parameter->name,
                       side.parameter->unit, side.parameter->neutral, side.end, fmt::join(real, "; "),
                       side.first_change ? fmt::format("{:.3g}", *side.first_change) : "",
                       side.first_change ? differences(side.row_at_first_change, simulated) : "",
                       differences(side.row_at_end, simulated));
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Critical sizes of the published steps and trenches, and the influence of each effect on the table.",
               "table1-study");
  std::filesystem::path folder = "tools/studies/results";
  unsigned jobs = std::max(1u, std::thread::hardware_concurrency());
  app.add_option("--out", folder, "Folder for table1-critical.csv and table1-effects.csv")->capture_default_str();
  app.add_option("--jobs", jobs, "Threads; the results do not depend on it")
      ->check(kenaf::command_line::whole_number(1, kenaf::command_line::kMostJobs));
  if (const auto status = kenaf::command_line::parse(app, argc, argv)) return *status;
  try {
    std::filesystem::create_directories(folder);
    write_critical_sizes(folder / "table1-critical.csv", jobs);
    write_effects(folder / "table1-effects.csv", jobs);
  } catch (const std::exception& error) {
    std::cerr << "table1-study: " << error.what() << "\n";
    return 1;
  }
}
