#include "gap/challenge/judge.hpp"

#include <algorithm>
#include <cmath>

#include "gap/challenge/stand_ins.hpp"
#include "physics/effects.hpp"

namespace kenaf::gap::challenge {
namespace {

using Names = std::vector<std::string>;

bool has(const Names& names, const std::string& name) {
  return std::ranges::any_of(names, [&](const std::string& n) { return n == name || same_effect(n) == name; });
}

bool is_small(const CasePlan& plan) {
  const auto small = [&](double floors, double times_background) {
    if (plan.is_sized_by_background()) return times_background < kDominates;
    return floors < (plan.stratum == Stratum::baseline ? kSurelySeenSince_floors : kSurelySeen_floors);
  };
  if (!plan.foreign.empty()) return small(plan.foreign_floors, plan.foreign_times_background);
  if (!plan.number.key.empty()) return small(plan.number.floors, plan.number.times_background);
  return std::ranges::any_of(plan.effects,
                             [&](const HiddenEffect& hidden) { return small(hidden.floors, hidden.times_background); });
}

std::vector<Names> claims_of(const ReadStage& stage) {
  std::vector<Names> claims = stage.ambiguous_sets;
  for (const std::string& name : stage.named) claims.push_back({name});
  return claims;
}

// All sets of hidden effects, as bits, for which the claims of a stage can stand, each for a different one that it
// contains. Empty if the claims cannot all stand.
std::vector<unsigned> ways_to_stand(const std::vector<Names>& claims, const Names& hidden) {
  std::vector<unsigned> ways{0};
  for (const Names& claim : claims) {
    std::vector<unsigned> longer;
    for (const unsigned taken : ways)
      for (std::size_t i = 0; i < hidden.size(); ++i)
        if ((taken & 1U << i) == 0 && has(claim, hidden[i])) longer.push_back(taken | 1U << i);
    ways = std::move(longer);
  }
  return ways;
}

// Whether each hidden effect can have a claim. With `all_stand` each claim must also stand for a hidden effect;
// without, claims that contain none of them are ignored.
bool is_covered(const ReadReport& report, const Names& hidden, bool all_stand) {
  std::vector<unsigned> covered{0};
  for (const ReadStage& stage : report.stages) {
    std::vector<Names> claims = claims_of(stage);
    if (!all_stand)
      std::erase_if(claims, [&](const Names& claim) {
        return std::ranges::none_of(hidden, [&](const std::string& name) { return has(claim, name); });
      });

    // The union of what the stages so far and this one can cover.
    std::vector<unsigned> next;
    for (const unsigned before : covered)
      for (const unsigned way : ways_to_stand(claims, hidden)) next.push_back(before | way);
    std::ranges::sort(next);
    next.erase(std::unique(next.begin(), next.end()), next.end());
    covered = std::move(next);
  }
  return std::ranges::count(covered, (1U << hidden.size()) - 1) > 0;
}

// The table of the stage in which the effect explains most; without shares in the key, of the stage with most of the
// gap.
const ReadTable& table_for(const ReadReport& report, const HiddenEffect& hidden) {
  const auto most = std::ranges::max_element(hidden.shares, {}, &StageShare::share);
  if (most == hidden.shares.end()) return report.table;
  const auto stage = std::ranges::find(report.stages, most->stage, &ReadStage::stage);
  return stage == report.stages.end() ? report.table : stage->table;
}

bool stands_apart(const ReadTable& table, const std::string& name) {
  const auto row = static_cast<std::size_t>(std::ranges::find(table.effects, name) - table.effects.begin());
  if (row == table.effects.size()) return false;
  for (std::size_t other = 0; other < table.effects.size(); ++other)
    if (other != row && !(table.angle_deg[row][other] >= diagnose::kDistinguishable_deg)) return false;
  return true;
}

}  // namespace

std::string reported_name(const std::string& effect, const std::string& parameter) {
  const physics::EffectInfo* info = physics::find_effect(effect);
  return info != nullptr && info->parameters.size() > 1 ? effect + ":" + parameter : effect;
}

Judgement judge(const CasePlan& plan, const std::optional<ReadReport>& report) {
  Judgement result;
  // Facts of the plan alone, which hold without a report, too.
  result.is_small = is_small(plan);
  const bool in_catalogue = !plan.effects.empty() && !is_outside(plan.stratum);
  for (const HiddenEffect& hidden : plan.effects)
    if (in_catalogue) result.hidden.push_back(reported_name(hidden.effect, hidden.parameter));
  result.found.assign(result.hidden.size(), Found::missed);
  result.distinguishable = is_outside(plan.stratum) && plan.look_alike.angle_deg >= diagnose::kDistinguishable_deg;
  if (!report) return result;

  // How each hidden effect was found.
  for (const std::string& name : report->named)
    result.names_wrong |= !has(result.hidden, name) && !has(result.hidden, same_effect(name));
  for (std::size_t i = 0; i < result.hidden.size(); ++i) {
    const auto holds = [&](const Names& set) { return has(set, result.hidden[i]); };
    if (holds(report->named))
      result.found[i] = Found::named;
    else if (std::ranges::any_of(report->ambiguous_sets, holds))
      result.found[i] = Found::ambiguous;
    else if (result.names_wrong)
      result.found[i] = Found::wrong;
  }

  // Right: by its claims, its names or its verdict, depending on the stratum.
  if (in_catalogue) {
    result.right = is_covered(*report, result.hidden, true);
    result.all_found = is_covered(*report, result.hidden, false);
  } else if (plan.is_imperfect() && plan.stratum != Stratum::baseline) {
    result.right = !result.names_wrong;
  } else {
    result.right = report->verdict == (is_outside(plan.stratum) ? "unknown" : "none");
  }

  if (result.hidden.size() == 1) {
    result.named_alone = result.right && result.found.front() == Found::named && report->ambiguous_sets.empty();
    result.distinguishable = stands_apart(table_for(*report, plan.effects.front()), result.hidden.front());
  }
  return result;
}

}  // namespace kenaf::gap::challenge
