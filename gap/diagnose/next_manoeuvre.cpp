#include "gap/diagnose/next_manoeuvre.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <tuple>

#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/features.hpp"
#include "gap/diagnose/prediction.hpp"
#include "gap/diagnose/separation.hpp"
#include "gap/parallel.hpp"

namespace kenaf::gap::diagnose {
namespace {

constexpr double kLongestProposed_s = 40;  // chosen: longer ones are driven in parts
constexpr std::size_t kWanted = 3;         // sufficient manoeuvres for a report
constexpr std::size_t kBatch = 3;          // manoeuvres at a time, whatever the threads
constexpr double kNothing = 1;             // standard deviations: less is no meaningful separation

rollout::RollOutOptions without_noise() {
  rollout::RollOutOptions options;
  options.noise_scale = options.mocap_noise_m = options.mocap_noise_rad = 0;
  return options;
}

// The simulator with another time step: the difference is its own uncertainty.
rollout::RollOutOptions coarse() {
  rollout::RollOutOptions options = without_noise();
  options.physics.time_step_s *= 2;
  return options;
}

// One manoeuvre and the nominal robot's motion in it.
struct ManoeuvreToTry {
  rollout::Manoeuvre manoeuvre;
  physics::WorldDescription world;
  bool is_flat;
  runs::Run plain{};
  double duration_s = 0;
  Risk risk{};
  Gentleness gentleness = Gentleness::flat_driving;
};

bool can_drive(const physics::RobotDescription& robot, const rollout::Manoeuvre& manoeuvre) {
  const bool has_flipper_angles =
      std::ranges::any_of(manoeuvre.phases, [](const rollout::Phase& phase) { return phase.flipper_rad.has_value(); });
  return robot.has_flippers() || !has_flipper_angles;
}

std::vector<ManoeuvreToTry> candidates_for(const physics::RobotDescription& nominal) {
  std::vector<ManoeuvreToTry> candidates;
  for (rollout::Manoeuvre& manoeuvre : rollout::shipped_manoeuvres()) {
    if (manoeuvre.at_most_s() > kLongestProposed_s || !can_drive(nominal, manoeuvre)) continue;
    std::vector<std::string> ignored;
    physics::WorldDescription world = physics::load_world(manoeuvre.world, ignored);
    const bool is_flat = is_level(world) && manoeuvre.start_lift_m == 0;
    candidates.push_back({std::move(manoeuvre), std::move(world), is_flat});
  }
  return candidates;
}

class Proposer {
 public:
  Proposer(const physics::RobotDescription& nominal, std::span<const RivalModel> rivals, const ProposalOptions& options)
      : nominal_(nominal), rivals_(rivals), options_(options) {
    for (const RivalModel& rival : rivals) models_.push_back({&rival.fitted, false});
    for (const RivalModel& rival : rivals) {
      first_moved_.push_back(models_.size());
      for (const physics::RobotDescription& moved : rival.moved) models_.push_back({&moved, false});
    }
    first_moved_.push_back(models_.size());
    for (const RivalModel& rival : rivals) models_.push_back({&rival.fitted, true});
  }

  // Tries `candidates` class by class up to `roughest`, as driven by the nominal robot, and leaves rougher ones in the
  // list. Returns whether one suffices that is as gentle as its class.
  bool try_up_to(Gentleness roughest, std::vector<ManoeuvreToTry>& candidates) {
    drive_nominal(candidates);
    std::erase_if(candidates,
                  [](const ManoeuvreToTry& candidate) { return candidate.gentleness == Gentleness::fails; });
    std::ranges::stable_sort(candidates, {}, [](const ManoeuvreToTry& candidate) {
      return std::tuple(candidate.gentleness, candidate.duration_s);
    });
    auto begin = candidates.begin();
    while (begin != candidates.end() && begin->gentleness <= roughest) {
      const Gentleness asked = begin->gentleness;
      const auto end = std::ranges::find_if(
          begin, candidates.end(), [asked](const ManoeuvreToTry& candidate) { return candidate.gentleness != asked; });
      while (begin != end && sufficient(asked) < kWanted) {
        const auto size = std::min(std::ptrdiff_t{kBatch}, end - begin);
        try_batch({begin, begin + size});
        begin += size;
      }
      if (sufficient(asked) > 0) return true;
      begin = end;
    }
    candidates.erase(candidates.begin(), begin);
    return false;
  }

