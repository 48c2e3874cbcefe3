// kenaf-gap compare: compares two datasets run by run.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>

#include "gap/commands/commands.hpp"
#include "gap/commands/option_checks.hpp"
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
  command->add_option("REAL", options->real, "the dataset that is compared with, a folder; required")->type_name("");
  command->add_option("SIM", options->sim, "the dataset that is compared, a folder; required")->type_name("");
  command->add_option("--out", options->out, "folder for compare.html, compare.json and matched-NNN.csv; required")
      ->type_name("DIR");
  command->add_flag_callback(
      "--no-align-start", [options] { options->compare.align_start = false; },
      "compare runs where they were recorded; else each simulated one is moved to its real one's start, in x, y, yaw");
  command
      ->add_option("--start", options->compare.start_s, "the start is the mean over this time; 0: the first frame [0]")
      ->check(number_in(0, 1e6))
      ->type_name("SECONDS");
  command
      ->add_option("--band", options->compare.band_s,
                   "match no frames that are farther than this from an even course of time")
      ->check(number_in(1e-3, 1e9))
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
