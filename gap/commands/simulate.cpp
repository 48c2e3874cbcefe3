// kenaf-gap simulate: simulates runs and writes them as a dataset.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <memory>

#include "command_line/checks.hpp"
#include "gap/commands/commands.hpp"
#include "gap/datasets/physics_settings.hpp"
#include "gap/datasets/simulate.hpp"

namespace kenaf::gap::commands {
namespace {

constexpr std::uint64_t kMostRepeats = 100000;

// Throws RunsWentWrong if a run has a fault.
void print(const datasets::SimulatedDataset& dataset) {
  std::size_t faults = 0;
  for (const std::string& warning : dataset.warnings)
    std::fprintf(stderr, "kenaf-gap: warning: not simulated: %s\n", warning.c_str());
  for (const datasets::SimulatedRun& run : dataset.runs) {
    const char* outcome = !run.fault.empty() ? ", failed"
                          : !run.succeeded   ? ""
                          : *run.succeeded   ? ", done"
                                             : ", not done";
    std::printf("%s: %s, %.2f s%s%s\n", run.file.c_str(), run.manoeuvre.c_str(), run.duration_s, outcome,
                run.gave_up ? ", abandoned" : "");
    if (run.fault.empty()) continue;
    ++faults;
    std::fprintf(stderr, "kenaf-gap: %s: the simulation failed: %s\n", run.file.c_str(), run.fault.c_str());
  }
  if (faults > 0)
    throw RunsWentWrong(
        fmt::format("{} of {} runs ended early; the dataset is written and marks each of them with its fault. Check "
                    "the robot, the effects and the physics settings",
                    faults, dataset.runs.size()));
}

}  // namespace

void add_simulate_command(CLI::App& program) {
  CLI::App* command = program.add_subcommand("simulate", "drives manoeuvres in simulation and writes a run dataset");
  struct Options {
    datasets::SimulationRequest request;
    std::vector<std::string> physics;
  };
  // Shared with the callback, which runs after this function has returned. Options that may be repeated take one word
  // each time.
  const auto options = std::make_shared<Options>();
  datasets::SimulationRequest& request = options->request;
  const auto one_word_each = [](CLI::Option* option, const char* type) {
    option->expected(1)->take_all()->allow_extra_args(false)->type_name(type);
    return option;
  };
  command->add_option("--robot", request.robot, "a shipped name or a TOML file")->capture_default_str();
  command->add_option("--world", request.world, "a shipped name or an SDF file [each manoeuvre's own]");
  one_word_each(command->add_option(
                    "--manoeuvre", request.manoeuvres,
                    "a shipped name, a TOML file, replay:FILE.csv or replay-measured:FILE.csv; required, may be given "
                    "several times"),
                "M");
  one_word_each(command->add_option("--effect", request.effects, "switches an effect on; may be given several times"),
                "NAME:PARAMETER=VALUE");
  one_word_each(command->add_option("--physics", options->physics,
                                    "time_step_s, solver_iterations, contact_stiffness_npm or contact_damping_nspm"),
                "KEY=VALUE");
  command->add_option("--repeats", request.repeats, "runs of each manoeuvre")
      ->check(command_line::whole_number(0, kMostRepeats))
      ->capture_default_str();
  command->add_option("--noise", request.noise_scale, "factor of the noise of all sensors; 0: none")
      ->check(command_line::number_in(0, datasets::kLargestScale))
      ->capture_default_str();
  command
      ->add_option("--scatter", request.scatter_scale,
                   "factor of the scatter of start poses; 1: 5 mm in x and y, 0.01 rad in yaw; 0: none")
      ->check(command_line::number_in(0, datasets::kLargestScale))
      ->capture_default_str();
  command->add_option("--seed", request.seed, "seed of noise and scatter")
      ->check(command_line::whole_number(0, std::numeric_limits<std::uint64_t>::max()))
      ->capture_default_str();
  command->add_option("--jobs", request.jobs, "threads; 0: one per core")
      ->check(command_line::whole_number(0, command_line::kMostJobs))
      ->capture_default_str();
  command->add_option("--out", request.out, "folder of the dataset, which must be empty or absent; required")
      ->type_name("DIR");
  command->add_flag("--force", request.force, "write into a folder that is not empty; replaces files of the same name");

  command->callback([options] {
    if (options->request.manoeuvres.empty()) throw CLI::RequiredError("--manoeuvre");
    if (options->request.out.empty()) throw CLI::RequiredError("--out");
    for (const std::string& assignment : options->physics) datasets::set_physics(options->request.physics, assignment);
    print(datasets::simulate_dataset(options->request));
  });
}

}  // namespace kenaf::gap::commands
