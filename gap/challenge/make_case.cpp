#include "gap/challenge/make_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "gap/challenge/compared_runs.hpp"
#include "gap/challenge/foreign.hpp"
#include "gap/challenge/judge.hpp"
#include "gap/challenge/look_alike.hpp"
#include "gap/parallel.hpp"
#include "gap/temporary_folder.hpp"
#include "physics/effects.hpp"
#include "rollout/roll_out.hpp"
#include "runs/dataset.hpp"

namespace kenaf::gap {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRobot = "kenaf";
constexpr int kHalvings = 12;
constexpr double kSmallestShare = 1e-5, kCloseEnough = 1.05;
constexpr double kSmallestPlay = 0.01;  // 3 mrad of backlash: of less there is little but the give of the teeth
constexpr double kCloseToPlanned = 0.9;

struct Work {
  unsigned jobs;
  const std::atomic<bool>* stop;  // may be null
};

struct Recipe {
  physics::Effects effects;
  std::string foreign;
  double foreign_amount = 0;
};

std::uint64_t mixed(std::uint64_t seed, std::uint64_t with) {
  std::seed_seq sequence{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                         static_cast<std::uint32_t>(with)};
  std::uint32_t words[2];
  sequence.generate(words, words + 2);
  return std::uint64_t{words[0]} << 32 | words[1];
}

// Noise that remembers itself, on top of the white one: pose estimates are filtered.
void add_coloured_noise(runs::Run& run, const CasePlan& plan, std::uint64_t seed) {
  if (plan.noise_memory_s == 0) return;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const std::span<const double> time = run.column("t_s");
  const double period_s = (time.back() - time.front()) / static_cast<double>(time.size() - 1);
  const double keep = std::exp(-period_s / plan.noise_memory_s);
  const rollout::RollOutOptions usual;
  for (const auto& [name, sigma] : {std::pair{"x_m", usual.mocap_noise_m}, std::pair{"y_m", usual.mocap_noise_m},
                                    std::pair{"z_m", usual.mocap_noise_m}, std::pair{"yaw_rad", usual.mocap_noise_rad}})
    for (std::size_t c = 0; c < run.columns.size(); ++c) {
      if (run.columns[c] != name) continue;
      double wander = normal(random);
      for (double& value : run.values[c]) {
        value += plan.noise_scale * sigma * wander;
        wander = keep * wander + std::sqrt(1 - keep * keep) * normal(random);
      }
    }
}

runs::Run make_run(const CasePlan& plan, const Recipe& recipe, const std::string& name, std::uint64_t seed) {
  physics::RobotDescription robot = with_foreign(physics::load_robot(kRobot), recipe.foreign, recipe.foreign_amount);
  robot.effects = recipe.effects;
  rollout::Manoeuvre manoeuvre = rollout::load_manoeuvre(name);
  std::vector<std::string> unsupported;
  const physics::WorldDescription world = physics::load_world(manoeuvre.world, unsupported);
  rollout::RollOutOptions options;
  options.physics = plan.physics;
  options.seed = seed;
  options.noise_scale = plan.noise_scale;
  options.mocap_noise_m *= plan.noise_scale;
  options.mocap_noise_rad *= plan.noise_scale;
  options.start_scatter_m = rollout::kUsualScatter_m;
  options.start_scatter_rad = rollout::kUsualScatter_rad;

  runs::Run run;
  if (is_of_commands(recipe.foreign)) {
    rollout::RollOutOptions exact = options;
    exact.noise_scale = exact.mocap_noise_m = exact.mocap_noise_rad = 0;
    const runs::Run asked = rollout::roll_out(robot, world, manoeuvre, exact).run;
    rollout::Manoeuvre replay = rollout::replay_of(asked, name);
    obey_foreign(replay, recipe.foreign, recipe.foreign_amount);
    run = rollout::roll_out(robot, world, replay, options).run;
    for (std::size_t c = 0; c < run.columns.size(); ++c)
      if (run.columns[c].starts_with("cmd_"))
        for (std::size_t i = 0; i < run.row_count(); ++i)
          run.values[c][i] = asked.column(run.columns[c])[std::min(i, asked.row_count() - 1)];
  } else {
    run = rollout::roll_out(robot, world, manoeuvre, options).run;
  }
  record_foreign(run, recipe.foreign, recipe.foreign_amount);
  add_coloured_noise(run, plan, mixed(seed, 1));
  return run;
}

void write_cases_runs(const CasePlan& plan, const Recipe& recipe, const std::vector<std::string>& manoeuvres,
                      std::uint64_t seed, const fs::path& folder, const Work& work) {
  fs::create_directories(folder);
  runs::Dataset dataset{
      .source = "real", .robot = kRobot, .world = "flat", .description = plan.name, .noise = {}, .runs = {}};
  const auto repeats = static_cast<std::size_t>(plan.repeats);
  for (std::size_t i = 0; i < manoeuvres.size() * repeats; ++i) {
    const rollout::Manoeuvre manoeuvre = rollout::load_manoeuvre(manoeuvres[i / repeats]);
    dataset.runs.push_back({fmt::format("run-{:03}.csv", i), manoeuvre.name, manoeuvre.world});
  }
  for_each_job(dataset.runs.size(), work.jobs, [&](std::size_t i) {
    check_goes_on(work.stop);
    runs::write_run(folder / dataset.runs[i].file,
                    make_run(plan, recipe, dataset.runs[i].manoeuvre, mixed(seed, i + 2)));
  });
  runs::write_dataset(folder, dataset);
}

// How large gaps look beside the noise of runs in which nothing is hidden.
class Scale {
 public:
  Scale(const CasePlan& plan, const Work& work) : work_(work) {
    const TemporaryFolder folder;
    write_cases_runs(plan, {}, plan.manoeuvres, mixed(plan.seed, 0), folder.path, work);
    runs_.emplace(folder.path, work.jobs, work.stop);
    floor_ = floor_around(*runs_, runs_->predictor.unvaried());
    floor_rms_ = rms_of_repeats(*runs_, floor_, runs_->residuals);
  }