  std::vector<ProposedManoeuvre> take() {
    std::ranges::stable_sort(proposed_, {}, [](const ProposedManoeuvre& proposed) {
      return proposed.suffices ? std::tuple(0, static_cast<int>(proposed.gentleness), proposed.duration_s)
                               : std::tuple(1, proposed.risk.fails ? 1 : 0, -proposed.expected_score);
    });
    return std::move(proposed_);
  }

 private:
  // Number of sufficient manoeuvres at least as gentle as `asked`: rivals may have made a candidate rougher than it
  // was.
  std::size_t sufficient(Gentleness asked) const {
    return static_cast<std::size_t>(std::ranges::count_if(proposed_, [asked](const ProposedManoeuvre& proposed) {
      return proposed.suffices && proposed.gentleness <= asked;
    }));
  }

  rollout::RollOut driven(const physics::RobotDescription& robot, const ManoeuvreToTry& candidate) const {
    return rollout::roll_out(with_exact_sensors(robot), candidate.world, candidate.manoeuvre, without_noise());
  }

  void drive_nominal(std::vector<ManoeuvreToTry>& candidates) const {
    for_each_job(candidates.size(), options_.threads, [&](std::size_t i) {
      check_goes_on(options_.stop);
      ManoeuvreToTry& candidate = candidates[i];
      if (candidate.plain.row_count() > 0) return;  // driven before
      rollout::RollOut out = driven(nominal_, candidate);
      candidate.risk = risk_of(out, candidate.manoeuvre, nominal_);
      candidate.plain = std::move(out.run);
      candidate.duration_s = candidate.plain.column("t_s").back();
      candidate.gentleness = gentleness(candidate.manoeuvre, candidate.is_flat, candidate.risk);
    });
  }

  // One candidate with all rivals.
  struct Trial {
    const ManoeuvreToTry& candidate;
    FeatureMap map;
    rollout::Manoeuvre replay;              // of the nominal robot's commands
    std::vector<Eigen::VectorXd> features;  // of each model under them
    std::vector<char> fault;                // of each model
    std::vector<double> duration_s;         // of each rival, driven by its operator
    std::vector<Risk> risk;                 // likewise
    double score = 0;
  };

  // Tries a few candidates in parallel.
  void try_batch(std::span<const ManoeuvreToTry> batch) {
    std::vector<Trial> trials;
    for (const ManoeuvreToTry& candidate : batch)
      trials.push_back({candidate, FeatureMap(candidate.plain, options_.span_s),
                        rollout::replay_of(candidate.plain, candidate.manoeuvre.name),
                        std::vector<Eigen::VectorXd>(models_.size()), std::vector<char>(models_.size(), 0),
                        std::vector<double>(rivals_.size(), 0), std::vector<Risk>(rivals_.size())});
    const std::size_t rivals = rivals_.size(), first_coarse = first_moved_.back();
    for_each_job(trials.size() * rivals, options_.threads,
                 [&](std::size_t job) { replay(trials[job / rivals], first_coarse + job % rivals); });
    // Refitting values only brings rivals closer, so those too close before are excluded, at a sixth of the cost: a
    // coarse time step suffices, as it hardly changes a difference.
    std::vector<Trial*> promising;
    for (Trial& trial : trials) {
      trial.score = least_separation(trial, false);
      if (trial.score >= options_.suffices_at) promising.push_back(&trial);
    }
    const std::size_t of_each = rivals + first_coarse;
    for_each_job(promising.size() * of_each, options_.threads, [&](std::size_t job) {
      Trial& trial = *promising[job / of_each];
      const std::size_t which = job % of_each;
      if (which < rivals)
        drive_rival(trial, which);
      else
        replay(trial, which - rivals);
    });
    for (Trial* trial : promising) trial->score = least_separation(*trial, true);
    for (const Trial& trial : trials) add(trial);
  }

