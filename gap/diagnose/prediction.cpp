#include "gap/diagnose/prediction.hpp"

#include <algorithm>
#include <atomic>
#include <map>
#include <thread>
#include <utility>

#include "gap/diagnose/repeats.hpp"
#include "gap/parallel.hpp"
#include "rollout/roll_out.hpp"

namespace kenaf::gap {

using Eigen::Index;
using Eigen::VectorXd;

namespace {
constexpr double kCoarse =
    2;  // time steps: a shift, the difference of two simulations with the same step, hardly changes
}

void check_goes_on(const std::atomic<bool>* stop) {
  if (stop != nullptr && *stop) throw Stopped();
}

ComparedFeatures compared_features(const Observations& observations, double span_s) {
  ComparedFeatures features;
  for (const Observation& observation : observations.runs) {
    features.maps.emplace_back(observation.run, span_s, observations.not_simulated);
    for (const Passage passage : kPassages)
      features.of_stage[static_cast<std::size_t>(passage)].push_back(
          stage_features(passage, features.maps.back(), observation.run));
  }
  return features;
}

Predictor::Predictor(const Observations& observations, const ComparedFeatures& features,
                     std::vector<std::vector<std::size_t>> repeats, unsigned threads, const std::atomic<bool>* stop,
                     Ranks ranks, std::function<void(std::size_t)> progress)
    : observations_(observations),
      features_(features),
      repeats_(std::move(repeats)),
      threads_(threads),
      stop_(stop),
      ranks_(std::move(ranks)),
      progress_(std::move(progress)) {
  for (const std::vector<std::size_t>& group : repeats_)
    representatives_.push_back(representative(observations_, group));
}

std::vector<VectorXd> Predictor::all_of(std::size_t count, const std::function<VectorXd(std::size_t)>& job) {
  const auto ranks = static_cast<std::size_t>(ranks_.count), rank = static_cast<std::size_t>(ranks_.rank);
  const bool stop = stop_ != nullptr && *stop_;
  if (ranks > 1 ? ranks_.any(stop) : stop) throw Stopped();
  std::vector<VectorXd> results(count);
  const std::size_t own = count / ranks + (rank < count % ranks ? 1 : 0);
  const std::thread::id asking = std::this_thread::get_id();
  std::atomic<std::size_t> done = 0;
  for_each_job(own, threads_, [&](std::size_t i) {
    // one rank alone may end at once; of several all end together
    if (ranks == 1) check_goes_on(stop_);
    results[rank + i * ranks] = job(rank + i * ranks);
    done += ranks;
    if (progress_ && std::this_thread::get_id() == asking) progress_(roll_outs_ + std::min<std::size_t>(done, count));
  });
  if (ranks > 1) ranks_.share(results);
  roll_outs_ += count;
  return results;
}

void Predictor::simulate_nominal() {
  for (const Passage passage : kPassages)
    nominal_[static_cast<std::size_t>(passage)] =
        all_of(observations_.runs.size(), [&](std::size_t run) { return values_of(run, unvaried(), passage); });
}

const std::vector<VectorXd>& Predictor::nominal(Passage passage) const {
  return nominal_[static_cast<std::size_t>(passage)];
}

runs::Run Predictor::simulate(const rollout::Manoeuvre& as_recorded, std::size_t run,
                              const Variation& variation) const {
  rollout::Manoeuvre replay = as_recorded;
  replay.start->x_m += variation.start_x_m;
  replay.start->y_m += variation.start_y_m;
  replay.start->yaw_rad += variation.start_yaw_rad;
  rollout::RollOutOptions options;
  options.physics = variation.physics;
  options.noise_scale = 0;
  options.mocap_noise_m = options.mocap_noise_rad = 0;
  return rollout::roll_out(variation.robot, observations_.worlds[observations_.runs[run].world], replay, options).run;
}

runs::Run Predictor::simulate(std::size_t run, const Variation& variation) const {
  return simulate(observations_.runs[run].replay, run, variation);
}

runs::Run Predictor::simulate_in(Passage passage, std::size_t run, const Variation& variation) const {
  const Observation& observed = observations_.runs[run];
  const bool by_commands = passage == Passage::command_to_drive || !observed.measured;
  return simulate(by_commands ? observed.replay : *observed.measured, run, variation);
}

std::vector<VectorXd> Predictor::features_of_each(std::span<const Variation> variations, Passage passage) {
  return all_of(observations_.runs.size(),
                [&](std::size_t run) { return features_.maps[run].of(simulate_in(passage, run, variations[run])); });
}

VectorXd Predictor::values_of(std::size_t run, const Variation& variation, Passage passage) const {
  const StageFeatures& stage = features_.of(passage)[run];
  if (stage.bins.empty()) return {};
  const runs::Run simulated = simulate_in(passage, run, variation);
  const FeatureMap& map = features_.maps[run];
  return stage_values(passage, stage, map, map.of(simulated, variation.samples_late), simulated);
}

// Bins at times that the other run does not have keep what the last one before them has: a run that lasts longer rests.
VectorXd Predictor::alike(Passage passage, std::size_t from, const VectorXd& shift, std::size_t to) const {
  if (from == to) return shift;
  const std::vector<Bin>&from_bins = features_.of(passage)[from].bins, &to_bins = features_.of(passage)[to].bins;
  std::map<std::pair<std::size_t, std::size_t>, double> known;
  for (std::size_t b = 0; b < from_bins.size(); ++b)
    known[{from_bins[b].channel, from_bins[b].span}] = shift[static_cast<Index>(b)];
  VectorXd result = VectorXd::Zero(static_cast<Index>(to_bins.size()));
  for (std::size_t b = 0; b < to_bins.size(); ++b) {
    auto after = known.upper_bound({to_bins[b].channel, to_bins[b].span});
    if (after != known.begin() && std::prev(after)->first.first == to_bins[b].channel)
      result[static_cast<Index>(b)] = std::prev(after)->second;
  }
  return result;
}

std::vector<VectorXd> Predictor::simulate_groups(std::span<const Variation> variations, Passage passage,
                                                 double time_steps) {
  std::vector<Variation> varied(variations.begin(), variations.end());
  for (Variation& variation : varied) variation.physics.time_step_s *= time_steps;
  const std::size_t groups = representatives_.size();
  return all_of(varied.size() * groups, [&](std::size_t job) {
    return values_of(representatives_[job % groups], varied[job / groups], passage);
  });
}

std::vector<Shift> Predictor::shifts_of_groups(std::span<const Variation> variations, Passage passage,
                                               Fidelity fidelity) {
  // a shift is the difference of two simulations with the same time step
  const auto stage = static_cast<std::size_t>(passage);
  const std::size_t groups = representatives_.size();
  std::vector<VectorXd> nominal;
  if (fidelity == Fidelity::coarse && coarse_nominal_[stage].empty()) {
    const Variation unvaried_robot = unvaried();
    coarse_nominal_[stage] = simulate_groups({&unvaried_robot, 1}, passage, kCoarse);
  }
  for (std::size_t group = 0; group < groups; ++group)
    nominal.push_back(fidelity == Fidelity::coarse ? coarse_nominal_[stage][group]
                                                   : nominal_[stage][representatives_[group]]);
  const std::vector<VectorXd> simulated =
      simulate_groups(variations, passage, fidelity == Fidelity::coarse ? kCoarse : 1);
  std::vector<Shift> result(variations.size(), Shift(observations_.runs.size()));
  for (std::size_t job = 0; job < simulated.size(); ++job) {
    const std::size_t group = job % groups;
    const VectorXd shift = simulated[job] - nominal[group];
    for (const std::size_t run : repeats_[group])
      result[job / groups][run] = alike(passage, representatives_[group], shift, run);
  }
  return result;
}

std::vector<Shift> Predictor::shifts(std::span<const Variation> variations, Passage passage, Fidelity fidelity) {
  if (fidelity != Fidelity::every_run) return shifts_of_groups(variations, passage, fidelity);
  const std::size_t runs = observations_.runs.size();
  const std::vector<VectorXd> simulated = all_of(variations.size() * runs, [&](std::size_t job) {
    return values_of(job % runs, variations[job / runs], passage);
  });
  std::vector<Shift> result(variations.size(), Shift(runs));
  for (std::size_t job = 0; job < simulated.size(); ++job)
    result[job / runs][job % runs] = simulated[job] - nominal(passage)[job % runs];
  return result;
}

Shift Predictor::shift_of_each(std::span<const Variation> variations, Passage passage) {
  Shift result =
      all_of(observations_.runs.size(), [&](std::size_t run) { return values_of(run, variations[run], passage); });
  for (std::size_t run = 0; run < result.size(); ++run) result[run] -= nominal(passage)[run];
  return result;
}

}  // namespace kenaf::gap
