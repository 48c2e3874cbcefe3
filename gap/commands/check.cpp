// kenaf-gap check: checks that a dataset, or a run file by itself, is plausible.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>

#include "gap/commands/commands.hpp"
#include "gap/logs/body_heading.hpp"
#include "gap/logs/copies.hpp"
#include "gap/logs/lifted_robot.hpp"
#include "gap/logs/other_forms.hpp"
#include "gap/logs/plausibility.hpp"
#include "gap/logs/unknown_columns.hpp"

namespace kenaf::gap::commands {
namespace {

void print(const std::vector<logs::Finding>& findings) {
  for (const logs::Finding& finding : findings)
    std::printf("%s%s\n", finding.severity != logs::Finding::Severity::refuse ? "warning: " : "",
                logs::in_words(finding).c_str());
}

bool is_run_file(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored) && path.extension() != ".toml";
}

// Checks a dataset with one run in memory at a time, or one run of `robot`. Throws if something is refused.
void check(const std::filesystem::path& asked, const std::string& robot_of_file,
           const logs::RefusedRuns& refused_runs) {
  const std::filesystem::path path = runs::folder_of_dataset(asked);
  const bool is_file = is_run_file(path);
  if (!is_file && !robot_of_file.empty())
    throw std::invalid_argument(path.string() + ": a dataset names its robot; --robot is for a run file");
  const std::filesystem::path folder = is_file ? path.parent_path() : path;
  runs::Dataset dataset;
  if (is_file) {
    dataset.robot = robot_of_file.empty() ? "kenaf" : robot_of_file;
    dataset.runs.push_back({path.filename().string(), "", ""});
  } else {
    dataset = runs::read_dataset(folder);
  }
  const physics::RobotDescription robot =
      physics::load_robot(is_file ? dataset.robot : runs::resolve_beside(folder, dataset.robot, ".toml"));

  // Findings are printed and counted as they come.
  std::vector<std::vector<std::string>> columns;
  std::size_t refused = 0, warned = 0, runs_refused = 0;
  logs::KnownRuns known_runs;
  logs::HeldInRuns held;
  logs::LiftedRobot lifted;
  logs::BodyHeading heading;
  logs::OtherForms forms;
  logs::UnknownColumns unknown;
  const auto take = [&](const std::vector<logs::Finding>& findings) {
    print(findings);
    for (const logs::Finding& finding : findings)
      ++(finding.severity == logs::Finding::Severity::refuse ? refused : warned);
  };

  // Each run by itself; copies even of runs with a fault.
  for (const runs::DatasetRun& entry : dataset.runs) {
    std::vector<logs::Finding> found;
    const std::optional<runs::Run> run =
        is_file ? std::optional(runs::read_run(path)) : logs::read_or_refuse(folder / entry.file, entry.file, found);
    if (!run) {
      take(found);
      ++runs_refused;
      continue;
    }
    columns.push_back(run->columns);
    forms.look_at(*run, entry.file);
    unknown.look_at(*run, entry.file);
    if (const auto copy = known_runs.copy(*run, entry.file)) take({*copy});
    if (!entry.fault.empty()) continue;
    found = logs::check_run(*run, entry.file, &robot);
    held.take_off(found);
    take(found);
    if (logs::any_refused(found))
      ++runs_refused;
    else
      heading.look_at(*run);
    lifted.look_at(*run, robot.track_gauge_m());
  }

  // Findings over all runs.
  take(forms.findings());
  take(unknown.findings());
  take(held.findings());
  if (const auto of_heading = heading.findings(); !of_heading.empty()) {
    take(of_heading);
    if (logs::any_refused(of_heading)) runs_refused = dataset.runs.size();
  }
  if (const auto finding = lifted.finding()) take({*finding});
  take(logs::check_noise(dataset, columns));

  const std::string counts =
      fmt::format("{} runs; findings: {} refused, {} warned of", dataset.runs.size(), refused, warned);
  if (refused_runs.too_many(runs_refused, dataset.runs.size()))
    throw std::runtime_error(fmt::format("{}: {}", path.string(), counts));
  std::printf("%s\n", counts.c_str());
  if (runs_refused > 0)
    std::printf("a diagnosis leaves %zu of %zu runs out; with --strict they refuse the dataset\n", runs_refused,
                dataset.runs.size());
}

}  // namespace

void add_check_command(CLI::App& program) {
  const auto path = std::make_shared<std::string>(), robot = std::make_shared<std::string>();
  CLI::App* command =
      program.add_subcommand("check", "checks a dataset or a run for wrong units, signs, clocks and dead sensors");
  command->add_option("DATASET", *path, "the dataset, a folder, or a run, a CSV file; required")->type_name("");
  command->add_option("--robot", *robot, "the robot of a run: a shipped name or a TOML file [kenaf]");
  const auto refused_runs = std::make_shared<logs::RefusedRuns>();
  command->add_flag("--strict", refused_runs->strict,
                    "one refused run refuses the dataset; otherwise more than a tenth of the runs do");
  command->callback([path, robot, refused_runs] {
    if (path->empty()) throw CLI::RequiredError("DATASET");
    check(*path, *robot, *refused_runs);
  });
}

}  // namespace kenaf::gap::commands
