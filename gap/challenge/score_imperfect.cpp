#include <algorithm>
#include <cmath>

#include "gap/challenge/score.hpp"

namespace kenaf::gap::challenge {
namespace {

constexpr double kShareWithin = 0.10;

// Whether a stage of a report has this effect, by name or in a set.
bool claims(const ReadStage& stage, const std::string& name) {
  return std::ranges::count(stage.named, name) > 0 ||
         std::ranges::any_of(stage.ambiguous_sets,
                             [&](const std::vector<std::string>& set) { return std::ranges::count(set, name) > 0; });
}

}  // namespace

std::vector<ScoredShare> scored_shares(const ScoredCase& scored) {
  const CasePlan& plan = scored.sealed.plan;
  std::vector<ScoredShare> shares;
  if (is_outside(plan.stratum) || !scored.report) return shares;
  for (const HiddenEffect& hidden : plan.effects) {
    const std::string name = reported_name(hidden.effect, hidden.parameter);
    for (const StageShare& truth : hidden.shares)
      for (const ReadStage& stage : scored.report->stages) {
        if (stage.stage != truth.stage || !claims(stage, name)) continue;
        for (const ReadEffect& read : stage.effects)
          if (read.effect == hidden.effect && read.parameter == hidden.parameter && !std::isnan(read.explains))
            shares.push_back({name, stage.stage, read.explains, truth.share});
      }
  }
  return shares;
}

std::vector<Figure> figures_of_imperfect(const std::vector<ScoredCase>& cases) {
  // Counts the cases of each figure; wrong names, shares and intervals count at all sizes.
  Count found, alone, named_apart, pairs, wrong, quiet, no_set, outside, outside_apart, share, covered;
  Count since, since_named, since_none;
  std::vector<double> off;
  for (const ScoredCase& scored : cases) {
    const Judgement judgement = judge(scored.sealed.plan, scored.report);
    const Stratum stratum = scored.sealed.plan.stratum;
    wrong.add(judgement.names_wrong);
    // A diagnosis that failed is never right.
    if (stratum == Stratum::none) {
      quiet.add(judgement.right);
      no_set.add(judgement.right && scored.report->ambiguous_sets.empty());
    }
    if (is_outside(stratum)) outside.add(judgement.right);
    if (is_outside(stratum) && judgement.distinguishable) outside_apart.add(judgement.right);
    for (const ScoredShare& stated : scored_shares(scored))
      share.add(std::abs(stated.stated - stated.truth) <= kShareWithin);
    for (const ScoredInterval& interval : scored_intervals(scored)) {
      covered.add(interval.holds());
      off.push_back(interval.off());
    }

    // Below, only effects that dominate, and changes that are surely seen.
    if (judgement.is_small) continue;
    if (stratum == Stratum::baseline) {
      since.add(judgement.right);
      if (judgement.hidden.empty()) since_none.add(judgement.right);
      if (judgement.distinguishable) since_named.add(judgement.named_alone);
    }
    if (stratum == Stratum::single) {
      const bool is_named = judgement.found.front() == Found::named;
      found.add(judgement.all_found);
      alone.add(judgement.named_alone);
      if (judgement.distinguishable) named_apart.add(is_named);
    }
    if (stratum == Stratum::pair) pairs.add(judgement.all_found);
  }

  // The figures with targets, then those without.
  return {
      share_figure("dominating_found", "dominating effects named, alone or in a set", ">= 90 %", found, 0.90, 1),
      share_figure("dominating_named", "distinguishable dominating effects, named alone", ">= 80 %", named_apart, 0.80,
                   1),
      share_figure("pair_found", "dominating pairs, both named or each in a set", ">= 75 %", pairs, 0.75, 1),
      share_figure("wrong_name", "reports that name an effect that is not hidden", "<= 2 %", wrong, 0, 0.02),
      share_figure("background_unnamed", "background alone, nothing named", ">= 97 %", quiet, 0.97, 1),
      share_figure("outside_unnamed", "withheld and foreign effects, no wrong name", ">= 95 %", outside, 0.95, 1),
      share_figure("baseline_right", "changes since a baseline, named or in the only set; none where nothing changed",
                   ">= 90 %", since, 0.90, 1),
      share_figure("share_close", "stated shares of the gap within 0.10 of the true ones", ">= 90 %", share, 0.90, 1),
      share_figure("interval_covers", "95 % intervals of named effects that contain the hidden value", "90 to 98 %",
                   covered, 0.90, 0.98),
      median_figure("interval_off", "median error of the named values, in half intervals", "0.25 to 0.45", off, 0.25,
                    0.45),
      share_figure("dominating_only", "dominating effects named, and nothing else claimed", "", alone, 0, 1),
      share_figure("background_unclaimed", "background alone, neither name nor set", "", no_set, 0, 1),
      share_figure("baseline_named", "distinguishable changes since a baseline, named alone", "", since_named, 0, 1),
      share_figure("baseline_none", "no change since a baseline, called none", "", since_none, 0, 1),
      share_figure("outside_apart_unnamed", "distinguishable withheld and foreign effects, no wrong name", "",
                   outside_apart, 0, 1),
  };
}

}  // namespace kenaf::gap::challenge
