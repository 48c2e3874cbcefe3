// Simulates a dataset: any number of manoeuvres and repeats, on all cores.
//
// Deterministic: the same request gives the same bytes for any number of threads, and run k of a manoeuvre does not
// depend on the rest of the request.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "physics/world.hpp"

namespace kenaf::gap::datasets {

constexpr double kLargestScale = 1000;  // of noise and scatter

struct SimulationRequest {
  std::string robot = "kenaf";          // shipped name or TOML file
  std::string world;                    // shipped name or SDF file; empty: each manoeuvre's own
  std::vector<std::string> manoeuvres;  // as rollout::load_manoeuvre() takes them
  std::vector<std::string> effects;     // "NAME:PARAMETER=VALUE"; override those of the robot's file
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
  std::optional<bool> succeeded;  // by the manoeuvre's own criterion, if it has one
  bool gave_up = false;           // by the operator: rollout::RollOut
  std::string fault;              // why the run ended early; empty: it did not
};

struct SimulatedDataset {
  std::vector<SimulatedRun> runs;     // in the order requested, repeats of a manoeuvre side by side
  std::vector<std::string> warnings;  // features of worlds that the simulator does not support
};

// Seed of the noise of one run: that of the `repeat`th (from 0) run of `manoeuvre`, named as in the request.
std::uint64_t seed_of_run(std::uint64_t seed, std::string_view manoeuvre, int repeat);

// Writes the dataset to `out`: all of it or, if it throws, nothing. A run whose simulation went wrong is written up to
// that point and marked with its fault in dataset.toml. Throws std::exception with words for the user if the input is
// invalid, or `out` is not empty and `force` is not set.
SimulatedDataset simulate_dataset(const SimulationRequest& request);

}  // namespace kenaf::gap::datasets