  double floors_of(const physics::Effects& effects) { return floor_.rms(shift_of(effects)) / floor_rms_; }

  double floors_of_foreign(const std::string& foreign, double amount) {
    return floor_.rms(shift_of_foreign(foreign, amount)) / floor_rms_;
  }

  // Of what is hidden outside the catalogue.
  LookAlike look_alike_of(const CasePlan& plan) {
    std::vector<std::string> without;
    for (const HiddenEffect& hidden : plan.effects) without.push_back(hidden.effect);
    return look_alike(
        *runs_, floor_,
        plan.foreign.empty() ? shift_of(hidden_effects(plan)) : shift_of_foreign(plan.foreign, plan.foreign_amount),
        without);
  }

 private:
  Shift shift_of(const physics::Effects& effects) {
    Variation variation = runs_->predictor.unvaried();
    variation.effects = effects;
    return runs_->predictor.shifts({&variation, 1}, Fidelity::coarse).front();
  }

  Shift shift_of_foreign(const std::string& foreign, double amount) {
    const Observations& observed = runs_->observations;
    Shift shift(runs_->features.size());
    for_each_job(shift.size(), work_.jobs, [&](std::size_t r) {
      check_goes_on(work_.stop);
      const physics::RobotDescription robot = with_foreign(observed.robot, foreign, amount);
      rollout::Manoeuvre replay = observed.runs[r].replay;
      obey_foreign(replay, foreign, amount);
      rollout::RollOutOptions options;
      options.noise_scale = options.mocap_noise_m = options.mocap_noise_rad = 0;
      runs::Run run = rollout::roll_out(robot, observed.worlds[observed.runs[r].world], replay, options).run;
      record_foreign(run, foreign, amount);
      shift[r] = runs_->features[r].of(run) - runs_->predictor.nominal()[r];
    });
    return shift;
  }

