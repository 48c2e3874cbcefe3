// kenaf-gap effects: prints the catalogue of effects, or what a diagnosis of one robot looks for.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "gap/candidates/candidate.hpp"
#include "gap/commands/commands.hpp"
#include "physics/effects.hpp"

namespace kenaf::gap::commands {
namespace {

using physics::EffectInfo;
using physics::EffectParameter;

std::string as_json() {
  auto list = nlohmann::ordered_json::array();
  for (const EffectInfo& effect : physics::effect_catalogue()) {
    auto parameters = nlohmann::ordered_json::array();
    for (const EffectParameter& p : effect.parameters)
      parameters.push_back(
          {{"name", p.name}, {"unit", p.unit}, {"neutral", p.neutral}, {"min", p.min}, {"max", p.max}});
    list.push_back({{"name", effect.name},
                    {"stage", stage_name(effect.stage)},
                    {"summary", effect.summary},
                    {"parameters", std::move(parameters)}});
  }
  return list.dump(2) + "\n";
}

std::string as_text() {
  std::string text = "Switch an effect on with --effect NAME:PARAMETER=VALUE, or in a robot description.\n";
  std::string_view stage;
  for (const EffectInfo& effect : physics::effect_catalogue()) {
    if (stage != stage_name(effect.stage)) {
      stage = stage_name(effect.stage);
      text += fmt::format("\n{}\n", stage);
    }
    text += fmt::format("  {:<21} {}\n", effect.name, effect.summary);
    for (const EffectParameter& p : effect.parameters)
      text += fmt::format("  {:<21}   {} from {} to {}{}; {} changes nothing\n", "", p.name, p.min, p.max,
                          p.unit == "1" ? "" : fmt::format(" {}", p.unit), p.neutral);
  }
  return text;
}

std::string as_json(const std::vector<candidates::Candidate>& candidates) {
  auto list = nlohmann::ordered_json::array();
  for (const candidates::Candidate& c : candidates) {
    if (list.empty() || list.back()["name"] != c.effect)
      list.push_back({{"name", c.effect},
                      {"stage", stage_name(c.stage)},
                      {"summary", c.summary},
                      {"parameters", nlohmann::ordered_json::array()}});
    list.back()["parameters"].push_back(
        {{"name", c.parameter}, {"unit", c.unit}, {"neutral", c.neutral}, {"min", c.min}, {"max", c.max}});
  }
  return list.dump(2) + "\n";
}

std::string as_text(const std::vector<candidates::Candidate>& candidates, const std::string& robot) {
  std::string text = fmt::format(
      "Candidates of a diagnosis of {}: effects of the catalogue and numbers of the description.\n"
      "--without NAME leaves a candidate out.\n\n"
      "{:<34} {:<8} {:>10} {:>10} {:>10}  unit\n",
      robot, "name", "stage", "described", "from", "to");
  for (const candidates::Candidate& c : candidates)
    text += fmt::format("{:<34} {:<8} {:>10.4g} {:>10.4g} {:>10.4g}  {}\n", c.name, stage_name(c.stage), c.present,
                        c.min, c.max, c.unit);
  return text;
}

}  // namespace

void add_effects_command(CLI::App& program) {
  CLI::App* command = program.add_subcommand("effects", "lists the effects by which a robot may differ");
  struct Options {
    bool json = false;
    std::string robot;
  };
  const auto options = std::make_shared<Options>();
  command->add_option("--robot", options->robot,
                      "the candidates of a diagnosis of this robot, with their ranges: a shipped name or a TOML file");
  command->add_flag("--json", options->json, "as JSON");
  command->callback([options] {
    const auto& [json, robot] = *options;
    std::string text;
    if (robot.empty()) {
      text = json ? as_json() : as_text();
    } else {
      const bool has_obstacles = true;  // as in a world that has them
      const std::vector<candidates::Candidate> candidates =
          candidates::all_candidates(physics::load_robot(robot), has_obstacles);
      text = json ? as_json(candidates) : as_text(candidates, robot);
    }
    std::fputs(text.c_str(), stdout);
  });
}

}  // namespace kenaf::gap::commands
