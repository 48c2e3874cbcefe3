#include "gap/diagnose/prediction.hpp"

#include <map>
#include <utility>

#include "gap/diagnose/repeats.hpp"
#include "gap/parallel.hpp"
#include "rollout/roll_out.hpp"

namespace kenaf::gap {

using Eigen::Index;
using Eigen::VectorXd;

namespace {
constexpr double kCoarse = 2;  // time steps: a shift, the difference of two simulations with the same step, hardly changes
}

Predictor::Predictor(const Observations& observations, const std::vector<FeatureMap>& features,
                     std::vector<std::vector<std::size_t>> repeats, unsigned threads,
                     const std::atomic<bool>* stop)
    : observations_(observations),
      features_(features),
      repeats_(std::move(repeats)),
      threads_(threads),
      stop_(stop) {
  for (const std::vector<std::size_t>& group : repeats_)
    representatives_.push_back(representative(observations_, group));
}

void Predictor::simulate_nominal() {
  nominal_.resize(observations_.runs.size());
  for_each_job(nominal_.size(), threads_, [&](std::size_t run) { nominal_[run] = features_of(run, unvaried()); });
  roll_outs_ += nominal_.size();
}

runs::Run Predictor::simulate(const rollout::Manoeuvre& as_recorded, std::size_t run,
                              const Variation& variation) const {
  if (stop_ != nullptr && *stop_) throw Stopped();
  physics::RobotDescription robot = observations_.robot;
  robot.effects = variation.effects;
  rollout::Manoeuvre replay = as_recorded;
  replay.start->x_m += variation.start_x_m;
  replay.start->y_m += variation.start_y_m;
  replay.start->yaw_rad += variation.start_yaw_rad;
  rollout::RollOutOptions options;
  options.physics = variation.physics;
  options.noise_scale = 0;
  options.mocap_noise_m = options.mocap_noise_rad = 0;
  return rollout::roll_out(robot, observations_.worlds[observations_.runs[run].world], replay, options).run;
}

runs::Run Predictor::simulate(std::size_t run, const Variation& variation) const {
  return simulate(observations_.runs[run].replay, run, variation);
}

std::vector<VectorXd> Predictor::nominal_with_measured_drives() {
  std::vector<VectorXd> result(observations_.runs.size());
  for_each_job(result.size(), threads_, [&](std::size_t run) {
    if (const auto& measured = observations_.runs[run].measured)
      result[run] = features_[run].of(simulate(*measured, run, unvaried()));
  });
  roll_outs_ += result.size();
  return result;
}

VectorXd Predictor::features_of(std::size_t run, const Variation& variation) const {
  return features_[run].of(simulate(run, variation));
}

// Bins at times that the other run does not have keep what the last one before them has: a run that lasts longer rests.
VectorXd Predictor::alike(std::size_t from, const VectorXd& shift, std::size_t to) const {
  if (from == to) return shift;
  const auto from_bins = features_[from].bins(), to_bins = features_[to].bins();
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

std::vector<Shift> Predictor::shifts_of_representatives(std::span<const Variation> variations,
                                                        const std::vector<VectorXd>& nominal) {
  const std::size_t groups = representatives_.size();
  std::vector<Shift> result(variations.size(), Shift(nominal_.size()));
  for_each_job(variations.size() * groups, threads_, [&](std::size_t job) {
    const std::size_t variation = job / groups, run = representatives_[job % groups];
    result[variation][run] = features_of(run, variations[variation]) - nominal[run];
  });
  roll_outs_ += variations.size() * groups;
  for (Shift& shift : result)
    for (std::size_t g = 0; g < groups; ++g)
      for (const std::size_t r : repeats_[g])
        if (r != representatives_[g]) shift[r] = alike(representatives_[g], shift[representatives_[g]], r);
  return result;
}

std::vector<Shift> Predictor::shifts(std::span<const Variation> variations, Fidelity fidelity) {
  if (fidelity == Fidelity::representatives) return shifts_of_representatives(variations, nominal_);
  if (fidelity == Fidelity::coarse) {
    std::vector<Variation> coarse(variations.begin(), variations.end());
    for (Variation& variation : coarse) variation.physics.time_step_s *= kCoarse;
    if (coarse_nominal_.empty()) {
      coarse_nominal_.resize(nominal_.size());
      Variation unvaried_coarse = unvaried();
      unvaried_coarse.physics.time_step_s *= kCoarse;
      for_each_job(representatives_.size(), threads_, [&](std::size_t g) {
        coarse_nominal_[representatives_[g]] = features_of(representatives_[g], unvaried_coarse);
      });
      roll_outs_ += representatives_.size();
    }
    return shifts_of_representatives(coarse, coarse_nominal_);
  }
  std::vector<Shift> result(variations.size(), Shift(nominal_.size()));
  for_each_job(variations.size() * nominal_.size(), threads_, [&](std::size_t job) {
    const std::size_t variation = job / nominal_.size(), run = job % nominal_.size();
    result[variation][run] = features_of(run, variations[variation]) - nominal_[run];
  });
  roll_outs_ += variations.size() * nominal_.size();
  return result;
}

Shift Predictor::shift_of_each(std::span<const Variation> variations) {
  Shift result(nominal_.size());
  for_each_job(nominal_.size(), threads_,
               [&](std::size_t run) { result[run] = features_of(run, variations[run]) - nominal_[run]; });
  roll_outs_ += nominal_.size();
  return result;
}

}  // namespace kenaf::gap
