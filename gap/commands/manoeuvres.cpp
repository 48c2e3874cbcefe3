// kenaf-gap manoeuvres: lists the shipped manoeuvres.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "gap/commands/commands.hpp"
#include "rollout/manoeuvre.hpp"

namespace kenaf::gap::commands {
namespace {

std::string as_json(const std::vector<rollout::Manoeuvre>& manoeuvres) {
  auto list = nlohmann::ordered_json::array();
  for (const rollout::Manoeuvre& manoeuvre : manoeuvres)
    list.push_back({{"name", manoeuvre.name},
                    {"world", manoeuvre.world},
                    {"duration_s", manoeuvre.at_most_s()},
                    {"summary", manoeuvre.summary}});
  return list.dump(2) + "\n";
}

std::string as_text(const std::vector<rollout::Manoeuvre>& manoeuvres) {
  std::string text = fmt::format("{:<19} {:<12} {:>9}\n", "name", "world", "at most");
  for (const rollout::Manoeuvre& manoeuvre : manoeuvres)
    text += fmt::format("{:<19} {:<12} {:>7.1f} s  {}\n", manoeuvre.name, manoeuvre.world, manoeuvre.at_most_s(),
                        manoeuvre.summary);
  return text;
}

}  // namespace

void add_manoeuvres_command(CLI::App& program) {
  CLI::App* command = program.add_subcommand("manoeuvres", "lists the shipped manoeuvres");
  const auto json = std::make_shared<bool>(false);
  command->add_flag("--json", *json, "as JSON");
  command->callback([json] {
    const auto manoeuvres = rollout::shipped_manoeuvres();
    std::fputs((*json ? as_json(manoeuvres) : as_text(manoeuvres)).c_str(), stdout);
  });
}

}  // namespace kenaf::gap::commands
