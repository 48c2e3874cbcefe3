// kenaf-gap effects: the catalogue of effects.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "gap/commands.hpp"
#include "physics/effects.hpp"

namespace kenaf::gap {
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
  std::string text = "An effect is switched on with --effect NAME:PARAMETER=VALUE, or in a robot description.\n";
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

}  // namespace

void add_effects_command(CLI::App& program) {
  CLI::App* command = program.add_subcommand("effects", "lists the effects by which a robot may differ");
  const auto json = std::make_shared<bool>(false);
  command->add_flag("--json", *json, "as JSON");
  command->callback([json] { std::fputs((*json ? as_json() : as_text()).c_str(), stdout); });
}

}  // namespace kenaf::gap
