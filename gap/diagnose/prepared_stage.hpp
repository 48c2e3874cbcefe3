// A stage with all simulations that precede its decision: the effects of all candidates that can matter.
//
// Thread safety: pure functions, except that the predictor runs.
#pragma once

#include <span>
#include <vector>

#include "gap/diagnose/stage_decision.hpp"

namespace kenaf::gap::diagnose {

// The input of a stage's diagnosis.
struct StageInput {
  Passage passage;
  const Observations* observations;
  const std::vector<FeatureMap>* maps;
  const std::vector<StageFeatures>* features;
  const std::vector<std::vector<std::size_t>>* repeats;                // repeats_of()
  const std::vector<std::vector<std::size_t>>* same_command_sequence;  // same_command_sequence_of()
  std::vector<double> stated_noise;  // for each of diagnosis_channels(), 0: not stated; of one sample of that channel
};

// A stage with all simulations that precede its decision.
struct PreparedStage {
  StageInput input;
  std::span<const candidates::Candidate> candidates;  // must outlive this
  std::vector<std::size_t> possible;                  // candidates_of()
  std::vector<std::size_t> visible;                   // those of them that shift these runs at any size
  std::vector<Eigen::VectorXd> residuals;
  StageAround nominal;  // no data if no run measures the stage
  EffectCurves curves;  // of candidates that can matter, over their range
};
PreparedStage prepare_stage(const StageInput& input, std::span<const candidates::Candidate> candidates,
                            Predictor& predictor);

// Returns a function that simulates settings in a stage. Both arguments must outlive it.
Simulate simulator_of(const PreparedStage& stage, Predictor& predictor);
// The variation that is simulated with these settings.
Variation varied(const PreparedStage& stage, const Predictor& predictor, const Settings& settings);
// The simulation's open shapes around that robot.
std::vector<OpenShapes> open_around(const PreparedStage& stage, Predictor& predictor, const Settings& settings);
// The stage's residuals with this noise floor.
StageData data_in(const PreparedStage& stage, const NoiseFloor& floor);
bool has_baseline(const std::vector<StageFeatures>& features);

}  // namespace kenaf::gap::diagnose
