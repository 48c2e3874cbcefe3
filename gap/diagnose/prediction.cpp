#include "gap/diagnose/prediction.hpp"

#include <algorithm>
#include <atomic>
#include <map>
#include <set>
#include <thread>
#include <utility>

#include "gap/diagnose/repeats.hpp"
#include "gap/parallel.hpp"
#include "rollout/moves_alike.hpp"
#include "rollout/roll_out.hpp"

namespace kenaf::gap::diagnose {

using Eigen::Index;
using Eigen::VectorXd;

namespace {
// Factor on the time step: it hardly changes a shift, the difference of two simulations with equal steps.
constexpr double kCoarse = 2;
constexpr std::size_t kMostKnown_bytes = std::size_t{256} << 20;
}  // namespace

void check_goes_on(const std::atomic<bool>* stop) {
  if (stop != nullptr && *stop) throw Stopped();
}

ComparedFeatures compared_features(const Observations& observations, double span_s) {
  ComparedFeatures features;
  for (const Observation& observation : observations.runs) {
    features.maps.emplace_back(observation.run, span_s, observations.not_simulated);
    const auto time = observation.run.column("t_s");
    const double at_rest_s = observation.resting_rows < time.size() ? time[observation.resting_rows] : time.back();
    for (const Passage passage : kPassages) {
      StageFeatures& stage = features.of_stage[static_cast<std::size_t>(passage)].emplace_back(
          stage_features(passage, features.maps.back(), observation.run));
      stage.at_rest_s = at_rest_s;
    }
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
  for (std::size_t run = 0; run < observations_.runs.size(); ++run) all_runs_.push_back(run);
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
    // a single rank may stop at once; several must stop together
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
  const Variation nominal = unvaried();
  for (const Passage passage : kPassages)
    nominal_[static_cast<std::size_t>(passage)] = values_of_all(all_runs_, {&nominal, 1}, passage);
}

const std::vector<VectorXd>& Predictor::nominal(Passage passage) const {
  return nominal_[static_cast<std::size_t>(passage)];
}

std::vector<runs::Run> Predictor::simulate(Replay replay, std::size_t run,
                                           std::span<const Variation* const> variations) const {
  const Variation& any = *variations.front();
  rollout::Manoeuvre manoeuvre = manoeuvre_of(replay, run);
  manoeuvre.start->x_m += any.start_x_m;
  manoeuvre.start->y_m += any.start_y_m;
  manoeuvre.start->yaw_rad += any.start_yaw_rad;
  rollout::RollOutOptions options;
  options.physics = any.physics;
  options.noise_scale = 0;
  options.mocap_noise_m = options.mocap_noise_rad = 0;
  std::vector<physics::RobotDescription> robots;
  for (const Variation* variation : variations) robots.push_back(variation->robot);
  std::vector<runs::Run> result;
  for (rollout::RollOut& roll_out : rollout::roll_outs(robots, world_of(run), manoeuvre, options))
    result.push_back(std::move(roll_out.run));
  return result;
}

runs::Run Predictor::simulate(Replay replay, std::size_t run, const Variation& variation) const {
  const Variation* const one = &variation;
  return std::move(simulate(replay, run, {&one, 1}).front());
}

runs::Run Predictor::simulate(std::size_t run, const Variation& variation) const {
  return simulate(Replay::commands, run, variation);
}

Replay Predictor::replay_of(Passage passage, std::size_t run) const {
  const bool by_commands = passage == Passage::command_to_drive || !observations_.runs[run].measured;
  return by_commands ? Replay::commands : Replay::belts;
}

const physics::WorldDescription& Predictor::world_of(std::size_t run) const {
  return observations_.worlds[observations_.runs[run].world];
}

const rollout::Manoeuvre& Predictor::manoeuvre_of(Replay replay, std::size_t run) const {
  const Observation& observed = observations_.runs[run];
  return replay == Replay::commands ? observed.replay : *observed.measured;
}

std::vector<VectorXd> Predictor::features_of_each(std::span<const Variation> variations, Passage passage) {
  return all_of(observations_.runs.size(), [&](std::size_t run) {
    return features_.maps[run].of(simulate(replay_of(passage, run), run, variations[run]));
  });
}

VectorXd Predictor::values_in(Replay replay, std::size_t run, const runs::Run& simulated, double samples_late) const {
  const FeatureMap& map = features_.maps[run];
  const VectorXd features = map.of(simulated, samples_late);
  VectorXd all;
  for (const Passage passage : kPassages) {
    const StageFeatures& stage = features_.of(passage)[run];
    if (replay_of(passage, run) != replay || stage.bins.empty()) continue;
    const VectorXd values = stage_values(passage, stage, map, features, simulated);
    all.conservativeResize(all.size() + values.size());
    all.tail(values.size()) = values;
  }
  return all;
}

VectorXd Predictor::values_of_alike(const std::vector<RollOut>& roll_outs) const {
  const Replay replay = roll_outs.front().replay;
  const std::size_t run = roll_outs.front().run;
  std::vector<const Variation*> variations;
  for (const RollOut& one : roll_outs) variations.push_back(&known_.variation(one.variation));
  const std::vector<runs::Run> reports = simulate(replay, run, variations);
  VectorXd all;
  for (std::size_t i = 0; i < reports.size(); ++i) {
    const VectorXd values = values_in(replay, run, reports[i], variations[i]->samples_late);
    if (i == 0) all.resize(std::ssize(reports) * values.size());
    all.segment(static_cast<Index>(i) * values.size(), values.size()) = values;
  }
  return all;
}

StageValues Predictor::by_stage(Replay replay, std::size_t run, const VectorXd& values) const {
  StageValues of_stage;
  Index first = 0;
  for (const Passage passage : kPassages) {
    if (replay_of(passage, run) != replay) continue;
    const Index count = std::ssize(features_.of(passage)[run].bins);
    of_stage[static_cast<std::size_t>(passage)] = values.segment(first, count);
    first += count;
  }
  return of_stage;
}

std::vector<std::vector<RollOut>> Predictor::alike_in_motion(const std::set<RollOut>& roll_outs) const {
  std::vector<std::vector<RollOut>> groups;
  std::vector<Variation> moving;  // of each group of the present run
  std::size_t first = 0;          // group of the present run
  for (const RollOut& one : roll_outs) {
    const bool is_next_run =
        groups.empty() || groups.back().front().replay != one.replay || groups.back().front().run != one.run;
    if (is_next_run) moving.clear(), first = groups.size();
    Variation variation = known_.variation(one.variation);
    variation.robot =
        rollout::as_it_moves(std::move(variation.robot), world_of(one.run), manoeuvre_of(one.replay, one.run));
    variation.samples_late = 0;
    const auto place = static_cast<std::size_t>(std::ranges::find(moving, variation) - moving.begin());
    if (place == moving.size()) {
      moving.push_back(std::move(variation));
      groups.emplace_back();
    }
    groups[first + place].push_back(one);
  }
  return groups;
}

std::vector<VectorXd> Predictor::values_of(std::span<const Asked> asked, std::span<const Variation> variations,
                                           Passage passage) {
  // a variation is known by its number; the cache is emptied when too large
  if (known_.bytes() > kMostKnown_bytes) known_.forget();
  std::vector<std::size_t> numbers;
  for (const Variation& variation : variations) numbers.push_back(known_.number_of(variation));
  const auto roll_out_of = [&](const Asked& one) {
    return RollOut{replay_of(passage, one.run), one.run, numbers[one.variation]};
  };
  const auto is_measured = [&](std::size_t run) { return !features_.of(passage)[run].bins.empty(); };

  // unknown roll-outs, each once, and of those that move alike one simulation
  std::set<RollOut> unknown;
  for (const Asked& one : asked)
    if (is_measured(one.run) && known_.find(roll_out_of(one)) == nullptr) unknown.insert(roll_out_of(one));
  const std::vector<std::vector<RollOut>> jobs = alike_in_motion(unknown);
  const std::vector<VectorXd> simulated = all_of(jobs.size(), [&](std::size_t i) { return values_of_alike(jobs[i]); });
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    const Index size = simulated[i].size() / std::ssize(jobs[i]);
    for (std::size_t k = 0; k < jobs[i].size(); ++k)
      known_.add(jobs[i][k],
                 by_stage(jobs[i][k].replay, jobs[i][k].run, simulated[i].segment(static_cast<Index>(k) * size, size)));
  }
  roll_outs_ += unknown.size() - jobs.size();

  // the stage's part of each roll-out
  std::vector<VectorXd> values(asked.size());
  for (std::size_t i = 0; i < asked.size(); ++i)
    if (is_measured(asked[i].run)) values[i] = (*known_.find(roll_out_of(asked[i])))[static_cast<std::size_t>(passage)];
  return values;
}

std::vector<VectorXd> Predictor::values_of_all(std::span<const std::size_t> of_runs,
                                               std::span<const Variation> variations, Passage passage) {
  std::vector<Asked> asked;
  for (std::size_t v = 0; v < variations.size(); ++v)
    for (const std::size_t run : of_runs) asked.push_back({run, v});
  return values_of(asked, variations, passage);
}

// Bins at times that the other run lacks hold the last shift before them: a longer run ends at rest.
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
  return values_of_all(representatives_, varied, passage);
}

