// kenaf-gap: how far simulation and reality are apart, and why.
//
//   kenaf-gap effects
//   kenaf-gap compare REAL SIM --out DIR
//   kenaf-gap --help
//
// Exit status: 0 done, 1 done but for runs whose simulation went wrong, 2 bad input, with what is wrong and where on
// standard error.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "gap/commands.hpp"

namespace {

constexpr int kWentWrong = 1, kBadInput = 2;

constexpr void (*kCommands[])(CLI::App&) = {
    kenaf::gap::add_compare_command,
    kenaf::gap::add_effects_command,
    kenaf::gap::add_manoeuvres_command,
    kenaf::gap::add_simulate_command,
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App program{"How far are simulation and reality apart, and why?"};
  program.require_subcommand(0, 1);  // required, but CLI11 would not say which word it did not know
  for (const auto add : kCommands) add(program);
  try {
    program.parse(argc, argv);
    if (program.get_subcommands().empty()) throw CLI::RequiredError("A subcommand");
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? 0 : kBadInput;
  } catch (const kenaf::gap::RunsWentWrong& error) {
    std::fprintf(stderr, "kenaf-gap: %s\n", error.what());
    return kWentWrong;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "kenaf-gap: %s\n", error.what());
    return kBadInput;
  }
  return 0;
}
