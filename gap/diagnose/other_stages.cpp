#include "gap/diagnose/other_stages.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace kenaf::gap::diagnose {
namespace {

// Rounds in which each stage is reconsidered with the findings of the others.
constexpr int kMostHearings = 2;

// The residual of a stage.
struct LeftThere {
  GroupVectors rest;
  Likelihood likelihood;
};
LeftThere left_by(const StageDecision& decision, const GroupVectors& shift) {
  LeftThere left{less(residuals_of(decision.data), shift), {}};
  left.likelihood = likelihood_of(decision.data, left.rest, decision.best.model.likelihood.discrepancies);
  return left;
}

// The residual's squares in the kinds of channels in which an effect acts: a large residual in others hides no
// contradiction.
double squares_where_it_acts(const StageData& data, const LeftThere& left, std::span<const double> squares_of_effect) {
  const std::vector<double> squares =
      squares_of_kinds(data, without_shared_shapes(data, left.rest, left.likelihood.discrepancies));
  double sum = 0;
  for (std::size_t kind = 0; kind < squares.size(); ++kind)
    if (acts_in(squares_of_effect, kind)) sum += squares[kind];
  return sum;
}

// The value of an effect or its rival, and both ends of its interval: a rival has the relative uncertainty of the
// effect that it replaces.
std::vector<Setting> values_of(const ModelEffect& effect, const Setting& setting,
                               std::span<const candidates::Candidate> candidates) {
  const Interval& own = effect.value.value;
  const candidates::Candidate& candidate = candidates[setting.candidate];
  const double change = std::abs(own.value - candidates[effect.candidate].present);
  const double part = change > 0 ? (own.to - own.from) / 2 / change : 0;
  const double half = part * std::abs(setting.value - candidate.present);
  std::vector<Setting> values;
  for (const double value : {setting.value, setting.value - half, setting.value + half})
    values.push_back({setting.candidate, std::clamp(value, candidate.min, candidate.max)});
  return values;
}

// Of these, the ones that act in a stage.
std::vector<NamedElsewhere> acting_in(const PreparedStage& prepared, std::vector<NamedElsewhere> named) {
  std::erase_if(
      named, [&](const NamedElsewhere& other) { return std::ranges::count(prepared.possible, other.candidate) == 0; });
  return named;
}

// Effects that stages other than `s` name without rivals.
std::vector<NamedElsewhere> named_elsewhere(const std::vector<StageDiagnosis>& stages, std::size_t s) {
  std::vector<NamedElsewhere> named;
  for (std::size_t other = 0; other < stages.size(); ++other)
    for (const ModelEffect& effect : stages[other].decision.effects)
      if (other != s && effect.doubts.empty() && effect.rivals.size() == 1)
        named.push_back({effect.candidate, effect.value.value});
  return named;
}

// Whether a stage has the candidate in its best model and finds that it does not fit there.
bool is_misfit(const StageDecision& decision, std::size_t candidate) {
  return std::ranges::any_of(decision.effects, [&](const ModelEffect& effect) {
    return effect.candidate == candidate && std::ranges::any_of(effect.doubts, is_misfit_of_kinds);
  });
}

// The effects of stage `s` and their rivals that another stage refutes: one that it needs, but that does not fit there,
// or one that would increase its residual, also if it has it at another value.
std::vector<RefutedElsewhere> refuted_elsewhere(const std::vector<StageDiagnosis>& stages, std::size_t s,
                                                const std::vector<PreparedStage>& prepared, Predictor& predictor,
                                                const DecisionSettings& settings) {
  std::vector<RefutedElsewhere> refuted;
  const StageDecision& decision = stages[s].decision;
  for (std::size_t e = 0; e < decision.effects.size(); ++e) {
    if (!decision.effects[e].doubts.empty()) continue;
    for (const Settings& model : decision.models_of_rivals[e])
      for (std::size_t other = 0; other < stages.size(); ++other) {
        const Setting& setting = model[e];
        const bool acts = std::ranges::count(prepared[other].possible, setting.candidate) > 0;
        if (other == s || !acts) continue;
        const std::vector<Setting> values = values_of(decision.effects[e], setting, prepared[other].candidates);
        if (is_misfit(stages[other].decision, setting.candidate) ||
            refutes(stages[other].decision, simulator_of(prepared[other], predictor), values, settings))
          refuted.push_back({setting.candidate, stages[other].passage});
      }
  }
  return refuted;
}

// Whether a stage may decide differently.
bool concerns(const StageDecision& decision, std::span<const candidates::Candidate> candidates,
              const Elsewhere& elsewhere) {
  for (std::size_t e = 0; e < decision.effects.size(); ++e) {
    const ModelEffect& effect = decision.effects[e];
    if (!effect.doubts.empty()) continue;
    const auto is_refuted = [&](std::size_t candidate) { return elsewhere.refutes(candidate); };
    if (std::ranges::any_of(effect.rivals, is_refuted)) return true;
    if (effect.rivals.size() > 1 && effect.partners.empty() &&
        settled_elsewhere(decision, e, candidates, elsewhere.named))
      return true;
  }
  return false;
}

}  // namespace

