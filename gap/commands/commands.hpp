// The subcommands of kenaf-gap. Each function declares its command, options and action. The action throws if the input
// is invalid, with words for the user, which the program prints before it ends with status 2.
#pragma once

#include <functional>
#include <stdexcept>

namespace CLI {
class App;
}

namespace kenaf::gap {
struct Ranks;
}

namespace kenaf::gap::commands {

// Everything was done as asked, but some runs are useless: status 1.
struct RunsWentWrong : std::runtime_error {
  using std::runtime_error::runtime_error;
};

void add_challenge_command(CLI::App& program);
void add_check_command(CLI::App& program);
void add_compare_command(CLI::App& program);
void add_dataset_command(CLI::App& program);
// `ranks`: called once the command line is right; returns the processes that share the work, of which the first one
// writes and prints.
void add_diagnose_command(CLI::App& program, std::function<Ranks()> ranks);
void add_effects_command(CLI::App& program);
void add_export_command(CLI::App& program);
void add_import_command(CLI::App& program);
void add_manoeuvres_command(CLI::App& program);
void add_merge_command(CLI::App& program);
void add_play_command(CLI::App& program);
void add_score_command(CLI::App& program);
void add_simulate_command(CLI::App& program);

}  // namespace kenaf::gap::commands
