// Simulated counterparts of observed runs: the same commands from the same place, with a given model.
//
// Deterministic, on any number of threads.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "gap/diagnose/features.hpp"
#include "gap/diagnose/observation.hpp"
#include "physics/world.hpp"

namespace kenaf::gap {

// How the simulation of a run differs from the nominal one.
struct Variation {
  physics::Effects effects;
  physics::PhysicsSettings physics;
  double start_x_m = 0, start_y_m = 0, start_yaw_rad = 0;  // added to the observed start
};

class Predictor {
 public:
  // Both must outlive this; `features` has one map for each run.
  Predictor(const Observations& observations, const std::vector<FeatureMap>& features, unsigned threads);

  // Noiseless features of every run under every variation: result[variation][run].
  std::vector<std::vector<Eigen::VectorXd>> predict(const std::vector<Variation>& variations);
  // Nothing varied.
  Variation nominal() const { return {observations_.robot.effects, {}}; }
  // One run alone, as a run.
  runs::Run simulate(std::size_t run, const Variation& variation) const;

  std::size_t roll_outs() const { return roll_outs_; }

 private:
  const Observations& observations_;
  const std::vector<FeatureMap>& features_;
  unsigned threads_;
  std::size_t roll_outs_ = 0;
};

}  // namespace kenaf::gap
