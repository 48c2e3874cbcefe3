#include "gap/challenge/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <stdexcept>
#include <utility>

#include "gap/candidates/candidate.hpp"
#include "gap/candidates/robot_numbers.hpp"
#include "gap/challenge/stand_ins.hpp"
#include "gap/random_numbers.hpp"
#include "rollout/engines/body_in_engine.hpp"

namespace kenaf::gap::challenge {
namespace {

constexpr std::string_view kKindNames[] = {"exact", "imperfect", "mujoco", "ode"};  // as ChallengeKind
constexpr std::string_view kStratumNames[] = {"none",     "single",  "pair",        // as Stratum
                                              "withheld", "foreign", "withheld-number",
                                              "baseline"};

// A stratum and its share of the cases.
struct StratumShare {
  Stratum stratum;
  double share;
};
// Singles and withheld ones are together 78 of 150 cases, so that each of 56 effects has a turn in one of the two. Each
// effect once in both would take 216 cases and nearly half as much time again, for the same result.
constexpr StratumShare kExact[] = {{Stratum::none, 0.3},
                                   {Stratum::single, 0.26},
                                   {Stratum::pair, 0.11},
                                   {Stratum::withheld, 0.26},
                                   {Stratum::foreign, 0.07}};
// 36 of 150 cases are background alone: with fewer than 34 one wrong name would be more than 3 %.
constexpr StratumShare kImperfect[] = {
    {Stratum::none, 0.24},    {Stratum::single, 0.30},          {Stratum::pair, 0.13},    {Stratum::withheld, 0.10},
    {Stratum::foreign, 0.07}, {Stratum::withheld_number, 0.06}, {Stratum::baseline, 0.10}};
constexpr double kRounding = 1e-6;
constexpr int kRangeHalvings = 10;  // of the way to the end of a number's range, until it makes a valid robot
constexpr double kFurthest = 0.95;  // share of the way to the end of a parameter's range

// Sizes relative to the background. Both effects of a pair dominate; singles also show how large an effect must be.
constexpr double kSmallestTimes = 1, kSmallestTimesOfPair = 3, kLargestTimes = 6;
// Sizes since a baseline, in floors: the background cancels, noise does not.
constexpr double kSmallestChange_floors = 3, kLargestChange_floors = 10;
constexpr double kNothingChanged = 0.3;  // share of the baselines

struct Named {
  std::string effect, parameter;
};

// Gives each parameter once in a round, each round in another order. Leaves out random effects, which have no size that
// could be set.
class Turns {
 public:
  Turns(Random& random, ChallengeKind kind) : random_(random), kind_(kind) {}
  Named next() {
    if (left_.empty()) {
      for (const physics::EffectInfo& effect : physics::effect_catalogue())
        for (const physics::EffectParameter& parameter : effect.parameters)
          if (effect.name != "command_loss" && (engine_of(kind_).empty() || engines::shows_in_engine(effect)))
            left_.push_back({std::string(effect.name), std::string(parameter.name)});
      shuffle(left_, random_);
    }
    Named named = std::move(left_.back());
    left_.pop_back();
    return named;
  }

