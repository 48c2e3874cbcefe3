// A stage with all that is simulated of it before anything is decided: what each candidate does, as far as it can
// matter.
//
// Thread safety: pure functions apart from what the predictor does.
#pragma once

#include <span>
#include <vector>

#include "gap/diagnose/stage_decision.hpp"

namespace kenaf::gap::diagnose {

// What the diagnosis of a stage starts from.
struct StageInput {
  Passage passage;
  const Observations* observations;
  const std::vector<FeatureMap>* maps;
  const std::vector<StageFeatures>* features;
  const std::vector<std::vector<std::size_t>>* repeats;      // same commands
  const std::vector<std::vector<std::size_t>>* same_orders;  // same_orders_of()
  std::vector<double> stated_noise;                          // of diagnosis_channels(), 0: nobody stated one
};

// A stage with what is simulated of it before anything is decided.
struct PreparedStage {
  StageInput input;
  std::span<const candidates::Candidate> candidates;  // must outlive this
  std::vector<std::size_t> possible;                  // candidates_of()
  std::vector<Eigen::VectorXd> residuals;
  StageAround nominal;  // no data where no run measures the stage
  EffectCurves curves;  // of those that can matter, over their range
};
PreparedStage prepare_stage(const StageInput& input, std::span<const candidates::Candidate> candidates,
                            Predictor& predictor);

// Simulates settings in a stage. Both must outlive it.
Simulate simulator_of(const PreparedStage& stage, Predictor& predictor);
// The robot that is simulated with these settings.
Variation varied(const PreparedStage& stage, const Predictor& predictor, const Settings& settings);
// What the simulation leaves open around that robot.
std::vector<OpenShapes> open_around(const PreparedStage& stage, Predictor& predictor, const Settings& settings);
// What the stage's runs show beyond the floor.
StageData data_in(const PreparedStage& stage, const NoiseFloor& floor);
bool has_baseline(const std::vector<StageFeatures>& features);

}  // namespace kenaf::gap::diagnose
