// Runs of the simulator as a dataset: any number of manoeuvres and repeats, on all cores.
//
// Deterministic: the same request gives the same bytes, whatever the number of threads, and run k of a manoeuvre does
// not depend on what else is asked.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "physics/world.hpp"

namespace kenaf::gap::datasets {

constexpr double kLargestScale = 1000;  // of noise and scatter

struct SimulationRequest {
  std::string robot = "kenaf";          // shipped name or TOML file
  std::string world;                    // shipped name or SDF file; empty: each manoeuvre's own
  std::vector<std::string> manoeuvres;  // as rollout::load_manoeuvre() takes them
  std::vector<std::string> effects;     // "NAME:PARAMETER=VALUE", over those of the robot's file
  physics::PhysicsSettings physics;
  int repeats = 1;           // of each manoeuvre
  double noise_scale = 1;    // of all sensors
  double scatter_scale = 1;  // of start poses: 1 is a sigma of 5 mm in x and y and of 0.01 rad in yaw
  std::uint64_t seed = 1;
  unsigned jobs = 0;   // threads; 0: one a core
  bool force = false;  // write into a folder that is not empty
  std::filesystem::path out;
};

struct SimulatedRun {
  std::string file, manoeuvre;
  double duration_s = 0;
  std::optional<bool> succeeded;  // by the manoeuvre's own measure, where it has one
  bool gave_up = false;           // the operator did: rollout::RollOut
  std::string fault;              // why it ended early; empty: it did not
};

struct SimulatedDataset {
  std::vector<SimulatedRun> runs;     // in the order asked for, repeats of a manoeuvre side by side
  std::vector<std::string> warnings;  // what of a world the simulator does not do
};

// Writes the dataset to `out`: all of it or, where it throws, nothing. A run whose simulation went wrong is written as
// far as it came, and marked with its fault in dataset.toml. Throws std::exception with words for the user:
// bad input, or `out` holds something and `force` is not set.
SimulatedDataset simulate_dataset(const SimulationRequest& request);

}  // namespace kenaf::gap::datasets
