// The features that each stage between command and sensor compares. A stage is isolated from the ones before it:
//
//   command to drive   the drives' channels, in a replay of the commands
//   drive to body      pose and gyro, in a replay in which belts and flippers turn as they were measured
//   body to sensor     how much faster the gyro says that the robot turns than its angles do, in the same replay
//
// If a run did not measure its tracks, the last two are compared in a replay of the commands.
//
// Thread safety: values and pure functions.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string_view>
#include <vector>

#include "gap/diagnose/features.hpp"
#include "gap/diagnose/observation.hpp"

namespace kenaf::gap::diagnose {

enum class Passage { command_to_drive, drive_to_body, body_to_sensor };
inline constexpr std::array kPassages{Passage::command_to_drive, Passage::drive_to_body, Passage::body_to_sensor};
std::string_view passage_name(Passage passage);  // "command to drive"

// The features of one run in a stage. All vectors are in the order of `bins`: channel by channel, each in the order of
// time.
struct StageFeatures {
  std::vector<Bin> bins;                 // none: this run does not measure the stage
  double span_s = 0;                     // of a bin
  Eigen::VectorXd measured;              // mean of each bin, in the unit of its channel
  std::vector<Eigen::Index> rows{};      // indices of the bins in the run's FeatureMap
  double at_rest_s = 0;                  // from the start to the first command to move
  Eigen::VectorXd baseline_runs{};       // baseline runs of each bin (baseline.hpp); empty: no baseline
  Eigen::VectorXd baseline_simulated{};  // mean of these runs, as the nominal robot drives them
};

// Noise of a run less its baseline's mean, relative to that of one run, for each bin: sqrt(1 + 1 / n); 1 without a
// baseline.
Eigen::VectorXd noise_of_difference(const StageFeatures& run);

StageFeatures stage_features(Passage passage, const FeatureMap& map, const runs::Run& measured);

// The same values for a simulated run. `features`: its FeatureMap::of().
Eigen::VectorXd stage_values(Passage passage, const StageFeatures& stage, const FeatureMap& map,
                             const Eigen::VectorXd& features, const runs::Run& simulated);

}  // namespace kenaf::gap::diagnose
