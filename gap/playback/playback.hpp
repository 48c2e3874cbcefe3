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
#include "gap/playback/run_gap.hpp"

namespace kenaf::gap::playback {

constexpr std::size_t kMostShownTimes = 20000;  // of a run: a browser draws so many without delay

struct PlaybackRequest {
  std::filesystem::path runs;    // a dataset's folder, or the CSV file of one run
  std::filesystem::path report;  // folder that `kenaf-gap diagnose` wrote, or its report.json; empty: none
  std::string run;  // file or manoeuvre of the run to begin with; empty: the one with the worst moment of all by the
                    // report, unless at_s is given; else the first
  std::string robot, world;      // instead of the dataset's; empty: its own, for a single file "kenaf" and "flat"
  std::optional<double> at_s{};  // when to begin, from the first row of the run to begin with; none: at its start
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
  double at_s = 0;              // when to begin in it
  std::optional<ReportedPlaces> report;
  std::map<std::string, Floor> floors;  // by column
  std::vector<std::string> notes;       // on all runs, in sentences
};

// Reads and checks everything, simulates nothing. A file beside a dataset.toml that lists it gets robot, world and
// manoeuvre of that dataset. Throws std::exception with words for the user if something cannot be read, the report is
// of other manoeuvres, there is no such run, or it ends before at_s.
Playback load_playback(const PlaybackRequest& request);

// Returns the report's phases of one of its runs (phases_of_run()). There must be a report.
std::vector<ReportedPhase> reported_phases_of(const Playback& playback, const ListedRun& run);

// Returns one of its runs, with its simulations. Throws std::exception with words for the user if its file can no
// longer be read.
PlayedRun prepare_run(const Playback& playback, std::size_t run);

// The playback protocol, kenaf-playback/2: HTTP as that of the live view (docs/live-view.md), with ?token= where one is
// needed. SI units, radians, frames of runs (docs/logs.md); null is unknown.
//
//   /playback          200: JSON of playback_json(), all runs
//   /playback/N        run N, from 0. 202 while it is being simulated: ask again. Then 200: JSON of played_run_json()
//   /playback/N/scene  the world of that run, as /scene of the live view
//
// Keys of playback_json():
//   format     "kenaf-playback/2"
//   name       of the folder or file; source: the dataset's
//   first      number of the run to begin with; at_s: when to begin in it, s
//   robot      {name, and the dimensions of a robot in the live view's `inventory`}
//   corrected  whether there is a corrected robot
//   report     {verdict, named: names of effects, stage: whose gap the shares are of, or empty,
//              largest_share: of a phase of any run, 0 to 1} or null
//   runs       [{file, manoeuvre, world, rows: in the file, duration_s,
//              share: of that stage's gap in all runs, 0 to 1, only with a report
//              worst: {t_s, floors: rms over all channels}, only if the report has it}]
//   notes      on all runs, sentences
//
// Keys of played_run_json():
//   file, manoeuvre, world, rows  as above
//   t_s       s from the run's first row on; every list of a body has one number for each of these
//   bodies    "recorded", then "nominal" and "corrected" if any: [{
//               kind
//               pose_from  "measured", "dead reckoning" or "nothing"
//               pose       {x, y, z in m; roll, pitch, yaw in rad}, of frame B in W; missing with "nothing"
//               flipper    four lists in rad: front left, front right, rear left, rear right; positive tip up
//               track_m    two lists of travel in m: left, right
//               channels   {column: list in the column's unit}}]
//   channels  columns that can be drawn: [{column, unit, wraps: whether it is an angle, share of the gap, 0 to 1, if
//             the report has it, floor in the unit, floor_from "report", "stated noise" or "resolution"}]
//   gaps      of each simulation: [{
//               kind         "nominal", "corrected"
//               span_s       over which differences are averaged
//               differences  {column: recorded minus simulated in each span from the start, in the unit}
//               difference_floors  {column: the same in floors, where a span with fewer samples has a larger one}
//               floors       {column: rms of these}
//               worst        {t_s, floors: rms over all channels, column: that with most floors, recorded, simulated,
//                            difference: of it, difference_floors: without sign} or null: the span with most floors
//                            over all channels (gap/diagnose/run_gap.hpp)
//             }]
//   phases    [{phase, from_s, to_s}], of this run
//   marks     phases of the report, largest share first: [{manoeuvre, phase, run: file of the repeat whose times these
//             are, from_s, to_s, share: of the gap in all runs, 0 to 1}]
//   notes     unexpected facts about this run, sentences
std::string playback_json(const Playback& playback);
std::string played_run_json(const Playback& playback, std::size_t run, const PlayedRun& played);

}  // namespace kenaf::gap::playback
