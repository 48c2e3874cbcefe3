#include "gap/challenge/read_report.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "formats/runs/whole_file.hpp"

namespace kenaf::gap::challenge {
namespace {

using Json = nlohmann::ordered_json;

// Null stands for values that JSON cannot express.
double number(const Json& json) {
  return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}

ReadTable table_of(const Json& json) {
  ReadTable table;
  json.at("effects").get_to(table.effects);
  for (const Json& row : json.at("angle_deg")) {
    table.angle_deg.emplace_back();
    for (const Json& angle : row) table.angle_deg.back().push_back(number(angle));
    if (table.angle_deg.back().size() != table.effects.size())
      throw std::runtime_error("its angles are not a square table");
  }
  if (table.angle_deg.size() != table.effects.size()) throw std::runtime_error("its angles are not a square table");
  return table;
}

// Verdict, names, sets, effects, shrink and table are at the top level in version 1, in each stage in version 2.
ReadStage stage_of(const Json& json, std::string name) {
  ReadStage stage;
  stage.stage = std::move(name);
  json.at("verdict").get_to(stage.verdict);
  json.at("named").get_to(stage.named);
  json.at("ambiguous_sets").get_to(stage.ambiguous_sets);
  for (const Json& effect : json.at("effects")) {
    const double explains = effect.contains("explains") ? number(effect["explains"]) : ReadEffect().explains;
    for (const auto& [parameter, fit] : effect.at("parameters").items())
      stage.effects.push_back({effect.at("name"), parameter, number(fit.at("value")), number(fit.at("ci95").at(0)),
                               number(fit.at("ci95").at(1)), explains});
  }
  stage.shrink = number(json.at("gap").at("shrink"));
  if (json.contains("isolability")) stage.table = table_of(json["isolability"]);
  return stage;
}

}  // namespace

ReadReport report_of(const std::string& report_json) try {
  const Json json = Json::parse(report_json);
  const bool in_stages = json.at("format") == "kenaf-gap-report/2";
  if (!in_stages && json.at("format") != "kenaf-gap-report/1")
    throw std::runtime_error("its format is neither kenaf-gap-report/1 nor kenaf-gap-report/2");
  ReadReport report;
  json.at("verdict").get_to(report.verdict);
  json.at("named").get_to(report.named);
  json.at("ambiguous_sets").get_to(report.ambiguous_sets);
  report.interrupted = json.contains("interrupted");
  if (in_stages) {
    report.complete = json.value("complete", false);
    for (const Json& stage : json.at("stages")) report.stages.push_back(stage_of(stage, stage.at("stage")));
  } else {
    report.complete = report.verdict != "unknown";  // version 1 named nothing if it could not explain the whole gap
    report.stages.push_back(stage_of(json, ""));
  }
  if (json.contains("isolability")) report.table = table_of(json["isolability"]);
  return report;
} catch (const std::exception& error) {
  throw std::runtime_error(fmt::format("is not the report of a diagnosis: {}", error.what()));
}

std::optional<ReadReport> read_report(const std::filesystem::path& report_json) {
  if (!std::filesystem::exists(report_json)) return std::nullopt;
  try {
    ReadReport report = report_of(runs::read_whole_file(report_json));
    if (report.interrupted) return std::nullopt;
    return report;
  } catch (const std::exception& error) {
    throw std::runtime_error(fmt::format("{}: {}", report_json.string(), error.what()));
  }
}

}  // namespace kenaf::gap::challenge
