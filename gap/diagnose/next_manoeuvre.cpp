#include "gap/diagnose/next_manoeuvre.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <tuple>

#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/features.hpp"
#include "gap/diagnose/prediction.hpp"
#include "gap/diagnose/separation.hpp"
#include "gap/parallel.hpp"

namespace kenaf::gap {
namespace {

constexpr double kLongestProposed_s = 40;  // chosen: what takes longer is driven in parts
constexpr std::size_t kWanted = 3;         // that suffice, for a report to name
constexpr std::size_t kBatch = 3;          // manoeuvres at a time, whatever the threads

rollout::RollOutOptions without_noise() {
  rollout::RollOutOptions options;
  options.noise_scale = options.mocap_noise_m = options.mocap_noise_rad = 0;
  return options;
}

// One manoeuvre and what the nominal robot does in it.
struct Candidate {
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

std::vector<Candidate> candidates_for(const physics::RobotDescription& nominal) {
  std::vector<Candidate> candidates;
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
    for (const RivalModel& rival : rivals) {
      first_model_.push_back(models_.size());
      models_.push_back(&rival.fitted);
      for (const physics::RobotDescription& moved : rival.moved) models_.push_back(&moved);
    }
    first_model_.push_back(models_.size());
  }

  // Whether any of `candidates` suffices.
  bool try_all(std::vector<Candidate> candidates) {
    drive_nominal(candidates);
    std::erase_if(candidates, [](const Candidate& candidate) { return candidate.gentleness == Gentleness::fails; });
    std::ranges::stable_sort(candidates, {}, [](const Candidate& candidate) {
      return std::tuple(candidate.gentleness, candidate.duration_s);
    });
    for (auto begin = candidates.begin(); begin != candidates.end();) {
      const Gentleness asked = begin->gentleness;
      const auto end = std::ranges::find_if(
          begin, candidates.end(), [asked](const Candidate& candidate) { return candidate.gentleness != asked; });
      while (begin != end && sufficient(asked) < kWanted) {
        const auto size = std::min(std::ptrdiff_t{kBatch}, end - begin);
        try_batch({begin, begin + size});
        begin += size;
      }
      if (sufficient(asked) > 0) return true;
      begin = end;
    }
    return std::ranges::any_of(proposed_, &ProposedManoeuvre::suffices);
  }

  std::vector<ProposedManoeuvre> take() {
    std::ranges::stable_sort(proposed_, {}, [](const ProposedManoeuvre& proposed) {
      return proposed.suffices ? std::tuple(0, static_cast<int>(proposed.gentleness), proposed.duration_s)
                               : std::tuple(1, proposed.risk.fails ? 1 : 0, -proposed.expected_score);
    });
    return std::move(proposed_);
  }

 private:
  // What it found to suffice that is as gentle as `asked` or gentler: rivals may have made a candidate rougher than it
  // was.
  std::size_t sufficient(Gentleness asked) const {
    return static_cast<std::size_t>(std::ranges::count_if(proposed_, [asked](const ProposedManoeuvre& proposed) {
      return proposed.suffices && proposed.gentleness <= asked;
    }));
  }

  rollout::RollOut driven(const physics::RobotDescription& robot, const Candidate& candidate) const {
    return rollout::roll_out(with_exact_sensors(robot), candidate.world, candidate.manoeuvre, without_noise());
  }

  void drive_nominal(std::vector<Candidate>& candidates) const {
    for_each_job(candidates.size(), options_.threads, [&](std::size_t i) {
      check_goes_on(options_.stop);
      Candidate& candidate = candidates[i];
      rollout::RollOut out = driven(nominal_, candidate);
      candidate.risk = risk_of(out, nominal_);
      candidate.plain = std::move(out.run);
      candidate.duration_s = candidate.plain.column("t_s").back();
      candidate.gentleness = gentleness(candidate.manoeuvre, candidate.is_flat, candidate.risk);
    });
  }

  struct Driven {
    double duration_s;
    Risk risk;
  };
  struct Replayed {
    Eigen::VectorXd features;
    bool fault;
  };

  // All simulations of a few manoeuvres side by side: each rival driven, then each model under the nominal commands.
  void try_batch(std::span<const Candidate> batch) {
    std::vector<FeatureMap> maps;
    std::vector<rollout::Manoeuvre> replays;
    for (const Candidate& candidate : batch) {
      maps.emplace_back(candidate.plain, options_.span_s);
      replays.push_back(rollout::replay_of(candidate.plain, candidate.manoeuvre.name));
    }
    const std::size_t of_each = rivals_.size() + models_.size();
    std::vector<Driven> driven_by(batch.size() * rivals_.size());
    std::vector<Replayed> replayed(batch.size() * models_.size());
    for_each_job(batch.size() * of_each, options_.threads, [&](std::size_t job) {
      check_goes_on(options_.stop);
      const std::size_t c = job / of_each, which = job % of_each;
      if (which < rivals_.size()) {
        const rollout::RollOut out = driven(rivals_[which].fitted, batch[c]);
        driven_by[c * rivals_.size() + which] = {out.run.column("t_s").back(), risk_of(out, nominal_)};
      } else {
        const std::size_t model = which - rivals_.size();
        const rollout::RollOut out = rollout::roll_out(*models_[model], batch[c].world, replays[c], without_noise());
        replayed[c * models_.size() + model] = {maps[c].of(out.run), !out.fault.empty()};
      }
    });
    for (std::size_t c = 0; c < batch.size(); ++c)
      add(batch[c], maps[c], std::span(driven_by).subspan(c * rivals_.size(), rivals_.size()),
          std::span(replayed).subspan(c * models_.size(), models_.size()));
  }

