// The runs of a dataset as the diagnosis uses them: the measurements, and how to drive a simulated robot in the same
// way.
//
// Thread safety: values and pure functions.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "formats/runs/dataset.hpp"
#include "gap/logs/plausibility.hpp"
#include "physics/robot_description.hpp"
#include "physics/world_description.hpp"
#include "rollout/manoeuvre.hpp"

namespace kenaf::gap::diagnose {

struct Observation {
  std::string file, manoeuvre;  // runs that share a manoeuvre are its repeats
  std::size_t world;            // of Observations::worlds
  runs::Run run;                // as measured, except that t_s starts at 0 and dead sensors have no values
  rollout::Manoeuvre replay;    // its commands, from its start pose
  std::optional<rollout::Manoeuvre> measured;  // its tracks and flippers as measured, if they were
  std::size_t resting_rows;  // first rows, before the first command to move: their mean is the start pose
};

struct Observations {
  runs::Dataset dataset;
  std::string robot_name;           // as physics::load_robot() takes it
  physics::RobotDescription robot;  // the nominal model
  std::vector<physics::WorldDescription> worlds;
  std::vector<Observation> runs;
  std::vector<std::string> not_simulated;  // measured channels for which the described robot has no sensor
  std::vector<std::string> warnings;       // what was left out and why
};

// Whether some world has more than level ground.
bool has_obstacles(const Observations& observations);

// Makes one run of a dataset, in world 0. `path` names its file in errors. Throws runs::RunFileError if it has no
// commands, or neither a start nor measured tracks.
Observation observation_of(const runs::DatasetRun& entry, runs::Run run, const std::string& path);

// Reads at most `most_runs` runs of a dataset, drawn evenly from all manoeuvres: more would take longer with little
// benefit. `robot` and `world`, if not empty, replace the dataset's own. Leaves out, with a warning, runs that are too
// short, copies of others, or failed simulations. Throws runs::RunFileError or DescriptionError with file, line and
// column if the dataset or a description cannot be read, too many runs are implausible (gap/logs/plausibility.hpp) or
// cannot be read, all together are (gap/logs/body_heading.hpp), or none is left; fewer implausible ones are left out
// with a warning, or used as they are if `refused_runs` says so.
//
// A run without a heading shows nothing of the way: its place counts as not measured.
//
// Warns of channels that the described robot does not have, as they cannot be compared. Clears the values of certainly
// dead sensors in a run, with a warning, as they would be taken for a gap.
Observations observe(const std::filesystem::path& folder, const std::string& robot, const std::string& world,
                     std::size_t most_runs, const logs::RefusedRuns& refused_runs = {});

}  // namespace kenaf::gap::diagnose
