// The contents of a playback: the runs of a dataset, or a single run, and what a report says about them.
//
// Thread safety: values; prepare_run() may be called from any thread.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gap/playback/played_run.hpp"

namespace kenaf::gap::playback {

constexpr std::size_t kMostShownTimes = 20000;  // of a run: a browser draws so many without delay

struct PlaybackRequest {
  std::filesystem::path runs;    // a dataset's folder, or the CSV file of one run
  std::filesystem::path report;  // folder that `kenaf-gap diagnose` wrote; empty: none
  std::string run;               // file or manoeuvre of the run to begin with; empty: the first
  std::string robot, world;      // instead of the dataset's; empty: its own, for a single file "kenaf" and "flat"
};

struct ListedRun {
  runs::DatasetRun entry;
  std::string world_name;  // as shown
  std::size_t rows;
  double duration_s;
  std::size_t world;  // index in Playback::worlds
};

struct Playback {
  std::string name;              // of the folder or file
  std::filesystem::path folder;  // of the runs
  std::string source;            // of the dataset
  PlayedRobots robots;
  std::vector<physics::WorldDescription> worlds;
  std::vector<ListedRun> runs;  // at least one
  std::size_t first = 0;        // index in runs of the one to begin with
  std::optional<ReportedPlaces> report;
  std::vector<std::string> notes;  // on all runs, in sentences
};

// Reads and checks everything, simulates nothing. A file beside a dataset.toml that lists it gets robot, world and
// manoeuvre of that dataset. Throws std::exception with words for the user if something cannot be read, the report is
// of other manoeuvres, or there is no such run.
Playback load_playback(const PlaybackRequest& request);

// Returns one of its runs, with its simulations. Throws std::exception with words for the user if its file can no
// longer be read.
PlayedRun prepare_run(const Playback& playback, std::size_t run);

// Returns the data for the page, of all runs and of one; docs/compare.md describes the keys.
std::string playback_json(const Playback& playback);
std::string played_run_json(const Playback& playback, std::size_t run, const PlayedRun& played);

}  // namespace kenaf::gap::playback
