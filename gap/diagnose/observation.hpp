// The runs of a dataset as the diagnosis uses them: what was measured, and how to drive a simulated robot the same way.
//
// Thread safety: values and pure functions.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "formats/runs/dataset.hpp"
#include "physics/robot_description.hpp"
#include "physics/world_description.hpp"
#include "rollout/manoeuvre.hpp"

namespace kenaf::gap::diagnose {

struct Observation {
  std::string file, manoeuvre;  // runs that share a manoeuvre are its repeats
  std::size_t world;            // of Observations::worlds
  runs::Run run;                // as measured, but that t_s is counted from 0 here and dead sensors have no values
  rollout::Manoeuvre replay;    // its commands, from where it stood
  std::optional<rollout::Manoeuvre> measured;  // its tracks and flippers as they were measured, where they were
  std::size_t resting_rows;  // from the first row on, before it was told to move: their mean is the start
};

struct Observations {
  runs::Dataset dataset;
  std::string robot_name;           // as physics::load_robot() takes it
  physics::RobotDescription robot;  // the nominal model
  std::vector<physics::WorldDescription> worlds;
  std::vector<Observation> runs;
  std::vector<std::string> not_simulated;  // channels that were measured, but by no sensor of the described robot
  std::vector<std::string> warnings;       // what was left out and why, in words
};

// Whether some world of theirs is more than level ground.
bool has_obstacles(const Observations& observations);

// One run of a dataset, of world 0. `path` names its file in errors. Throws runs::RunFileError where it has no commands
// or no start.
Observation observation_of(const runs::DatasetRun& entry, runs::Run run, const std::string& path);

// Reads a dataset, but no more than `most_runs` of it, drawn evenly from all manoeuvres: more runs would take longer
// and tell little more. `robot` and `world` are used instead of the dataset's own where they are not empty. A run that
// is too short, a copy of another one, or whose simulation went wrong, is left out with a warning. Throws
// runs::RunFileError or DescriptionError with file, line and column where one cannot be read or cannot be what it says
// it is (gap/logs/plausibility.hpp), or none is left.
//
// A channel that the described robot does not have cannot be compared, and is told by a warning. A run's sensor that is
// certainly dead has no values in that run here, told likewise: it would be taken for a gap.
Observations observe(const std::filesystem::path& folder, const std::string& robot, const std::string& world,
                     std::size_t most_runs);

}  // namespace kenaf::gap::diagnose