  void replay(Trial& trial, std::size_t model) const {
    check_goes_on(options_.stop);
    const auto& [robot, is_coarse] = models_[model];
    const rollout::RollOut out =
        rollout::roll_out(*robot, trial.candidate.world, trial.replay, is_coarse ? coarse() : without_noise());
    trial.features[model] = trial.map.of(out.run);
    trial.fault[model] = out.fault.empty() ? 0 : 1;
  }

  void drive_rival(Trial& trial, std::size_t rival) const {
    check_goes_on(options_.stop);
    const rollout::RollOut out = driven(rivals_[rival].fitted, trial.candidate);
    trial.duration_s[rival] = out.run.column("t_s").back();
    trial.risk[rival] = risk_of(out, trial.candidate.manoeuvre, nominal_);
  }

  void add(const Trial& trial) {
    const ManoeuvreToTry& candidate = trial.candidate;
    ProposedManoeuvre proposed{.manoeuvre = candidate.manoeuvre.name,
                               .world = candidate.manoeuvre.world,
                               .duration_s = std::max(candidate.duration_s, std::ranges::max(trial.duration_s)),
                               .expected_score = trial.score,
                               .suffices = false,
                               .is_flat = candidate.is_flat,
                               .gentleness = Gentleness::fails,
                               .risk = candidate.risk};
    for (const Risk& risk : trial.risk) proposed.risk = worst_of(proposed.risk, risk);
    if (std::ranges::count(trial.fault, 1) > 0) proposed.risk.fails = true;
    proposed.gentleness = gentleness(candidate.manoeuvre, candidate.is_flat, proposed.risk);
    proposed.suffices = proposed.expected_score >= options_.suffices_at && !proposed.risk.fails;
    proposed_.push_back(std::move(proposed));
  }

  // `changing`: refits values and discounts differences within the time step's uncertainty; else everything is coarse.
  double least_separation(const Trial& trial, bool changing) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t a = 0; a < rivals_.size(); ++a)
      for (std::size_t b = a + 1; b < rivals_.size(); ++b)
        least = std::min(least, separation_of(a, b, trial, changing));
    return least;
  }

  double separation_of(std::size_t a, std::size_t b, const Trial& trial, bool changing) const {
    const auto count = static_cast<Eigen::Index>(trial.map.bins().size());
    const std::size_t first_coarse = first_moved_.back(), first = changing ? 0 : first_coarse;
    const Eigen::VectorXd difference = trial.features[first + a] - trial.features[first + b];
    Eigen::MatrixXd open = Eigen::MatrixXd::Zero(count, 2), free(count, 0);
    if (changing) {
      open.col(0) = trial.features[first_coarse + a] - trial.features[a];
      open.col(1) = trial.features[first_coarse + b] - trial.features[b];
      free.resize(count, static_cast<Eigen::Index>(rivals_[a].moved.size() + rivals_[b].moved.size()));
      Eigen::Index column = 0;
      for (const std::size_t rival : {a, b})
        for (std::size_t moved = first_moved_[rival]; moved < first_moved_[rival + 1]; ++moved)
          free.col(column++) = trial.features[moved] - trial.features[rival];
    }
    const std::size_t until = first_other_outcome(difference, trial.map);
    Eigen::VectorXd per_sigma = Eigen::VectorXd::Zero(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const Bin& bin = trial.map.bins()[static_cast<std::size_t>(i)];
      const double sigma = options_.sigma_of_channel[bin.channel];
      if (sigma > 0 && bin.span < until) per_sigma[i] = 1 / std::hypot(sigma, open(i, 0), open(i, 1));
    }
    return separation(per_sigma.cwiseProduct(difference), per_sigma.asDiagonal() * free);
  }

