// kenaf-gap: measures how far simulation and reality differ, and finds out why.
//
//   kenaf-gap effects
//   kenaf-gap compare REAL SIM --out DIR
//   kenaf-gap --help
//
// Exit status: 0 done; 1 done except for runs whose simulation went wrong; 2 bad input, or the output cannot be
// written, with the error and its place on standard error.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <stdexcept>

#include "command_line/parse.hpp"
#include "gap/commands/commands.hpp"
#include "gap/commands/progress_line.hpp"
#include "gap/ranks.hpp"

namespace {

constexpr int kWentWrong = 1, kBadInput = 2;

constexpr void (*kCommands[])(CLI::App&) = {
    kenaf::gap::commands::add_challenge_command,
    kenaf::gap::commands::add_check_command,
    kenaf::gap::commands::add_compare_command,
    kenaf::gap::commands::add_dataset_command,
    [](CLI::App& program) { kenaf::gap::commands::add_diagnose_command(program, [] { return kenaf::gap::Ranks{}; }); },
    kenaf::gap::commands::add_effects_command,
    kenaf::gap::commands::add_export_command,
    kenaf::gap::commands::add_import_command,
    kenaf::gap::commands::add_manoeuvres_command,
    kenaf::gap::commands::add_merge_command,
    kenaf::gap::commands::add_play_command,
    kenaf::gap::commands::add_score_command,
    kenaf::gap::commands::add_simulate_command,
};

// Throws if the output could not be written, as on a full disk.
void finish_output() {
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
    throw std::runtime_error("standard output cannot be written; is its disk full?");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App program{"Measures the gap between simulation and reality, and names its causes.", "kenaf-gap"};
  program.require_subcommand(1);
  for (const auto add : kCommands) add(program);
  try {
    if (const auto status = kenaf::command_line::parse(program, argc, argv)) return *status;
    finish_output();
  } catch (const kenaf::gap::commands::RunsWentWrong& error) {
    kenaf::gap::commands::clear_progress_line();
    std::fprintf(stderr, "kenaf-gap: %s\n", error.what());
    return kWentWrong;
  } catch (const std::exception& error) {
    kenaf::gap::commands::clear_progress_line();
    std::fprintf(stderr, "kenaf-gap: %s\n", error.what());
    return kBadInput;
  }
  return 0;
}
