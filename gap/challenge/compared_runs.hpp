// The runs of a dataset beside what the nominal robot makes of them, as a diagnosis compares them.
#pragma once

#include <Eigen/Core>
#include <atomic>
#include <cstddef>
#include <filesystem>
#include <vector>

#include "gap/diagnose/features.hpp"
#include "gap/diagnose/noise_floor.hpp"
#include "gap/diagnose/observation.hpp"
#include "gap/diagnose/prediction.hpp"

namespace kenaf::gap {

struct ComparedRuns {
  // Reads and simulates; throws as observe() does, and Stopped as the predictor does. Deterministic, on any number of threads.
  ComparedRuns(const std::filesystem::path& dataset, unsigned threads, const std::atomic<bool>* stop = nullptr);
  ComparedRuns(const ComparedRuns&) = delete;  // `predictor` refers to the others
  ComparedRuns& operator=(const ComparedRuns&) = delete;

  Observations observations;
  std::vector<FeatureMap> features;
  Predictor predictor;
  std::vector<Eigen::VectorXd> residuals;  // measured minus nominal, of each run
  std::vector<std::vector<std::size_t>> same_orders;
};

NoiseFloor floor_around(ComparedRuns& runs, const Variation& model);
// The rms of what repeats differ by, in floors. `residuals`: measured minus what a model says, of each run.
double rms_of_repeats(const ComparedRuns& runs, const NoiseFloor& floor, const std::vector<Eigen::VectorXd>& residuals);

}  // namespace kenaf::gap