  // The first span in which two models' tilts differ too much to compare what follows; the maximum if there is none.
  static std::size_t first_other_outcome(const Eigen::VectorXd& difference, const FeatureMap& map) {
    std::size_t first = std::numeric_limits<std::size_t>::max();
    for (std::size_t i = 0; i < map.bins().size(); ++i) {
      const Bin& bin = map.bins()[i];
      const std::string_view column = diagnosis_channels()[bin.channel].column;
      if ((column == "roll_rad" || column == "pitch_rad") &&
          std::abs(difference[static_cast<Eigen::Index>(i)]) > kAnotherOutcome_rad)
        first = std::min(first, bin.span);
    }
    return first;
  }

  const physics::RobotDescription& nominal_;
  std::span<const RivalModel> rivals_;
  const ProposalOptions& options_;
  struct Model {
    const physics::RobotDescription* robot;
    bool is_coarse;
  };
  std::vector<Model> models_;             // each rival as fitted; all moved ones; each rival with a coarse time step
  std::vector<std::size_t> first_moved_;  // of each rival, and one past the last
  std::vector<ProposedManoeuvre> proposed_;
};

std::string risk_in_words(const Risk& risk) {
  if (risk.fails) return "the robot may turn over: do not drive it";
  std::string words = fmt::format("tilts by {:.0f} degrees", risk.largest_tilt_rad * 180 / std::numbers::pi);
  words += risk.fall_m < 0.005 ? ", no fall" : fmt::format(", falls by {:.0f} mm", risk.fall_m * 1000);
  if (risk.impact_mps2 > kImpact_mps2) words += fmt::format(", lands with {:.0f} m/s^2", risk.impact_mps2);
  if (risk.stuck) words += ", may get stuck or not arrive";
  if (risk.current_share > 0) words += fmt::format(", {:.0f} % of the stall current", risk.current_share * 100);
  return words;
}

}  // namespace

std::vector<ProposedManoeuvre> propose_manoeuvres(const physics::RobotDescription& nominal,
                                                  std::span<const RivalModel> rivals, const ProposalOptions& options) {
  if (options.sigma_of_channel.size() != diagnosis_channels().size())
    throw std::invalid_argument(fmt::format("sigma_of_channel: has {} numbers, there are {} channels",
                                            options.sigma_of_channel.size(), diagnosis_channels().size()));
  if (!(options.span_s > 0)) throw std::invalid_argument(fmt::format("span_s = {} must be above 0", options.span_s));
  if (rivals.size() < 2) return {};
  std::vector<ManoeuvreToTry> flat = candidates_for(nominal), others;
  const auto rough = std::stable_partition(flat.begin(), flat.end(), std::mem_fn(&ManoeuvreToTry::is_flat));
  std::move(rough, flat.end(), std::back_inserter(others));
  flat.erase(rough, flat.end());
  Proposer proposer(nominal, rivals, options);
  if (!proposer.try_up_to(Gentleness::flat_flippers, flat)) {
    std::ranges::move(flat, std::back_inserter(others));  // in which this robot falls or tilts on level ground
    proposer.try_up_to(Gentleness::falls_or_tilts, others);
  }
  return proposer.take();
}

std::string in_words(const ProposedManoeuvre& proposed) {
  const std::string ground = proposed.is_flat ? "flat ground" : "world " + proposed.world;
  std::string separates = fmt::format("separates them by {:.{}f} standard deviations", proposed.expected_score,
                                      proposed.suffices || proposed.risk.fails ? 0 : 1);
  if (!proposed.suffices && !proposed.risk.fails) separates += ", too little";
  return fmt::format("{} ({:.0f} s, {}): {}; {}", proposed.manoeuvre, proposed.duration_s, ground, separates,
                     risk_in_words(proposed.risk));
}

std::string advice_in_words(std::span<const ProposedManoeuvre> proposed) {
  if (proposed.empty()) return "there are no effects to distinguish, or no manoeuvre that this robot can drive";
  const ProposedManoeuvre& first = proposed.front();
  if (first.suffices) return "drive next: " + in_words(first);
  const std::string none =
      fmt::format("none of the {} shipped manoeuvres that this robot can drive suffices", proposed.size());
  if (first.expected_score < kNothing) return none + ": none of them distinguishes these effects";
  return none + "; the best of them: " + in_words(first);
}

}  // namespace kenaf::gap::diagnose
