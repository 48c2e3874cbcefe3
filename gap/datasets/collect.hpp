// Makes a dataset of runs that were recorded one by one.
//
// Thread safety: one call at a time for a folder.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "gap/logs/plausibility.hpp"

namespace kenaf::gap::datasets {

struct RecordedRun {
  std::filesystem::path file;  // a CSV file
  std::string manoeuvre;       // shipped or the user's own; runs with the same one are repeats
};

struct CollectRequest {
  std::vector<RecordedRun> runs;
  std::string robot;            // shipped name or TOML file; empty: "kenaf", or that of the existing dataset
  std::string world;            // shipped name or SDF file; empty: that of each shipped manoeuvre, else the dataset's
  std::string source = "real";  // or "sim"
  std::string description;
  bool unwrap = false;  // write the tracks' travel without the jumps of counters that wrap (wrapped_travel.hpp)
  logs::RefusedRuns refused_runs;  // what to do with runs that check_run() refuses
  std::filesystem::path out;
};

struct CollectedDataset {
  bool extended = false;                // the dataset existed before
  std::vector<runs::DatasetRun> runs;   // those added, in the order requested
  std::vector<std::size_t> added;       // their places in the request: others were refused and left out
  std::vector<logs::Finding> findings;  // of those and of all runs together; with file names as given
  std::vector<std::string> changed;     // what `unwrap` did
  bool refused = false;                 // too many runs are refused, or all together: nothing was written
};

// Copies the runs into the folder `out` under their own names, with a number if a name is taken, and writes or extends
// its dataset.toml, last. Existing files do not change, except for runs added at the end of dataset.toml. A run that
// cannot be read counts as refused, even if others are taken unchecked. Throws std::exception with words for the user,
// having written nothing, if `out` is neither empty nor a dataset, the robot is not the dataset's, or no world is
// known.
CollectedDataset collect_dataset(const CollectRequest& request);

}  // namespace kenaf::gap::datasets
