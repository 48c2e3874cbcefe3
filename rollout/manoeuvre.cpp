#include "rollout/manoeuvre.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <numbers>

#include "formats/description/data_files.hpp"
#include "formats/description/description_file.hpp"
#include "formats/description/toml_reader.hpp"
#include "formats/runs/dataset.hpp"

namespace kenaf::rollout {
namespace {

using description::kAny;
using description::kPositive;
using description::Range;
using description::TomlReader;

namespace fs = std::filesystem;

constexpr double kPi = std::numbers::pi;
constexpr Range kTrackSpeed{.min = -10, .max = 10};
constexpr Range kFlipperAngle{.min = -2 * kPi, .max = 2 * kPi};
constexpr Range kPitch{.min = -kPi, .max = kPi};
constexpr std::string_view kReplay = "replay:", kReplayMeasured = "replay-measured:";

std::optional<double> optional_number(TomlReader& table, std::string_view key, Range range = kAny) {
  return table.has(key) ? std::optional(table.number(key, range)) : std::nullopt;
}

std::string optional_text(TomlReader& table, std::string_view key) {
  return table.has(key) ? table.text(key) : std::string();
}

GiveUp read_give_up(TomlReader& phase) {
  TomlReader table = phase.table("give_up");
  const GiveUp give_up{.x_below_m = optional_number(table, "x_below_m"),
                       .pitch_below_rad = optional_number(table, "pitch_below_rad", kPitch)};
  table.finish();
  if (!give_up.x_below_m && !give_up.pitch_below_rad)
    phase.fail("give_up", "must state x_below_m, pitch_below_rad or both");
  return give_up;
}

Phase read_phase(TomlReader& table) {
  Phase phase;
  phase.name = optional_text(table, "name");
  std::ranges::copy(table.numbers("track_mps", robot::kTrackCount, kTrackSpeed), phase.track_mps.begin());
  if (table.has("flipper_rad"))
    std::ranges::copy(table.numbers("flipper_rad", robot::kFlipperCount, kFlipperAngle),
                      phase.flipper_rad.emplace().begin());
  phase.at_most_s = table.number("at_most_s", {.min = 0, .max = kLongestManoeuvre_s, .open_min = true});
  phase.end = {.pitch_above_rad = optional_number(table, "pitch_above_rad", kPitch),
               .pitch_below_rad = optional_number(table, "pitch_below_rad", kPitch),
               .x_above_m = optional_number(table, "x_above_m"),
               .x_below_m = optional_number(table, "x_below_m"),
               .z_above_m = optional_number(table, "z_above_m"),
               .turned_rad = optional_number(table, "turned_rad", kPositive)};
  if (table.has("give_up")) phase.give_up = read_give_up(table);
  table.finish();
  return phase;
}

std::vector<Phase> read_phases(TomlReader& table) {
  std::vector<Phase> phases;
  std::vector<TomlReader> tables = table.tables("phase");
  for (TomlReader& phase : tables) {
    phases.push_back(read_phase(phase));
    if (phases.back().give_up && (phases.size() == 1 || phases.size() == tables.size()))
      phase.fail("give_up", "must not be in the first phase, which always begins, nor in the last, which follows it");
  }
  return phases;
}

Success read_success(TomlReader table) {
  Success success{.x_above_m = optional_number(table, "x_above_m"),
                  .z_above_m = optional_number(table, "z_above_m"),
                  .z_below_m = optional_number(table, "z_below_m")};
  success.upright_within_rad =
      table.number_or("upright_within_rad", success.upright_within_rad, {.min = 0, .max = kPi, .open_min = true});
  table.finish();
  return success;
}

Manoeuvre read_manoeuvre(TomlReader& table, const std::vector<Phase>& shared_phases, const fs::path& folder) {
  Manoeuvre manoeuvre;
  manoeuvre.name = table.text("name");
  if (manoeuvre.name.empty() || manoeuvre.name.find_first_of("/: \t\r\n\"") != std::string::npos)
    table.fail("name", "must not be empty nor hold blanks, quotes, '/' or ':'");
  manoeuvre.summary = table.text("summary");
  manoeuvre.world = table.text("world");
  if (manoeuvre.world.empty()) table.fail("world", "must not be empty");
  if (manoeuvre.world.ends_with(".sdf")) manoeuvre.world = (folder / manoeuvre.world).string();
  manoeuvre.start_lift_m = table.number_or("start_lift_m", 0, {.min = 0, .max = 10});
  manoeuvre.phases = read_phases(table);
  if (manoeuvre.phases.empty()) manoeuvre.phases = shared_phases;
  if (manoeuvre.phases.empty())
    table.fail("phase", "is missing: a manoeuvre has at least one [[manoeuvre.phase]], or a [[phase]] of the file");
  if (manoeuvre.at_most_s() > kLongestManoeuvre_s)
    table.fail("phase", fmt::format("is too long: all phases together last at most {} s", kLongestManoeuvre_s));
  if (table.has("success")) manoeuvre.success = read_success(table.table("success"));
  table.finish();
  return manoeuvre;
}

// A replay of a dataset's run counts as one more repeat of that run's manoeuvre, in the same world.
void name_as_dataset_does(Manoeuvre& replay, const fs::path& run_file) {
  const fs::path folder = run_file.parent_path();
  if (!fs::exists(folder / "dataset.toml")) return;
  const runs::Dataset dataset = runs::read_dataset(folder);
  const auto run = std::ranges::find(dataset.runs, run_file.filename().string(), &runs::DatasetRun::file);
  if (run == dataset.runs.end()) return;
  if (!run->manoeuvre.empty()) replay.name = run->manoeuvre;
  replay.world = runs::resolve_beside(folder, run->world.empty() ? dataset.world : run->world, ".sdf");
}

std::vector<Manoeuvre> read_file(const fs::path& path) {
  const description::DescriptionFile file = description::read_description_file("manoeuvre", path.string(), ".toml");
  return parse_manoeuvres(file.text, file.path);
}

}  // namespace

double Manoeuvre::at_most_s() const {
  double total_s = timed.empty() ? 0 : timed.back().t_s;
  for (const Phase& phase : phases) total_s += phase.at_most_s;
  return total_s;
}

std::vector<Manoeuvre> parse_manoeuvres(std::string_view toml_text, const std::string& name_for_errors) {
  const toml::table root = description::parse_toml(toml_text, name_for_errors);
  TomlReader file(root, "", name_for_errors);
  const std::vector<Phase> shared_phases = read_phases(file);
  std::vector<Manoeuvre> manoeuvres;
  for (TomlReader& table : file.tables("manoeuvre")) {
    Manoeuvre read = read_manoeuvre(table, shared_phases, fs::path(name_for_errors).parent_path());
    if (std::ranges::count(manoeuvres, read.name, &Manoeuvre::name) > 0)
      table.fail("name", fmt::format("\"{}\" is that of a manoeuvre before it too", read.name));
    manoeuvres.push_back(std::move(read));
  }
  if (manoeuvres.empty()) file.fail("manoeuvre", "is missing: a file has at least one [[manoeuvre]]");
  file.finish();
  return manoeuvres;
}

std::vector<Manoeuvre> shipped_manoeuvres() {
  std::vector<Manoeuvre> all;
  for (const fs::path& path : description::list_data_files("manoeuvres", ".toml"))
    for (Manoeuvre& manoeuvre : read_file(path)) all.push_back(std::move(manoeuvre));
  std::ranges::stable_sort(all, {}, &Manoeuvre::name);
  return all;
}

Manoeuvre load_manoeuvre(const std::string& name) {
  // A recorded run.
  for (const auto& [prefix, make] : {std::pair{kReplay, &replay_of}, {kReplayMeasured, &replay_measured_of}}) {
    if (!name.starts_with(prefix)) continue;
    const fs::path path = name.substr(prefix.size());
    Manoeuvre replay = make(runs::read_run(path), path.string());
    replay.name = std::string(prefix) + path.filename().string();
    name_as_dataset_does(replay, path);
    return replay;
  }

  // A file, which must hold one manoeuvre.
  if (name.find('/') != name.npos || name.ends_with(".toml")) {
    const std::vector<Manoeuvre> all = read_file(name);
    if (all.size() > 1)
      throw description::DescriptionError(
          fmt::format("{}: holds {} manoeuvres; give the path of a file that holds one", name, all.size()));
    return all.front();
  }

  // A shipped one; the error lists them.
  const std::vector<Manoeuvre> all = shipped_manoeuvres();
  const auto found = std::ranges::find(all, name, &Manoeuvre::name);
  if (found != all.end()) return *found;
  std::vector<std::string> names;
  for (const Manoeuvre& manoeuvre : all) names.push_back(manoeuvre.name);
  throw description::DescriptionError(
      fmt::format("manoeuvre \"{}\": no such manoeuvre; give the path of a TOML file, replay:FILE.csv, "
                  "replay-measured:FILE.csv, or one of {}",
                  name, fmt::join(names, ", ")));
}

}  // namespace kenaf::rollout