 private:
  Random& random_;
  ChallengeKind kind_;
  std::vector<Named> left_;
};

std::vector<Stratum> strata(std::size_t cases, std::span<const StratumShare> shares, Random& random) {
  std::vector<Stratum> result;
  double sum = 0;
  for (const auto& [stratum, share] : shares) {
    sum += share;
    while (static_cast<double>(result.size()) < sum * static_cast<double>(cases) - kRounding) result.push_back(stratum);
  }
  shuffle(result, random);
  return result;
}

// Factor from a value on the "real" side to the one that does the same with the model's contacts: the ground's give
// divides the stiffness, k_real / c_real = k_model / c, its factor multiplies the damping, d_real s_real = d_model s.
double scale_in_model(const CasePlan& plan, const physics::EffectParameter& parameter) {
  const physics::PhysicsSettings usual;
  if (parameter.value == &physics::Effects::ground_compliance_scale)
    return usual.contact_stiffness_npm / plan.physics.contact_stiffness_npm;
  if (parameter.value == &physics::Effects::ground_damping_scale)
    return plan.physics.contact_damping_nspm / usual.contact_damping_nspm;
  return 1;
}

// The sets of manoeuvres of the exact challenge; every challenge takes the unseen manoeuvre from one of them.
const std::vector<std::vector<std::string>>& manoeuvre_sets() {
  static const std::vector<std::vector<std::string>> sets{
      {"straight", "speed-steps", "turn-in-place", "step-150-flippers"},
      {"straight-fast", "arc", "flipper-sweep", "trench-200"},
      {"speed-steps", "turn-in-place", "drop", "step-100-flippers"},
      {"arc", "drop", "ramp", "step-200-flippers"},
      {"straight", "turn-in-place", "flipper-sweep", "tilted-box"}};
  return sets;
}

// The manoeuvres of the imperfect challenge. As logs of real robots, its runs are short, and either few with a repeat
// or more without one.
constexpr std::string_view kShortRuns[] = {"speed-steps",       "random-speeds", "square",     "arc",
                                           "straight",          "turn-in-place", "ramp",       "step-100",
                                           "step-150-flippers", "tilted-box",    "trench-150", "flipper-sweep"};
// Those of them that another engine drives as belts do (rollout/engines/body_in_engine.hpp).
constexpr std::string_view kRunsInEngine[] = {"speed-steps",       "straight",   "ramp",       "step-100",
                                              "step-150-flippers", "tilted-box", "trench-150", "flipper-sweep"};
constexpr std::size_t kFewestUnrepeated = 5, kMostUnrepeated = 8, kFewestRepeated = 3, kMostRepeated = 4;
constexpr double kShortest_s = 3, kLongest_s = 7;
constexpr std::size_t kOtherShortRuns = 4;  // to choose from if an effect does not show

CaseRuns short_runs(int repeats, std::span<const std::string_view> from, Random& random) {
  const std::size_t fewest = repeats == 1 ? kFewestUnrepeated : kFewestRepeated,
                    most = repeats == 1 ? kMostUnrepeated : kMostRepeated;
  std::vector<std::string> names(from.begin(), from.end());
  shuffle(names, random);
  names.resize(fewest + below(random, most - fewest + 1));
  CaseRuns runs{std::move(names), {}};
  for (std::size_t i = 0; i < runs.manoeuvres.size(); ++i)
    runs.longest_s.push_back(uniform(random, kShortest_s, kLongest_s));
  return runs;
}

std::span<const std::string_view> short_runs_of(std::string_view engine) {
  return engine.empty() ? std::span<const std::string_view>(kShortRuns) : kRunsInEngine;
}

void choose_runs(CasePlan& plan, ChallengeKind kind, Random& random) {
  if (is_imperfect(kind)) {
    plan.repeats = uniform(random, 0, 1) < 0.5 ? 1 : 2;
    CaseRuns runs = short_runs(plan.repeats, short_runs_of(plan.engine), random);
    plan.manoeuvres = std::move(runs.manoeuvres);
    plan.longest_s = std::move(runs.longest_s);
  } else {
    plan.manoeuvres = manoeuvre_sets()[below(random, manoeuvre_sets().size())];
  }
  const auto& other = manoeuvre_sets()[below(random, manoeuvre_sets().size())];
  const auto unseen = std::ranges::find_if(
      other, [&](const std::string& name) { return std::ranges::count(plan.manoeuvres, name) == 0; });
  // "hills" is in no set, "drop" is not a short run
  plan.unseen = unseen != other.end() ? *unseen : kind == ChallengeKind::exact ? "hills" : "drop";
}

}  // namespace

std::string_view kind_name(ChallengeKind kind) {
  return kKindNames[static_cast<std::size_t>(kind)];
}

ChallengeKind challenge_kind_of(std::string_view name) {
  const auto* found = std::ranges::find(kKindNames, name);
  if (found == std::end(kKindNames))
    throw std::invalid_argument(fmt::format("\"{}\" is not a kind of challenge", name));
  return static_cast<ChallengeKind>(found - kKindNames);
}

bool is_imperfect(ChallengeKind kind) {
  return kind != ChallengeKind::exact;
}

std::string_view engine_of(ChallengeKind kind) {
  return kind == ChallengeKind::mujoco || kind == ChallengeKind::ode ? kind_name(kind) : std::string_view();
}

std::string_view stratum_name(Stratum stratum) {
  return kStratumNames[static_cast<std::size_t>(stratum)];
}

bool is_outside(Stratum stratum) {
  return stratum == Stratum::withheld || stratum == Stratum::foreign || stratum == Stratum::withheld_number;
}

Stratum stratum_of(std::string_view name) {
  const auto* found = std::ranges::find(kStratumNames, name);
  if (found == std::end(kStratumNames)) throw std::invalid_argument(fmt::format("\"{}\" is not a stratum", name));
  return static_cast<Stratum>(found - kStratumNames);
}

const physics::EffectParameter& parameter_of(const HiddenEffect& hidden) {
  return *physics::find_parameter(*physics::find_effect(hidden.effect), hidden.parameter);
}

double value_in_model(const CasePlan& plan, const HiddenEffect& hidden) {
  return hidden.value * scale_in_model(plan, parameter_of(hidden));
}

double furthest_value(const CasePlan& plan, const physics::EffectParameter& parameter, bool upward) {
  static const std::vector<candidates::Candidate> candidates =
      candidates::catalogue_candidates(physics::load_robot(kChallengedRobot), /*has_obstacles=*/true);
  const double scale = scale_in_model(plan, parameter);
  double min = parameter.min, max = parameter.max;
  for (const candidates::Candidate& candidate : candidates)
    if (&parameter_of({candidate.effect, candidate.parameter}) == &parameter) min = candidate.min, max = candidate.max;

  // Both the value and value * scale must lie in the range.
  const double end = upward ? std::min(max, max / scale) : std::max(min, min / scale);
  return parameter.neutral + kFurthest * (end - parameter.neutral);
}

double furthest_value_of_number(const CasePlan& plan, bool upward) {
  const candidates::Candidate& number =
      *std::ranges::find(challenged_numbers(), plan.number.key, &candidates::Candidate::name);
  // From the end of the range half way back to the present value, until the robot is valid.
  physics::RobotDescription robot = with_background(physics::load_robot(kChallengedRobot), plan.background);
  double value = number.present + kFurthest * ((upward ? number.max : number.min) - number.present);
  for (int halving = 0; halving < kRangeHalvings; ++halving) {
    candidates::find_robot_number(robot, number.name)->set(robot, value);
    if (candidates::why_impossible(robot).empty()) return value;
    value = std::midpoint(value, number.present);
  }
  return number.present;
}

std::vector<CaseRuns> runs_to_choose_from(const CasePlan& plan) {
  std::vector<CaseRuns> choice{{plan.manoeuvres, plan.longest_s}};
  if (plan.is_imperfect()) {
    Random random(mixed(plan.seed, 4));
    while (choice.size() <= kOtherShortRuns)
      choice.push_back(short_runs(plan.repeats, short_runs_of(plan.engine), random));
    return choice;
  }
  for (const std::vector<std::string>& set : manoeuvre_sets())
    if (set != plan.manoeuvres) choice.push_back({set, {}});
  return choice;
}

std::vector<ForeignEffect> foreign_effects() {
  return {{"right_drive_cuts_out", "a loose contact stops the drive of one track intermittently"},
          {"right_flipper_lag", "one of the front flippers follows later than the other"},
          {"left_drive_lag", "one track's drive follows later than the other's"},
          {"command_shortfall", "track commands lose a constant speed; slow commands have no effect"},
          {"speed_hunts", "the drives' speed oscillates about the command"},
          {"drives_fade", "the drives turn slower the longer they have run"},
          {"gyro_saturates", "the gyro reports an increasingly smaller part of faster rates"}};
}

std::vector<CasePlan> plan_challenge(std::size_t cases, std::uint64_t seed, ChallengeKind kind) {
  // The draws have a fixed order, so that a seed always gives the same cases. Singles and withheld ones share one round
  // of turns; pairs and baselines have rounds of their own.
  const bool imperfect = is_imperfect(kind);
  Random random(seed);
  Turns turns(random, kind), pairs(random, kind), changes(random, kind);
  std::vector<std::string> numbers;
  const std::vector<ForeignEffect> foreign = foreign_effects();
  std::vector<CasePlan> plans;
  for (const Stratum stratum : strata(cases, imperfect ? std::span<const StratumShare>(kImperfect) : kExact, random)) {
    // The hidden effect, number or deviation of the stratum: which, and how large in floors or times the background.
    CasePlan plan;
    plan.name = fmt::format("case-{:03}", plans.size());
    plan.stratum = stratum;
    plan.engine = std::string(engine_of(kind));
    const auto hide = [&](Turns& from, double smallest_floors, double smallest_times) {
      const Named named = from.next();
      HiddenEffect hidden{named.effect, named.parameter};
      if (plan.stratum == Stratum::baseline)
        hidden.floors = log_uniform(random, kSmallestChange_floors, kLargestChange_floors);
      else if (imperfect)
        hidden.times_background = uniform(random, smallest_times, kLargestTimes);
      else
        hidden.floors = log_uniform(random, smallest_floors, 5);
      plan.effects.push_back(std::move(hidden));
    };
    if (stratum == Stratum::single) hide(turns, 0.5, kSmallestTimes);
    if (stratum == Stratum::withheld) hide(turns, 2, kSmallestTimes);
    if (stratum == Stratum::pair) {
      hide(pairs, 2, kSmallestTimesOfPair);
      do {
        plan.effects.resize(1);
        hide(pairs, 2, kSmallestTimesOfPair);
      } while (plan.effects[0].effect == plan.effects[1].effect ||
               stand_in_for_each_other(plan.effects[0].effect, plan.effects[1].effect));
    }
    if (stratum == Stratum::foreign) {
      plan.foreign = foreign[below(random, foreign.size())].name;
      if (imperfect)
        plan.foreign_times_background = uniform(random, kSmallestTimes, kLargestTimes);
      else
        plan.foreign_floors = log_uniform(random, 2, 5);
    }
    if (stratum == Stratum::withheld_number) {
      if (numbers.empty()) {
        numbers = numbers_like_nothing_else();
        shuffle(numbers, random);
      }
      plan.number.key = numbers.back();
      numbers.pop_back();
      plan.number.times_background = uniform(random, kSmallestTimes, kLargestTimes);
    }
    if (stratum == Stratum::baseline && uniform(random, 0, 1) >= kNothingChanged) hide(changes, 0, 0);

    // Further differences from the model: runs, physics settings, noise, resolution.
    choose_runs(plan, kind, random);
    plan.physics.time_step_s *= 0.5;
    plan.physics.solver_iterations *= 2;
    plan.physics.contact_stiffness_npm *= log_uniform(random, 0.6, 1.7);
    plan.physics.contact_damping_nspm *= log_uniform(random, 0.6, 1.7);
    plan.noise_scale = log_uniform(random, 0.7, 1.5);
    plan.noise_memory_s = !imperfect && uniform(random, 0, 1) < 0.5 ? 0 : log_uniform(random, 0.02, 0.2);
    if (imperfect) plan.count_scale = log_uniform(random, 0.5, 2);

    // The background moves every number except those that do the same as what is hidden, whose value it would shift.
    plan.seed = random();
    if (imperfect) {
      std::vector<std::string> without;
      for (const HiddenEffect& hidden : plan.effects)
        for (std::string& key : numbers_like(hidden.effect)) without.push_back(std::move(key));
      if (!plan.number.key.empty()) without.push_back(plan.number.key);
      plan.background = draw_background(physics::load_robot(kChallengedRobot), mixed(plan.seed, 5), without);
    }
    plans.push_back(std::move(plan));
  }
  return plans;
}

}  // namespace kenaf::gap::challenge
