// kenaf-gap diagnose: where simulation and runs differ, which effect causes it, how far the gap shrinks with it.
#include <CLI/CLI.hpp>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <limits>
#include <memory>
#include <utility>

#include "command_line/checks.hpp"
#include "gap/commands/commands.hpp"
#include "gap/commands/interrupt.hpp"
#include "gap/commands/progress_line.hpp"
#include "gap/commands/report_curves.hpp"
#include "gap/datasets/dataset_files.hpp"
#include "gap/diagnose/report.hpp"

namespace kenaf::gap::commands {

void add_diagnose_command(CLI::App& program, std::function<Ranks()> ranks) {
  struct Options {
    std::string dataset, out;
    bool curves = false;
    diagnose::DiagnosisOptions diagnosis;
  };
  // Shared with the callback, which runs after this function has returned.
  const auto options = std::make_shared<Options>();
  diagnose::DiagnosisOptions& diagnosis = options->diagnosis;
  CLI::App* command =
      program.add_subcommand("diagnose", "names the effects that cause the gap between simulation and runs");
  command->add_option("DATASET", options->dataset, "the runs, a folder; required")->type_name("");
  command->add_option("--out", options->out, "folder for report.json, report.html and the corrected robot; required")
      ->type_name("DIR");
  command->add_flag("--curves", options->curves,
                    "also write curves.mcap: the page's measured, nominal and corrected runs, for PlotJuggler and "
                    "Foxglove");
  command
      ->add_option("--against", diagnosis.against,
                   "an earlier dataset of the same manoeuvres: names the changes since then")
      ->type_name("BASELINE");
  command->add_option("--robot", diagnosis.robot, "a shipped name or a TOML file [the dataset's]");
  command->add_option("--world", diagnosis.world, "a shipped name or an SDF file, for all runs [each run's own]");
  command->add_option("--effects", diagnosis.effects, "a TOML file with effects of your own, to search for in addition")
      ->type_name("FILE");
  command
      ->add_option("--without", diagnosis.without, "effects to leave out of the search, by name, separated by commas")
      ->delimiter(',')
      ->type_name("EFFECT");
  command->add_flag("--unchecked", diagnosis.refused_runs.unchecked, "also use runs that the checks refuse");
  command->add_flag("--strict", diagnosis.refused_runs.strict,
                    "end if a run is refused; otherwise up to a tenth of the runs are left out");
  command->add_flag_callback(
      "--no-next", [&diagnosis] { diagnosis.propose_next = false; },
      "do not propose the next manoeuvre, which needs further simulations");
  command->add_option("--jobs", diagnosis.jobs, "threads; 0: one per core")
      ->check(command_line::whole_number(0, command_line::kMostJobs))
      ->capture_default_str();
  command->add_option("--seed", diagnosis.seed, "of resampling")
      ->check(command_line::whole_number(0, std::numeric_limits<std::uint64_t>::max()))
      ->capture_default_str();

  command->callback([options, ranks = std::move(ranks)] {
    for (const auto& [name, text] : {std::pair{"DATASET", &options->dataset}, {"--out", &options->out}})
      if (text->empty()) throw CLI::RequiredError(name);
    options->diagnosis.ranks = ranks();

    // Only the first of several processes reports. It checks where it will write before anything long starts.
    options->diagnosis.stop = &interruption();
    const bool reports = options->diagnosis.ranks.rank == 0;
    if (reports)
      options->diagnosis.progress = [line = ProgressLine()](const diagnose::Progress& progress) mutable {
        line.show(progress.doing, progress.done);
      };
    if (reports) {
      datasets::check_can_write(options->out);
      diagnose::check_keeps_inputs(options->out, options->dataset, options->diagnosis);
    }

    const diagnose::Diagnosis result = diagnose::diagnose_dataset(options->dataset, options->diagnosis);
    if (!reports) return;
    if (!result.interrupted.empty()) clear_progress_line();
    std::fputs(diagnose::diagnosis_text(result).c_str(), stdout);
    std::printf("\nThe report is in %s\n", diagnose::write_diagnosis(result, options->out).c_str());
    if (!options->curves) return;
    const std::filesystem::path curves = std::filesystem::path(options->out) / diagnose::kCurvesFile;
    write_report_curves(result, curves);
    std::printf("The curves are in %s\n", curves.c_str());
  });
}

}  // namespace kenaf::gap::commands
