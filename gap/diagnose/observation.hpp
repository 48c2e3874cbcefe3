// The runs of a dataset as the diagnosis uses them: what was measured, and how to drive a simulated robot the same way.
// Thread safety: values and pure functions.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "physics/robot_description.hpp"
#include "physics/world_description.hpp"
#include "rollout/manoeuvre.hpp"
#include "runs/dataset.hpp"

namespace kenaf::gap {

struct Observation {
  std::string file, manoeuvre;  // runs that share a manoeuvre are its repeats
  std::size_t world;            // of Observations::worlds
  runs::Run run;                // as measured; t_s from 0
  rollout::Manoeuvre replay;    // its commands, from where it stood
  std::size_t resting_rows;     // from the first row on, before it was told to move: their mean is the start
};

struct Observations {
  runs::Dataset dataset;
  std::string robot_name;           // as physics::load_robot() takes it
  physics::RobotDescription robot;  // the nominal model
  std::vector<physics::WorldDescription> worlds;
  std::vector<Observation> runs;
  std::vector<std::string> warnings;  // what was left out and why, in words
};

// Reads a whole dataset. `robot` and `world` are used instead of the dataset's own where they are not empty. Throws
// runs::RunFileError or physics::DescriptionError with file, line and column where nothing can be made of it; a single
// run that is no use is left out with a warning.
Observations observe(const std::filesystem::path& folder, const std::string& robot, const std::string& world);

}  // namespace kenaf::gap
