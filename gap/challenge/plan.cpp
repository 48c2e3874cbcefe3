#include "gap/challenge/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

namespace kenaf::gap {
namespace {

using Random = std::mt19937_64;

// Not std::uniform_real_distribution, whose numbers depend on the standard library.
double uniform(Random& random, double from, double to) {
  return from + (to - from) * (static_cast<double>(random() >> 11) * 0x1p-53);
}
std::size_t below(Random& random, std::size_t count) {
  return static_cast<std::size_t>(uniform(random, 0, static_cast<double>(count)));
}
double log_uniform(Random& random, double from, double to) {
  return std::exp(uniform(random, std::log(from), std::log(to)));
}
template <class T>
void shuffle(std::vector<T>& values, Random& random) {
  for (std::size_t i = values.size(); i > 1; --i) std::swap(values[i - 1], values[below(random, i)]);
}

constexpr std::string_view kStratumNames[] = {"none", "single", "pair", "withheld", "foreign"};  // as Stratum
// Shares of the strata, in the order of Stratum: of 204 cases there is a single and a withheld one for each effect.
constexpr double kShare[] = {0.3, 0.26, 0.11, 0.26, 0.07};
constexpr double kRounding = 1e-6;
constexpr double kFurthest = 0.95;  // of the way to the end of a parameter's range

struct Named {
  std::string effect, parameter;
};

// Each parameter once in a turn, each turn in another order. Chance has no size that could be fitted.
class Turns {
 public:
  explicit Turns(Random& random) : random_(random) {}
  Named next() {
    if (left_.empty()) {
      for (const physics::EffectInfo& effect : physics::effect_catalogue())
        for (const physics::EffectParameter& parameter : effect.parameters)
          if (effect.name != "command_loss") left_.push_back({std::string(effect.name), std::string(parameter.name)});
      shuffle(left_, random_);
    }
    const Named named = left_.back();
    left_.pop_back();
    return named;
  }

 private:
  Random& random_;
  std::vector<Named> left_;
};

std::vector<Stratum> strata(std::size_t cases, Random& random) {
  std::vector<Stratum> result;
  double sum = 0;
  for (std::size_t s = 0; s < std::size(kShare); ++s) {
    sum += kShare[s];
    while (static_cast<double>(result.size()) < sum * static_cast<double>(cases) - kRounding)
      result.push_back(static_cast<Stratum>(s));
  }
  shuffle(result, random);
  return result;
}

// What a value of the "real" side is multiplied by, to be one of the model's contacts.
double scale_in_model(const CasePlan& plan, const physics::EffectParameter& parameter) {
  const physics::PhysicsSettings usual;
  if (parameter.value == &physics::Effects::ground_compliance_scale)
    return usual.contact_stiffness_npm / plan.physics.contact_stiffness_npm;
  if (parameter.value == &physics::Effects::ground_damping_scale)
    return plan.physics.contact_damping_nspm / usual.contact_damping_nspm;
  return 1;
}

}  // namespace

std::string_view stratum_name(Stratum stratum) {
  return kStratumNames[static_cast<std::size_t>(stratum)];
}

bool is_outside(Stratum stratum) {
  return stratum == Stratum::withheld || stratum == Stratum::foreign;
}

Stratum stratum_of(std::string_view name) {
  const auto* found = std::ranges::find(kStratumNames, name);
  if (found == std::end(kStratumNames)) throw std::invalid_argument(fmt::format("\"{}\" is no stratum", name));
  return static_cast<Stratum>(found - kStratumNames);
}

const physics::EffectParameter& parameter_of(const HiddenEffect& hidden) {
  return *physics::find_parameter(*physics::find_effect(hidden.effect), hidden.parameter);
}

double value_in_model(const CasePlan& plan, const HiddenEffect& hidden) {
  return hidden.value * scale_in_model(plan, parameter_of(hidden));
}

double furthest_value(const CasePlan& plan, const physics::EffectParameter& parameter, bool upward) {
  const double scale = scale_in_model(plan, parameter);
  const double end =
      upward ? std::min(parameter.max, parameter.max / scale) : std::max(parameter.min, parameter.min / scale);
  return parameter.neutral + kFurthest * (end - parameter.neutral);
}

std::vector<std::vector<std::string>> manoeuvre_sets() {
  return {{"straight", "speed-steps", "turn-in-place", "step-150-flippers"},
          {"straight-fast", "arc", "flipper-sweep", "trench-200"},
          {"speed-steps", "turn-in-place", "drop", "step-100-flippers"},
          {"arc", "drop", "ramp", "step-200-flippers"},
          {"straight", "turn-in-place", "flipper-sweep", "tilted-box"}};
}

std::vector<ForeignEffect> foreign_effects() {
  return {{"track_gauge", "the tracks lie further apart"},
          {"servo_speed", "the flipper servos turn slower than thought"},
          {"flipper_length", "the flippers are longer"},
          {"right_drive_cuts_out", "a loose contact stops one track's drive now and then"},
          {"right_flipper_lag", "one of the front flippers follows later than the other"},
          {"left_drive_lag", "one track's drive follows later than the other's"},
          {"command_shortfall", "track commands are short by a constant speed, slow ones not obeyed"},
          {"accelerometer_scale", "the accelerometer's scale is wrong"}};
}

std::vector<CasePlan> plan_challenge(std::size_t cases, std::uint64_t seed) {
  Random random(seed);
  Turns singles(random), withheld(random), pairs(random);
  const auto sets = manoeuvre_sets();
  const auto foreign = foreign_effects();
  std::vector<CasePlan> plans;
  for (const Stratum stratum : strata(cases, random)) {
    CasePlan plan;
    plan.name = fmt::format("case-{:03}", plans.size());
    plan.stratum = stratum;
    const auto hide = [&](Turns& turns, double from, double to) {
      const Named named = turns.next();
      plan.effects.push_back({named.effect, named.parameter, log_uniform(random, from, to), 0});
    };
    if (stratum == Stratum::single) hide(singles, 0.5, 5);
    if (stratum == Stratum::withheld) hide(withheld, 2, 5);
    if (stratum == Stratum::pair) {
      hide(pairs, 2, 5);
      do {
        plan.effects.resize(1);
        hide(pairs, 2, 5);
      } while (plan.effects[0].effect == plan.effects[1].effect);
    }
    if (stratum == Stratum::foreign) {
      plan.foreign = foreign[below(random, foreign.size())].name;
      plan.foreign_floors = log_uniform(random, 2, 5);
    }
    plan.manoeuvres = sets[below(random, sets.size())];
    const std::vector<std::string>& other = sets[below(random, sets.size())];
    const auto unseen = std::ranges::find_if(
        other, [&](const std::string& name) { return std::ranges::count(plan.manoeuvres, name) == 0; });
    plan.unseen = unseen != other.end() ? *unseen : "hills";
    plan.physics.time_step_s *= 0.5;
    plan.physics.solver_iterations *= 2;
    plan.physics.contact_stiffness_npm *= log_uniform(random, 0.6, 1.7);
    plan.physics.contact_damping_nspm *= log_uniform(random, 0.6, 1.7);
    plan.noise_scale = log_uniform(random, 0.7, 1.5);
    plan.noise_memory_s = uniform(random, 0, 1) < 0.5 ? 0 : log_uniform(random, 0.02, 0.2);
    plan.seed = random();
    plans.push_back(std::move(plan));
  }
  return plans;
}

}  // namespace kenaf::gap
