#include "gap/playback/playback.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "formats/runs/whole_file.hpp"

namespace kenaf::gap::playback {
namespace {

namespace fs = std::filesystem;

// The dataset that lists a run's file, reduced to that run; or one made for it.
runs::Dataset dataset_of_file(const fs::path& file, std::vector<std::string>& notes) {
  const std::string name = file.filename().string();
  if (fs::exists(file.parent_path() / "dataset.toml")) {
    runs::Dataset dataset = runs::read_dataset(file.parent_path());
    std::erase_if(dataset.runs, [&](const runs::DatasetRun& run) { return run.file != name; });
    if (!dataset.runs.empty()) return dataset;
  }
  notes.push_back("This run has no dataset: its robot is assumed to be kenaf and its world flat, unless given.");
  runs::Dataset dataset;
  dataset.source = "real";
  dataset.robot = "kenaf";
  dataset.world = "flat";
  dataset.runs.push_back({name, file.stem().string(), {}, {}});
  return dataset;
}

std::string shown_name(const std::string& name_or_path) {
  return fs::path(name_or_path).stem().string();
}

void read_report(const fs::path& folder_or_file, Playback& playback) {
  const bool is_file = fs::is_regular_file(folder_or_file);
  const fs::path file = is_file ? folder_or_file : folder_or_file / "report.json", folder = file.parent_path();
  if (!fs::exists(file))
    throw std::runtime_error(
        fmt::format("{}: there is no report.json; `kenaf-gap diagnose` writes one", folder_or_file.string()));
  try {
    playback.report = parse_reported_places(runs::read_whole_file(file));
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(fmt::format("{}: {}", file.string(), error.what()));
  }

  // A report of none of the manoeuvres is that of other runs.
  const auto is_reported = [&](const ListedRun& run) {
    return std::ranges::any_of(playback.report->phases,
                               [&](const ReportedPhase& phase) { return phase.manoeuvre == run.entry.manoeuvre; });
  };
  if (!playback.report->phases.empty() && std::ranges::none_of(playback.runs, is_reported))
    throw std::runtime_error(fmt::format("{}: covers none of the manoeuvres in {}; is it the report of these runs?",
                                         file.string(), playback.name));
  if (fs::exists(folder / "robot.toml"))
    playback.robots.corrected = physics::load_robot((folder / "robot.toml").string());
}

// The run with the worst moment of all by the report; the first if it does not say.
std::size_t worst_run(const Playback& playback) {
  std::size_t worst = 0;
  double most = 0;
  for (std::size_t i = 0; playback.report && i < playback.runs.size(); ++i) {
    const auto reported = playback.report->worst_of_run.find(playback.runs[i].entry.file);
    if (reported == playback.report->worst_of_run.end() || reported->second.times_noise <= most) continue;
    worst = i;
    most = reported->second.times_noise;
  }
  return worst;
}

std::size_t find_run(const Playback& playback, const std::string& name) {
  const auto is = [&](const ListedRun& run) { return run.entry.file == name || run.entry.manoeuvre == name; };
  const auto found = std::ranges::find_if(playback.runs, is);
  if (found != playback.runs.end()) return static_cast<std::size_t>(found - playback.runs.begin());
  throw std::runtime_error(
      fmt::format("--run {}: {} contains neither a file nor a manoeuvre of that name", name, playback.name));
}

double checked_moment(const ListedRun& run, double at_s) {
  if (at_s >= 0 && at_s <= run.duration_s) return at_s;
  throw std::runtime_error(
      fmt::format("--at {}: {} goes from 0 to {:.2f} s; give a time within it", at_s, run.entry.file, run.duration_s));
}

}  // namespace

Playback load_playback(const PlaybackRequest& request) {
  Playback playback;
  // A single file, or a dataset's folder.
  const fs::path path = fs::absolute(request.runs).lexically_normal();
  const bool alone = fs::is_regular_file(path);
  playback.folder = alone ? path.parent_path() : path;
  playback.name = (path.has_filename() ? path : path.parent_path()).filename().string();
  const runs::Dataset dataset = alone ? dataset_of_file(path, playback.notes) : runs::read_dataset(request.runs);
  playback.source = dataset.source;

  // Robot and worlds as requested, or else the dataset's; each world is loaded once.
  playback.robots.nominal = physics::load_robot(
      request.robot.empty() ? runs::resolve_beside(playback.folder, dataset.robot, ".toml") : request.robot);
  std::map<std::string, std::size_t> worlds;
  for (const runs::DatasetRun& entry : dataset.runs) {
    const runs::Run run = runs::read_run(playback.folder / entry.file);
    if (run.row_count() == 0)
      throw runs::RunFileError(fmt::format("{}: has no rows", (playback.folder / entry.file).string()));
    const std::string own = entry.world.empty() ? dataset.world : entry.world;
    const std::string world =
        request.world.empty() ? runs::resolve_beside(playback.folder, own, ".sdf") : request.world;
    const auto [known, is_new] = worlds.try_emplace(world, playback.worlds.size());
    if (is_new) playback.worlds.push_back(physics::load_world(world, playback.notes));
    const auto time = run.column("t_s");
    playback.runs.push_back({entry, shown_name(world), run.row_count(), time.back() - time.front(), known->second});
  }

  if (!request.report.empty()) read_report(request.report, playback);
  playback.floors = floors_of(dataset.noise, playback.report ? &*playback.report : nullptr);
  if (!request.run.empty())
    playback.first = find_run(playback, request.run);
  else if (!request.at_s)
    playback.first = worst_run(playback);
  if (request.at_s) playback.at_s = checked_moment(playback.runs[playback.first], *request.at_s);
  return playback;
}

std::vector<ReportedPhase> reported_phases_of(const Playback& playback, const ListedRun& run) {
  std::map<std::string, std::string> world_of;
  for (const ListedRun& other : playback.runs) world_of[other.entry.file] = std::to_string(other.world);
  return phases_of_run(*playback.report, run.entry.file, run.entry.manoeuvre, world_of);
}

PlayedRun prepare_run(const Playback& playback, std::size_t index) {
  const ListedRun& listed = playback.runs.at(index);
  const std::string path = (playback.folder / listed.entry.file).string();
  const runs::Run run = runs::read_run(path);
  if (run.row_count() == 0) throw runs::RunFileError(path + ": has no rows");
  PlayedRun played = play_run(listed.entry, run, path, playback.robots, playback.worlds[listed.world], kMostShownTimes,
                              playback.floors);
  if (playback.report) {
    played.marks = reported_phases_of(playback, listed);
    if (played.marks.empty()) played.notes.push_back("The report contains no phases of this run's manoeuvre.");
  }
  return played;
}

}  // namespace kenaf::gap::playback
