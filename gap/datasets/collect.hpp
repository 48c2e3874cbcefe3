// A dataset from runs that were recorded one by one.
//
// Thread safety: a function that writes; one at a time for a folder.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "gap/logs/plausibility.hpp"

namespace kenaf::gap::datasets {

struct RecordedRun {
  std::filesystem::path file;  // a CSV file
  std::string manoeuvre;       // runs that share it repeat one manoeuvre; shipped or the user's own
};

struct CollectRequest {
  std::vector<RecordedRun> runs;
  std::string robot;            // shipped name or TOML file; empty: "kenaf", or that of the dataset that is there
  std::string world;            // shipped name or SDF file; empty: that of each shipped manoeuvre, else the dataset's
  std::string source = "real";  // or "sim"
  std::string description;
  bool unchecked = false;  // take runs that check_run() refuses
  std::filesystem::path out;
};

struct CollectedDataset {
  bool extended = false;                // it was there
  std::vector<runs::DatasetRun> runs;   // those added, in the order asked for
  std::vector<logs::Finding> findings;  // of those; by the names of their files as given
  bool refused = false;                 // findings refuse: nothing was written
};

// Copies the runs into the folder `out` under their own names, made different by a number where one is taken, and
// writes or extends its dataset.toml, last. Nothing that is there is changed but for runs added at the end of
// dataset.toml. Throws std::exception with words for the user, and then has written nothing: a run that cannot be read,
// `out` is not empty and no dataset, a robot other than the dataset's, no world known.
CollectedDataset collect_dataset(const CollectRequest& request);

}  // namespace kenaf::gap::datasets
