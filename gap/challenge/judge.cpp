#include "gap/challenge/judge.hpp"

#include <algorithm>
#include <cmath>

#include "physics/effects.hpp"

namespace kenaf::gap {
namespace {

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::count(names, name) > 0;
}

bool is_small(const CasePlan& plan) {
  return plan.foreign.empty()
             ? std::ranges::any_of(plan.effects,
                                   [](const HiddenEffect& hidden) { return hidden.floors < kSurelySeen_floors; })
             : plan.foreign_floors < kSurelySeen_floors;
}

// Whether each name can have a claim of its own. There are at most two names.
bool fits(const std::vector<std::string>& names, std::vector<std::vector<std::string>> claims) {
  if (claims.size() != names.size()) return false;
  std::ranges::sort(claims);
  do {
    bool all = true;
    for (std::size_t i = 0; all && i < names.size(); ++i) all = has(claims[i], names[i]);
    if (all) return true;
  } while (std::ranges::next_permutation(claims).found);
  return false;
}

bool stands_apart(const Told& told, const std::string& name) {
  const auto row = static_cast<std::size_t>(std::ranges::find(told.table, name) - told.table.begin());
  if (row == told.table.size()) return false;
  for (std::size_t other = 0; other < told.table.size(); ++other)
    if (other != row && !(told.angle_deg[row][other] >= kToldApart_deg)) return false;
  return true;
}

}  // namespace

std::string reported_name(const std::string& effect, const std::string& parameter) {
  const physics::EffectInfo* info = physics::find_effect(effect);
  return info != nullptr && info->parameters.size() > 1 ? effect + ":" + parameter : effect;
}

Judgement judge(const CasePlan& plan, const std::optional<Told>& told) {
  Judgement result;
  result.is_small = is_small(plan);
  const bool in_catalogue = plan.stratum == Stratum::single || plan.stratum == Stratum::pair;
  for (const HiddenEffect& hidden : plan.effects)
    if (in_catalogue) result.hidden.push_back(reported_name(hidden.effect, hidden.parameter));
  result.found.assign(result.hidden.size(), Found::missed);
  result.can_be_told_apart = is_outside(plan.stratum) && plan.look_alike.angle_deg >= kToldApart_deg;
  if (!told) return result;

  std::vector<std::vector<std::string>> claims = told->ambiguous_sets;
  for (const std::string& name : told->named) {
    claims.push_back({name});
    result.names_wrong |= !has(result.hidden, name);
  }
  for (std::size_t i = 0; i < result.hidden.size(); ++i) {
    const auto holds = [&](const std::vector<std::string>& set) { return has(set, result.hidden[i]); };
    if (has(told->named, result.hidden[i]))
      result.found[i] = Found::named;
    else if (std::ranges::any_of(told->ambiguous_sets, holds))
      result.found[i] = Found::ambiguous;
    else if (result.names_wrong)
      result.found[i] = Found::wrong;
  }
  if (in_catalogue)
    result.right = fits(result.hidden, claims);
  else
    result.right = told->verdict == (plan.stratum == Stratum::none ? "none" : "unknown");
  if (plan.stratum == Stratum::single) {
    result.named_alone = result.right && told->named == result.hidden;
    result.can_be_told_apart = stands_apart(*told, result.hidden.front());
  }
  return result;
}

}  // namespace kenaf::gap