  Work work_;
  std::optional<ComparedRuns> runs_;
  NoiseFloor floor_;
  double floor_rms_ = 1;
};

// The share of the way at which `size_at` is as large as `wanted`, and its size there; all of the way where it is not
// reached. By ratios: effects of a thousandth of their range can be seen.
template <class SizeAt>
std::pair<double, double> share_for(double wanted, double smallest_share, SizeAt&& size_at) {
  const double most = size_at(1);
  if (!(most > wanted)) return {1, most};
  double below = smallest_share, above = 1, size = most;
  for (int i = 0; i < kHalvings && size > kCloseEnough * wanted; ++i) {
    const double middle = std::sqrt(below * above), at_middle = size_at(middle);
    if (at_middle < wanted)
      below = middle;
    else
      above = middle, size = at_middle;
  }
  return {above, size};
}

// Sets the value so that the effect is as large as planned; returns its size over what was planned. Where it cannot be
// so large to one side of neutral, it is sought on the other one.
double size_effect(const CasePlan& plan, HiddenEffect& hidden, Scale& scale, bool upward_first) {
  const physics::EffectParameter& parameter = parameter_of(hidden);
  const double planned = hidden.floors;
  double best = -1;
  for (const bool upward : {upward_first, !upward_first}) {
    const double furthest = furthest_value(plan, parameter, upward);
    if (furthest == parameter.neutral || best >= kCloseToPlanned) continue;
    const auto value_at = [&](double share) { return parameter.neutral + share * (furthest - parameter.neutral); };
    const double smallest = parameter.value == &physics::Effects::flipper_backlash_rad ? kSmallestPlay : kSmallestShare;
    const auto [share, floors] = share_for(planned, smallest, [&](double part) {
      physics::Effects effects;
      effects.*parameter.value = value_at(part);
      return scale.floors_of(effects);
    });
    if (floors / planned <= best) continue;
    best = floors / planned;
    hidden.value = value_at(share);
    hidden.floors = floors;
  }
  return best;
}

Recipe recipe_of(const CasePlan& plan) {
  return {hidden_effects(plan), plan.foreign, plan.foreign_amount};
}

}  // namespace

physics::Effects hidden_effects(const CasePlan& plan) {
  physics::Effects effects;
  for (const HiddenEffect& hidden : plan.effects) effects.*parameter_of(hidden).value = hidden.value;
  return effects;
}

physics::Effects hidden_effects_in_model(const CasePlan& plan) {
  physics::Effects effects;
  for (const HiddenEffect& hidden : plan.effects) effects.*parameter_of(hidden).value = value_in_model(plan, hidden);
  return effects;
}

void make_case(CasePlan& plan, const fs::path& folder, unsigned jobs, const std::atomic<bool>* stop) {
  const Work work{jobs, stop};
  std::mt19937_64 random(mixed(plan.seed, 1));
  const bool upward = (random() & 1) != 0;
  std::vector<std::vector<std::string>> sets{plan.manoeuvres};
  for (const auto& set : manoeuvre_sets())
    if (set != plan.manoeuvres) sets.push_back(set);
  CasePlan best = plan;
  double best_size = -1;
  for (const auto& set : sets) {
    if (plan.stratum == Stratum::none) break;
    CasePlan candidate = plan;
    candidate.manoeuvres = set;
    if (std::ranges::count(set, candidate.unseen) > 0) continue;
    Scale scale(candidate, work);
    double reached = 1e9;
    for (HiddenEffect& hidden : candidate.effects)
      reached = std::min(reached, size_effect(candidate, hidden, scale, upward));
    if (!plan.foreign.empty()) {
      std::tie(candidate.foreign_amount, candidate.foreign_floors) =
          share_for(plan.foreign_floors, kSmallestShare,
                    [&](double amount) { return scale.floors_of_foreign(plan.foreign, amount); });
      reached = candidate.foreign_floors / plan.foreign_floors;
    }
    const double size = std::min(reached, kCloseToPlanned);
    if (size < best_size) continue;
    if (is_outside(plan.stratum)) candidate.look_alike = scale.look_alike_of(candidate);
    if (size == best_size && !(candidate.look_alike.angle_deg > best.look_alike.angle_deg)) continue;
    best_size = size;
    best = std::move(candidate);
    if (size == kCloseToPlanned && (!is_outside(plan.stratum) || best.look_alike.angle_deg >= kToldApart_deg)) break;
  }
  plan = best;
  make_again(plan, folder, jobs, stop);
}

void make_again(const CasePlan& plan, const fs::path& folder, unsigned jobs, const std::atomic<bool>* stop) {
  write_cases_runs(plan, recipe_of(plan), plan.manoeuvres, mixed(plan.seed, 2), folder, {jobs, stop});
}

void make_unseen(const CasePlan& plan, const fs::path& folder, unsigned jobs) {
  write_cases_runs(plan, recipe_of(plan), {plan.unseen}, mixed(plan.seed, 3), folder, {jobs, nullptr});
}

}  // namespace kenaf::gap
