// The runs of a dataset beside what the nominal robot makes of them, as a diagnosis compares them: stage by stage, each
// in its own replay.
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

// The stages that together compare each channel once. What the third one, body to sensor, compares is the gyro once
// more.
inline constexpr std::array kEachChannelOnce{diagnose::Passage::command_to_drive, diagnose::Passage::drive_to_body};

// Of each of kEachChannelOnce: what its values differ by, of each run.
using Differences = std::array<diagnose::Shift, kEachChannelOnce.size()>;
using Floors = std::array<diagnose::NoiseFloor, kEachChannelOnce.size()>;

struct ComparedRuns {
  // Reads and simulates; throws as observe() does, and Stopped as the predictor does. Deterministic, on any number of
  // threads.
  ComparedRuns(const std::filesystem::path& dataset, unsigned threads, const std::atomic<bool>* stop = nullptr);
  ComparedRuns(const ComparedRuns&) = delete;  // `predictor` refers to the others
  ComparedRuns& operator=(const ComparedRuns&) = delete;

  diagnose::Observations observations;
  diagnose::ComparedFeatures features;
  diagnose::Predictor predictor;
  Differences residuals;  // measured minus nominal
  std::vector<std::vector<std::size_t>> same_orders;
};

Differences operator-(Differences a, const Differences& b);

// Noise, and what the simulation leaves open around a model, as the diagnosis has them.
Floors floors_around(ComparedRuns& runs, const diagnose::Variation& model);
// What a robot does differently from the nominal one.
Differences shifts_of(ComparedRuns& runs, const physics::RobotDescription& robot, diagnose::Fidelity fidelity);

// In units of noise, over all bins of all stages together.
double rms(const Floors& floors, const Differences& differences);
// The same of what repeats differ by; 1 without repeats. `residuals`: measured minus what a model says.
double rms_of_repeats(const ComparedRuns& runs, const Floors& floors, const Differences& residuals);

}  // namespace kenaf::gap::challenge
