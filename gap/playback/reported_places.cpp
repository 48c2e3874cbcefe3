#include "gap/playback/reported_places.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

namespace kenaf::gap::playback {
namespace {

using PlacesJson = nlohmann::json;

double share_in(const PlacesJson& json) {
  const double share = json.is_null() ? 0 : json.get<double>();
  return std::isfinite(share) ? std::clamp(share, 0.0, 1.0) : 0;
}

// Adds those that are known and not there yet. A channel that several stages compare has one noise, but the gyro's
// differences from the pose are of the last stage alone.
void add_floors(std::map<std::string, double>& floors, const PlacesJson& where) {
  for (const PlacesJson& channel : where.at("channels")) {
    const auto floor = channel.find("floor");
    if (floor == channel.end() || !floor->is_number()) continue;
    const auto value = floor->get<double>();
    if (value > 0 && std::isfinite(value)) floors.try_emplace(channel.at("channel").get<std::string>(), value);
  }
}

void add_worst(std::map<std::string, ReportedWorst>& worst_of_run, const std::string& run, const PlacesJson& worst) {
  if (!worst.at("at_s").is_number() || !worst.at("times_noise").is_number()) return;
  const ReportedWorst reported{worst.at("at_s"), worst.at("times_noise")};
  if (reported.at_s >= 0 && reported.times_noise >= 0 && std::isfinite(reported.at_s + reported.times_noise))
    worst_of_run[run] = reported;
}

ReportedPhase phase_in(const PlacesJson& json) {
  ReportedPhase phase{json.at("manoeuvre"), json.at("phase"), json.value("run", ""),
                      json.at("from_s"),    json.at("to_s"),  share_in(json.at("share"))};
  if (!(phase.from_s >= 0) || !(phase.to_s >= phase.from_s) || !std::isfinite(phase.to_s))
    throw std::runtime_error(
        fmt::format("phase '{}' goes from {} s to {} s; is the file damaged?", phase.phase, phase.from_s, phase.to_s));
  return phase;
}

}  // namespace

ReportedPlaces parse_reported_places(std::string_view report_json) try {
  const PlacesJson json = PlacesJson::parse(report_json);
  const std::string format = json.at("format");
  if (format != "kenaf-gap-report/1" && format != "kenaf-gap-report/2")
    throw std::runtime_error("its format is neither kenaf-gap-report/1 nor kenaf-gap-report/2");
  ReportedPlaces places;
  json.at("verdict").get_to(places.verdict);
  json.at("named").get_to(places.named);
  const PlacesJson& where = json.at("where");
  if (const auto stage = where.find("stage"); stage != where.end() && stage->is_string()) stage->get_to(places.stage);
  for (const PlacesJson& phase : where.at("phases")) places.phases.push_back(phase_in(phase));
  for (const PlacesJson& channel : where.at("channels"))
    places.channel_share[channel.at("channel")] = share_in(channel.at("share"));
  if (const auto stages = json.find("stages"); stages != json.end())
    for (const PlacesJson& stage : *stages)
      if (const auto of_stage = stage.find("where"); of_stage != stage.end())
        add_floors(places.channel_floor, *of_stage);
  add_floors(places.channel_floor, where);
  if (const auto runs = json.find("runs"); runs != json.end())
    for (const PlacesJson& run : *runs)
      if (const auto worst = run.find("worst"); worst != run.end() && worst->is_object())
        add_worst(places.worst_of_run, run.at("run"), *worst);
  return places;
} catch (const std::exception& error) {
  throw std::runtime_error(fmt::format("is not the report of a diagnosis: {}", error.what()));
}

std::vector<ReportedPhase> phases_of_run(const ReportedPlaces& places, const std::string& file,
                                         const std::string& manoeuvre,
                                         const std::map<std::string, std::string>& world_of) {
  const auto world = [&](const std::string& name) {
    const auto found = world_of.find(name);
    return found == world_of.end() ? std::string() : found->second;
  };
  std::set<std::string> candidates;  // runs whose phases could be this run's
  for (const ReportedPhase& phase : places.phases)
    if (phase.manoeuvre == manoeuvre && (phase.run.empty() || world(phase.run) == world(file)))
      candidates.insert(phase.run);
  if (candidates.empty() || (candidates.size() > 1 && !candidates.contains(file))) return {};
  const std::string of = candidates.contains(file) ? file : *candidates.begin();
  std::vector<ReportedPhase> result;
  for (const ReportedPhase& phase : places.phases)
    if (phase.manoeuvre == manoeuvre && phase.run == of) result.push_back(phase);
  return result;
}

}  // namespace kenaf::gap::playback
