// Simulations of the observed runs: the same motion from the same start, with the nominal robot or a varied one.
//
// Deterministic on any number of threads and processes.
#pragma once

#include <Eigen/Core>
#include <array>
#include <atomic>
#include <functional>
#include <set>
#include <span>
#include <vector>

#include "gap/diagnose/features.hpp"
#include "gap/diagnose/known_roll_outs.hpp"
#include "gap/diagnose/observation.hpp"
#include "gap/diagnose/stage_features.hpp"
#include "gap/diagnose/variation.hpp"
#include "gap/ranks.hpp"

namespace kenaf::gap::diagnose {

// Shifts of a stage's values, varied minus nominal, for every run.
using Shift = std::vector<Eigen::VectorXd>;

enum class Fidelity {
  every_run,  // each run is simulated
  fine,       // one run of each group of repeats is; the others are given the same shifts at the same times
  coarse,     // the same with twice the time step
};

// Thrown by a simulation when it is stopped.
struct Stopped {};
// Throws Stopped if `stop` is given and set.
void check_goes_on(const std::atomic<bool>* stop);

// The features of all runs: a map for each run, and for each stage and run the features that the stage compares.
struct ComparedFeatures {
  std::vector<FeatureMap> maps;
  std::array<std::vector<StageFeatures>, kPassages.size()> of_stage;
  const std::vector<StageFeatures>& of(Passage passage) const { return of_stage[static_cast<std::size_t>(passage)]; }
};
ComparedFeatures compared_features(const Observations& observations, double span_s);

class Predictor {
 public:
  // `observations` and `features` must outlive this. Once `stop`, if given, is true, simulations throw Stopped.
  // `progress`, if given, is called between simulations with their number so far, on the calling thread.
  Predictor(const Observations& observations, const ComparedFeatures& features,
            std::vector<std::vector<std::size_t>> repeats, unsigned threads, const std::atomic<bool>* stop = nullptr,
            Ranks ranks = {}, std::function<void(std::size_t)> progress = {});

  // Simulates all runs once for each stage that some run measures. Must be called first.
  void simulate_nominal();
  const std::vector<Eigen::VectorXd>& nominal(Passage passage) const;
  const std::vector<std::vector<std::size_t>>& repeats() const { return repeats_; }
  Variation unvaried() const { return {observations_.robot, {}}; }

  // Shifts for each variation. Empty vectors for runs that do not measure the stage.
  std::vector<Shift> shifts(std::span<const Variation> variations, Passage passage, Fidelity fidelity);
  // Shift of run r with variation r of `variations`, one for each run.
  Shift shift_of_each(std::span<const Variation> variations, Passage passage);
  // Simulates one run without noise by replaying its commands.
  runs::Run simulate(std::size_t run, const Variation& variation) const;
  // The features of every run's map in the replay of a stage, for run r with variation r of `variations`.
  std::vector<Eigen::VectorXd> features_of_each(std::span<const Variation> variations, Passage passage);

  std::size_t roll_outs() const { return roll_outs_; }

 private:
  Replay replay_of(Passage passage, std::size_t run) const;
  const physics::WorldDescription& world_of(std::size_t run) const;
  const rollout::Manoeuvre& manoeuvre_of(Replay replay, std::size_t run) const;
  // The reports of variations that move alike.
  std::vector<runs::Run> simulate(Replay replay, std::size_t run, std::span<const Variation* const> variations) const;
  runs::Run simulate(Replay replay, std::size_t run, const Variation& variation) const;
  // Groups of roll-outs that move alike.
  std::vector<std::vector<RollOut>> alike_in_motion(const std::set<RollOut>& roll_outs) const;
  // Values of all stages that are compared in the replay, concatenated.
  Eigen::VectorXd values_in(Replay replay, std::size_t run, const runs::Run& simulated, double samples_late) const;
  // The same of roll-outs that move alike, one after the other.
  Eigen::VectorXd values_of_alike(const std::vector<RollOut>& roll_outs) const;
  StageValues by_stage(Replay replay, std::size_t run, const Eigen::VectorXd& values) const;
  // A run with a variation, given by its index.
  struct Asked {
    std::size_t run, variation;
  };
  std::vector<Eigen::VectorXd> values_of(std::span<const Asked> asked, std::span<const Variation> variations,
                                         Passage passage);
  // Each run with each variation, grouped by variation.
  std::vector<Eigen::VectorXd> values_of_all(std::span<const std::size_t> of_runs,
                                             std::span<const Variation> variations, Passage passage);
  // job(0) ... job(count - 1), distributed over all ranks and threads.
  std::vector<Eigen::VectorXd> all_of(std::size_t count, const std::function<Eigen::VectorXd(std::size_t)>& job);
  std::vector<Shift> shifts_of_groups(std::span<const Variation> variations, Passage passage, Fidelity fidelity);
  // Simulates each group's representative with a multiple of the time step.
  std::vector<Eigen::VectorXd> simulate_groups(std::span<const Variation> variations, Passage passage,
                                               double time_steps);
  Eigen::VectorXd alike(Passage passage, std::size_t from, const Eigen::VectorXd& shift, std::size_t to) const;

  const Observations& observations_;
  const ComparedFeatures& features_;
  std::vector<std::vector<std::size_t>> repeats_;
  std::vector<std::size_t> representatives_;  // of each group
  unsigned threads_;
  const std::atomic<bool>* stop_;
  Ranks ranks_;
  std::function<void(std::size_t)> progress_;
  std::array<std::vector<Eigen::VectorXd>, kPassages.size()> nominal_;  // of each stage
  std::vector<std::size_t> all_runs_;
  KnownRollOuts known_;
  std::size_t roll_outs_ = 0;
};

}  // namespace kenaf::gap::diagnose