  void add(const Candidate& candidate, const FeatureMap& map, std::span<const Driven> driven_by,
           std::span<const Replayed> replayed) {
    ProposedManoeuvre proposed{.manoeuvre = candidate.manoeuvre.name,
                               .world = candidate.manoeuvre.world,
                               .duration_s = candidate.duration_s,
                               .expected_score = std::numeric_limits<double>::infinity(),
                               .suffices = false,
                               .is_flat = candidate.is_flat,
                               .gentleness = Gentleness::fails,
                               .risk = candidate.risk};
    for (const Driven& driven : driven_by) {
      proposed.duration_s = std::max(proposed.duration_s, driven.duration_s);
      proposed.risk = worst_of(proposed.risk, driven.risk);
    }
    for (const Replayed& replay : replayed) proposed.risk.fails = proposed.risk.fails || replay.fault;
    proposed.gentleness = gentleness(candidate.manoeuvre, candidate.is_flat, proposed.risk);
    for (std::size_t a = 0; a < rivals_.size(); ++a)
      for (std::size_t b = a + 1; b < rivals_.size(); ++b)
        proposed.expected_score = std::min(proposed.expected_score, separation_of(a, b, map, replayed));
    proposed.suffices = proposed.expected_score >= options_.suffices_at && !proposed.risk.fails;
    proposed_.push_back(std::move(proposed));
  }

  double separation_of(std::size_t a, std::size_t b, const FeatureMap& map, std::span<const Replayed> replayed) const {
    const Eigen::VectorXd& of_a = replayed[first_model_[a]].features;
    const Eigen::VectorXd& of_b = replayed[first_model_[b]].features;
    const std::size_t until = first_other_outcome(of_a - of_b, map);
    const auto count = static_cast<Eigen::Index>(map.bins().size());
    Eigen::VectorXd per_sigma = Eigen::VectorXd::Zero(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const Bin& bin = map.bins()[static_cast<std::size_t>(i)];
      const double sigma = options_.sigma_of_channel[bin.channel];
      if (sigma > 0 && bin.span < until) per_sigma[i] = 1 / sigma;
    }
    Eigen::MatrixXd free(count, static_cast<Eigen::Index>(rivals_[a].moved.size() + rivals_[b].moved.size()));
    Eigen::Index column = 0;
    for (const std::size_t rival : {a, b})
      for (std::size_t model = first_model_[rival] + 1; model < first_model_[rival + 1]; ++model)
        free.col(column++) = per_sigma.cwiseProduct(replayed[model].features - replayed[first_model_[rival]].features);
    return separation(per_sigma.cwiseProduct(of_a - of_b), free);
  }

  // The first span in which two models tilt so differently that what follows is another story; without one: none.
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
  std::vector<const physics::RobotDescription*> models_;  // of each rival as fitted, then its moved ones
  std::vector<std::size_t> first_model_;                  // of each rival, and one past the last
  std::vector<ProposedManoeuvre> proposed_;
};

std::string risk_in_words(const Risk& risk) {
  if (risk.fails) return "the robot may turn over or the simulation breaks off: not to be driven";
  std::string words = fmt::format("tilts by {:.0f} degrees", risk.largest_tilt_rad * 180 / std::numbers::pi);
  words += risk.fall_m < 0.005 ? ", no fall" : fmt::format(", falls by {:.0f} mm", risk.fall_m * 1000);
  if (risk.impact_mps2 > kImpact_mps2) words += fmt::format(", lands with {:.0f} m/s^2", risk.impact_mps2);
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
  std::vector<Candidate> candidates = candidates_for(nominal);
  const auto rough = std::ranges::stable_partition(candidates, &Candidate::is_flat);
  std::vector<Candidate> others(std::make_move_iterator(rough.begin()), std::make_move_iterator(rough.end()));
  candidates.erase(rough.begin(), rough.end());
  Proposer proposer(nominal, rivals, options);
  if (!proposer.try_all(std::move(candidates))) proposer.try_all(std::move(others));
  return proposer.take();
}

std::string in_words(const ProposedManoeuvre& proposed) {
  const std::string ground = proposed.is_flat ? "flat ground" : "world " + proposed.world;
  const std::string separates =
      proposed.suffices ? fmt::format("separates them by {:.0f} standard deviations", proposed.expected_score)
      : proposed.risk.fails
          ? fmt::format("would separate them by {:.1f} standard deviations", proposed.expected_score)
          : fmt::format("does not suffice, separates them by {:.1f} standard deviations only", proposed.expected_score);
  return fmt::format("{} ({:.0f} s, {}): {}; {}", proposed.manoeuvre, proposed.duration_s, ground, separates,
                     risk_in_words(proposed.risk));
}

std::string advice_in_words(std::span<const ProposedManoeuvre> proposed) {
  if (proposed.empty()) return "there is nothing to tell apart, or no manoeuvre that this robot can drive";
  if (proposed.front().suffices) return "drive next: " + in_words(proposed.front());
  return fmt::format("none of the {} shipped manoeuvres that this robot can drive suffices; nearest comes {}",
                     proposed.size(), in_words(proposed.front()));
}

}  // namespace kenaf::gap
