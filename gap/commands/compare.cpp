// kenaf-gap compare: compares two datasets run by run.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>

#include "command_line/checks.hpp"
#include "gap/commands/commands.hpp"
#include "gap/compare/report.hpp"

namespace kenaf::gap::commands {

void add_compare_command(CLI::App& program) {
  struct Options {
    std::string real, sim, out;
    compare::CompareOptions compare;
  };
  // Shared with the callback, which runs after this function has returned.
  const auto options = std::make_shared<Options>();
  CLI::App* command =
      program.add_subcommand("compare", "aligns two datasets run by run and reports the errors per frame");
  command->add_option("REAL", options->real, "the reference dataset, a folder; required")->type_name("");
  command->add_option("SIM", options->sim, "the dataset to compare with it, a folder; required")->type_name("");
  command->add_option("--out", options->out, "folder for compare.html, compare.json and matched-NNN.csv; required")
      ->type_name("DIR");
  command->add_flag_callback(
      "--no-align-start", [options] { options->compare.align_start = false; },
      "keep the recorded starts; otherwise each simulated run is moved to the start of its real run, in x, y and yaw");
  command->add_option("--start", options->compare.start_s, "average the start over this time; 0: the first frame [0]")
      ->check(command_line::number_in(0, 1e6))
      ->type_name("SECONDS");
  command
      ->add_option("--band", options->compare.band_s,
                   "largest deviation of matched frames from uniform time, in seconds")
      ->check(command_line::number_in(1e-3, 1e9))
      ->type_name("SECONDS");

  command->callback([options] {
    for (const auto& [name, text] :
         {std::pair{"REAL", &options->real}, {"SIM", &options->sim}, {"--out", &options->out}})
      if (text->empty()) throw CLI::RequiredError(name);
    const compare::Comparison comparison = compare::compare_datasets(options->real, options->sim, options->compare);
    compare::write_report(comparison, options->out);
    std::printf("%s\n%s\n", compare::comparison_text(comparison).c_str(),
                (options->out + "/compare.html has the figures").c_str());
  });
}

}  // namespace kenaf::gap::commands
