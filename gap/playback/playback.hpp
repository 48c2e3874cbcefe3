// What is played back: the runs of a dataset, or one run alone, and what a report says of them.
//
// Thread safety: values; prepare_run() is for any thread.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gap/playback/played_run.hpp"

namespace kenaf::gap::playback {

constexpr std::size_t kMostShownTimes = 20000;  // of a run: what a browser draws without thinking

struct PlaybackRequest {
  std::filesystem::path runs;    // a dataset's folder, or the CSV file of one run
  std::filesystem::path report;  // folder that `kenaf-gap diagnose` wrote; empty: none
  std::string run;               // file or manoeuvre of the one to begin with; empty: the first
  std::string robot, world;      // instead of the dataset's; empty: its own, for a file alone "kenaf" and "flat"
};

struct ListedRun {
  runs::DatasetRun entry;
  std::string world_name;  // as it is shown
  std::size_t rows;
  double duration_s;
  std::size_t world;  // of Playback::worlds
};

struct Playback {
  std::string name;              // of the folder or file
  std::filesystem::path folder;  // of the runs
  std::string source;            // of the dataset
  PlayedRobots robots;
  std::vector<physics::WorldDescription> worlds;
  std::vector<ListedRun> runs;  // at least one
  std::size_t first = 0;        // of runs, the one to begin with
  std::optional<ReportedPlaces> report;
  std::vector<std::string> notes;  // on all runs, in sentences
};

// Reads and checks everything, simulates nothing. A file beside a dataset.toml that lists it has that dataset's robot,
// world and manoeuvre. Throws std::exception with words for the user: what cannot be read, where; a report of other
// manoeuvres; no such run.
Playback load_playback(const PlaybackRequest& request);

// One of its runs, with its simulations. Throws std::exception in words where its file cannot be read any more.
PlayedRun prepare_run(const Playback& playback, std::size_t run);

// What the page is told, docs/playback.md has the keys: of all runs; of one.
std::string playback_json(const Playback& playback);
std::string played_run_json(const Playback& playback, std::size_t run, const PlayedRun& played);

}  // namespace kenaf::gap::playback
