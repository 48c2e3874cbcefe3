// What the simulator says of the observed runs: the same commands from the same place, with the nominal model or another.
//
// Deterministic, on any number of threads and of processes.
#pragma once

#include <Eigen/Core>
#include <atomic>
#include <functional>
#include <span>
#include <vector>

#include "gap/diagnose/features.hpp"
#include "gap/diagnose/observation.hpp"
#include "gap/ranks.hpp"
#include "physics/world.hpp"

namespace kenaf::gap {

// How the simulation of a run differs from the nominal one.
struct Variation {
  physics::Effects effects;
  physics::PhysicsSettings physics;
  double start_x_m = 0, start_y_m = 0, start_yaw_rad = 0;  // added to the observed start
};

// Shifts of features, varied minus nominal, of every run.
using Shift = std::vector<Eigen::VectorXd>;

enum class Fidelity {
  every_run,  // each run is simulated
  coarse,     // one run of each group of repeats is, with twice the time step; the others shift alike, at the same times
};

// Thrown by a simulation that was asked to stop.
struct Stopped {};
// Throws it if `stop`, if there is one, is set.
void check_goes_on(const std::atomic<bool>* stop);

class Predictor {
 public:
  // Both must outlive this; `features` has one map for each run. Once `stop`, if there is one, is true, simulations throw
  // Stopped. `progress`, if any, is called between simulations with how many are done, by the thread that asked for them.
  Predictor(const Observations& observations, const std::vector<FeatureMap>& features,
            std::vector<std::vector<std::size_t>> repeats, unsigned threads,
            const std::atomic<bool>* stop = nullptr, Ranks ranks = {},
            std::function<void(std::size_t)> progress = {});

  // All runs once; comes first.
  void simulate_nominal();
  const std::vector<Eigen::VectorXd>& nominal() const { return nominal_; }
  const std::vector<std::vector<std::size_t>>& repeats() const { return repeats_; }
  // Of all runs with belts and flippers that turn as they were measured; empty for a run in which they were not.
  std::vector<Eigen::VectorXd> nominal_with_measured_drives();
  Variation unvaried() const { return {observations_.robot.effects, {}}; }

  std::vector<Shift> shifts(std::span<const Variation> variations, Fidelity fidelity);
  // Run r alone with variation r of `variations`, one for each run.
  Shift shift_of_each(std::span<const Variation> variations);
  // One run alone, without noise, as a run.
  runs::Run simulate(std::size_t run, const Variation& variation) const;

  std::size_t roll_outs() const { return roll_outs_; }

 private:
  runs::Run simulate(const rollout::Manoeuvre& replay, std::size_t run, const Variation& variation) const;
  Eigen::VectorXd features_of(std::size_t run, const Variation& variation) const;
  // job(0) ... job(count - 1), by all ranks and threads together.
  std::vector<Eigen::VectorXd> all_of(std::size_t count, const std::function<Eigen::VectorXd(std::size_t)>& job);
  std::vector<Shift> coarse_shifts(std::span<const Variation> variations);
  // Of each group's representative.
  std::vector<Eigen::VectorXd> simulate_coarse(std::span<const Variation> variations);
  Eigen::VectorXd alike(std::size_t from, const Eigen::VectorXd& shift, std::size_t to) const;

  const Observations& observations_;
  const std::vector<FeatureMap>& features_;
  std::vector<std::vector<std::size_t>> repeats_;
  std::vector<std::size_t> representatives_;  // of each group
  unsigned threads_;
  const std::atomic<bool>* stop_;
  Ranks ranks_;
  std::function<void(std::size_t)> progress_;
  std::vector<Eigen::VectorXd> nominal_;
  std::vector<Eigen::VectorXd> coarse_nominal_;  // of each group's representative, once asked for
  std::size_t roll_outs_ = 0;
};

}  // namespace kenaf::gap
