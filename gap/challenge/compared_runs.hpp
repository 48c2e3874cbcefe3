// The runs of a dataset compared with their simulation by the nominal robot, as a diagnosis does it: stage by stage,
// each in its own replay.
#pragma once

#include <Eigen/Core>
#include <array>
#include <atomic>
#include <cstddef>
#include <filesystem>
#include <vector>

#include "gap/diagnose/noise_floor.hpp"
#include "gap/diagnose/observation.hpp"
#include "gap/diagnose/prediction.hpp"

namespace kenaf::gap::challenge {

// The stages that together compare each channel once. The third one, body to sensor, compares the gyro once more.
inline constexpr std::array kEachChannelOnce{diagnose::Passage::command_to_drive, diagnose::Passage::drive_to_body};

// Differences of the values of each stage of kEachChannelOnce, for each run.
using Differences = std::array<diagnose::Shift, kEachChannelOnce.size()>;
using Floors = std::array<diagnose::NoiseFloor, kEachChannelOnce.size()>;

struct ComparedRuns {
  // Reads and simulates. Throws as observe() does, and Stopped as the predictor does. Deterministic, on any number of
  // threads.
  ComparedRuns(const std::filesystem::path& dataset, unsigned threads, const std::atomic<bool>* stop = nullptr);
  ComparedRuns(const ComparedRuns&) = delete;  // `predictor` refers to the others
  ComparedRuns& operator=(const ComparedRuns&) = delete;

  diagnose::Observations observations;
  diagnose::ComparedFeatures features;
  diagnose::Predictor predictor;
  Differences residuals;                                        // measured minus nominal
  std::vector<std::vector<std::size_t>> same_command_sequence;  // groups of runs: same_command_sequence_of()
};

Differences operator-(Differences a, const Differences& b);

// The floors of the diagnosis: noise, and what the simulation leaves open around a model.
Floors floors_around(ComparedRuns& runs, const diagnose::Variation& model);
// The shifts of a robot against the nominal one.
Differences shifts_of(ComparedRuns& runs, const physics::RobotDescription& robot, diagnose::Fidelity fidelity);

// Root mean square in units of noise, over all bins of all stages together.
double rms(const Floors& floors, const Differences& differences);
// The same for the differences between repeats; 1 without repeats. `residuals`: measured minus a model's values.
double rms_of_repeats(const ComparedRuns& runs, const Floors& floors, const Differences& residuals);

}  // namespace kenaf::gap::challenge