bool refutes(const StageDecision& decision, const Simulate& simulate, std::span<const Setting> values,
             const DecisionSettings& settings) {
  Settings others = settings_of(decision.best.model.places);
  std::erase_if(others, [&](const Setting& own) { return own.candidate == values.front().candidate; });
  for (const Settings& beside : {others, Settings{}}) {
    std::vector<Settings> asked{beside};
    for (const Setting& value : values) {
      asked.push_back(beside);
      asked.back().push_back(value);
    }
    const std::vector<GroupVectors> shifts = simulate(asked, Fidelity::fine);
    const LeftThere without = left_by(decision, shifts.front());
    const bool fits = std::any_of(shifts.begin() + 1, shifts.end(), [&](const GroupVectors& shift) {
      const LeftThere with = left_by(decision, shift);
      if (with.likelihood.deviance - without.likelihood.deviance < settings.evidence) return true;
      const std::vector<double> of_effect = squares_of_kinds(decision.data, less(shift, shifts.front()));
      return squares_where_it_acts(decision.data, with, of_effect) <
             (1 + settings.more_left) * squares_where_it_acts(decision.data, without, of_effect);
    });
    if (fits) return false;
  }
  return true;
}

bool lacks(const StageDecision& decision, const Simulate& simulate, std::span<const NamedElsewhere> named,
           const DecisionSettings& settings) {
  if (decision.effects.empty()) return false;
  const Settings best = settings_of(decision.best.model.places);
  return std::ranges::any_of(named, [&](const NamedElsewhere& other) {
    if (has_effect(decision.best.model, other.candidate)) return false;
    std::vector<Settings> asked{best};
    for (const double value : {other.value.value, other.value.from, other.value.to}) {
      asked.push_back(best);
      asked.back().push_back({other.candidate, value});
    }
    const std::vector<GroupVectors> shifts = simulate(asked, Fidelity::fine);
    const double without = left_by(decision, shifts.front()).likelihood.deviance;
    return std::any_of(shifts.begin() + 1, shifts.end(), [&](const GroupVectors& shift) {
      return left_by(decision, shift).likelihood.deviance <= without - settings.evidence;
    });
  });
}

double numbers_off_elsewhere(const std::vector<StageDiagnosis>& stages, Passage passage) {
  double largest = 0;
  if (passage != Passage::body_to_sensor) return largest;
  for (const StageDiagnosis& stage : stages)
    if (stage.passage != passage) largest = std::max(largest, stage.numbers_off);
  return largest;
}

void settle_by_other_stages(std::vector<StageDiagnosis>& stages, const std::vector<PreparedStage>& prepared,
                            Predictor& predictor, const StageOptions& options) {
  // what was refuted once stays refuted: a stage without it would find it again
  std::vector<std::vector<RefutedElsewhere>> refuted(stages.size());
  for (int round = 0; round < kMostHearings; ++round)
    for (std::size_t s = 0; s < stages.size(); ++s) {
      for (const RefutedElsewhere& more : refuted_elsewhere(stages, s, prepared, predictor, options.decision))
        if (std::ranges::count(refuted[s], more.candidate, &RefutedElsewhere::candidate) == 0)
          refuted[s].push_back(more);
      const Elsewhere elsewhere{named_elsewhere(stages, s), refuted[s],
                                numbers_off_elsewhere(stages, stages[s].passage)};
      if (concerns(stages[s].decision, prepared[s].candidates, elsewhere) ||
          lacks(stages[s].decision, simulator_of(prepared[s], predictor), acting_in(prepared[s], elsewhere.named),
                options.decision))
        stages[s] = diagnose_stage(prepared[s], predictor, options, elsewhere);
    }
}

}  // namespace kenaf::gap::diagnose
