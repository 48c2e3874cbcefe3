// kenaf-gap dataset: makes a dataset of recorded runs.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>

#include "command_line/checks.hpp"
#include "gap/commands/commands.hpp"
#include "gap/datasets/collect.hpp"

namespace kenaf::gap::commands {
namespace {

// Parses "FILE", or "NAME=FILE" with a manoeuvre of its own. A file whose name has a '=' is a file.
datasets::RecordedRun run_from(const std::string& text, const std::string& manoeuvre) {
  const std::size_t equals = text.find('=');
  if (equals == text.npos || std::filesystem::exists(text)) {
    if (manoeuvre.empty())
      throw std::invalid_argument(
          fmt::format("{}: its manoeuvre is unknown; give --manoeuvre, or NAME={}", text, text));
    return {text, manoeuvre};
  }
  if (equals == 0) throw std::invalid_argument(fmt::format("{}: the manoeuvre before the '=' has no name", text));
  return {text.substr(equals + 1), text.substr(0, equals)};
}

}  // namespace

void add_dataset_command(CLI::App& program) {
  struct Options {
    std::vector<std::string> runs;
    std::string manoeuvre;
    datasets::CollectRequest request;
  };
  // Shared with the callback, which runs after this function has returned.
  const auto options = std::make_shared<Options>();
  datasets::CollectRequest& request = options->request;
  CLI::App* command = program.add_subcommand("dataset", "makes a dataset from recorded runs, or adds runs to one");
  command
      ->add_option("RUN", options->runs, "the runs, CSV files; MANOEUVRE=FILE for a run of another manoeuvre; required")
      ->type_name("...");
  command->add_option("--manoeuvre", options->manoeuvre, "manoeuvre of the runs that are given without one")
      ->type_name("NAME");
  command->add_option("--out", request.out, "folder of the dataset, to create or extend; required")->type_name("DIR");
  command->add_option("--robot", request.robot, "a shipped name or a TOML file [kenaf, or the dataset's]");
  command->add_option("--world", request.world, "a shipped name or an SDF file [each shipped manoeuvre's own]");
  command->add_option("--source", request.source, "real or sim")
      ->check(command_line::one_of({"real", "sim"}))
      ->type_name("SOURCE")
      ->capture_default_str();
  command->add_option("--description", request.description, "free text, for a new dataset");
  command->add_flag("--unwrap", request.unwrap, "write the travel of tracks whose counter wraps without its jumps");
  command->add_flag("--unchecked", request.refused_runs.unchecked, "also accept runs that the checks refuse");
  command->add_flag("--strict", request.refused_runs.strict,
                    "write nothing if a run is refused; otherwise up to a tenth of the runs are left out");

  command->callback([options] {
    datasets::CollectRequest& asked = options->request;
    if (options->runs.empty()) throw CLI::RequiredError("RUN");
    if (asked.out.empty()) throw CLI::RequiredError("--out");

    // Collects the runs, prints all findings, and fails if one refuses a run.
    asked.runs.clear();
    for (const std::string& text : options->runs) asked.runs.push_back(run_from(text, options->manoeuvre));
    const datasets::CollectedDataset result = datasets::collect_dataset(asked);
    for (const logs::Finding& finding : result.findings)
      std::fprintf(stderr, "kenaf-gap: %s%s\n", finding.severity != logs::Finding::Severity::refuse ? "warning: " : "",
                   logs::in_words(finding).c_str());
    if (result.refused)
      throw std::runtime_error("nothing was written; if a run is right nevertheless, give --unchecked");

    for (const std::string& done : result.changed) std::printf("%s\n", done.c_str());
    for (std::size_t i = 0; i < result.runs.size(); ++i)
      std::printf("%s: %s, from %s\n", result.runs[i].file.c_str(), result.runs[i].manoeuvre.c_str(),
                  asked.runs[result.added[i]].file.c_str());
    for (std::size_t i = 0; i < asked.runs.size(); ++i)
      if (std::ranges::find(result.added, i) == result.added.end())
        std::printf("%s: left out, as it is refused\n", asked.runs[i].file.c_str());
    std::printf("%s: %zu runs %s\n", asked.out.c_str(), result.runs.size(),
                result.extended ? "added" : "in a new dataset");
  });
}

}  // namespace kenaf::gap::commands
