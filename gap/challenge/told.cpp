#include "gap/challenge/told.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "runs/whole_file.hpp"

namespace kenaf::gap {
namespace {

using Json = nlohmann::ordered_json;

double number(const Json& json) {
  return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}

}  // namespace

Told told_by(const std::string& report_json) try {
  const Json json = Json::parse(report_json);
  if (json.at("format") != "kenaf-gap-report/1") throw std::runtime_error("its format is not kenaf-gap-report/1");
  Told told;
  json.at("verdict").get_to(told.verdict);
  json.at("named").get_to(told.named);
  json.at("ambiguous_sets").get_to(told.ambiguous_sets);
  for (const Json& effect : json.at("effects"))
    for (const auto& [parameter, fit] : effect.at("parameters").items())
      told.effects.push_back({effect.at("name"), parameter, number(fit.at("value")), number(fit.at("ci95").at(0)),
                              number(fit.at("ci95").at(1))});
  told.shrink = number(json.at("gap").at("shrink"));
  told.interrupted = json.contains("interrupted");
  json.at("isolability").at("effects").get_to(told.table);
  for (const Json& row : json.at("isolability").at("angle_deg")) {
    told.angle_deg.emplace_back();
    for (const Json& angle : row) told.angle_deg.back().push_back(number(angle));
    if (told.angle_deg.back().size() != told.table.size()) throw std::runtime_error("its angles are no square table");
  }
  if (told.angle_deg.size() != told.table.size()) throw std::runtime_error("its angles are no square table");
  return told;
} catch (const std::exception& error) {
  throw std::runtime_error(fmt::format("no report of a diagnosis: {}", error.what()));
}

std::optional<Told> read_told(const std::filesystem::path& report_json) {
  if (!std::filesystem::exists(report_json)) return std::nullopt;
  try {
    Told told = told_by(runs::read_whole_file(report_json));
    if (told.interrupted) return std::nullopt;
    return told;
  } catch (const std::exception& error) {
    throw std::runtime_error(fmt::format("{}: {}", report_json.string(), error.what()));
  }
}

}  // namespace kenaf::gap