std::vector<Shift> Predictor::shifts_of_groups(std::span<const Variation> variations, Passage passage,
                                               Fidelity fidelity) {
  // a shift is the difference of two simulations with the same time step
  const double time_steps = fidelity == Fidelity::coarse ? kCoarse : 1;
  const Variation unvaried_robot = unvaried();
  const std::vector<VectorXd> nominal = simulate_groups({&unvaried_robot, 1}, passage, time_steps);
  const std::vector<VectorXd> simulated = simulate_groups(variations, passage, time_steps);
  const std::size_t groups = representatives_.size();
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
  const std::vector<VectorXd> simulated = values_of_all(all_runs_, variations, passage);
  std::vector<Shift> result(variations.size(), Shift(runs));
  for (std::size_t job = 0; job < simulated.size(); ++job)
    result[job / runs][job % runs] = simulated[job] - nominal(passage)[job % runs];
  return result;
}

Shift Predictor::shift_of_each(std::span<const Variation> variations, Passage passage) {
  std::vector<Asked> asked;
  for (const std::size_t run : all_runs_) asked.push_back({run, run});
  Shift result = values_of(asked, variations, passage);
  for (std::size_t run = 0; run < result.size(); ++run) result[run] -= nominal(passage)[run];
  return result;
}

}  // namespace kenaf::gap::diagnose
