#include "gap/challenge/score.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>

namespace kenaf::gap::challenge {
namespace {

constexpr double kShrinkWithin = 0.05;
// The share of a smaller gap tells nothing (chosen).
constexpr double kGapToShrink = 1.5;  // floors

bool is_large(const Shrinks& shrinks) {
  return shrinks.before >= kGapToShrink * shrinks.floor;
}

}  // namespace

double ScoredInterval::off() const {
  const double half = hidden > value ? to - value : value - from;
  return hidden == value ? 0 : std::abs(hidden - value) / half;
}

std::vector<ScoredInterval> scored_intervals(const ScoredCase& scored) {
  const CasePlan& plan = scored.sealed.plan;
  std::vector<ScoredInterval> intervals;
  if (is_outside(plan.stratum) || !scored.report) return intervals;
  for (const HiddenEffect& hidden : plan.effects) {
    const std::string name = reported_name(hidden.effect, hidden.parameter);
    for (const ReadStage& stage : scored.report->stages) {
      if (std::ranges::count(stage.named, name) == 0) continue;
      for (const ReadEffect& read : stage.effects)
        if (read.effect == hidden.effect && read.parameter == hidden.parameter)
          intervals.push_back({name, value_in_model(plan, hidden), read.value, read.from, read.to});
    }
  }
  return intervals;
}

bool is_imperfect(const std::vector<ScoredCase>& cases) {
  return std::ranges::any_of(cases, [](const ScoredCase& scored) { return scored.sealed.plan.is_imperfect(); });
}

std::vector<Figure> figures(const std::vector<ScoredCase>& cases) {
  if (is_imperfect(cases)) return figures_of_imperfect(cases);
  // Counts the cases of each figure. Wrong names and intervals count at all sizes, everything else only of large ones.
  Count singles, alone, pairs, outside, outside_apart, none, wrong, wrong_apart, covered, close, close_unseen;
  std::vector<double> heldout, unseen, off;
  for (const ScoredCase& scored : cases) {
    const Judgement judgement = judge(scored.sealed.plan, scored.report);
    const Stratum stratum = scored.sealed.plan.stratum;
    wrong.add(judgement.names_wrong);
    if (!is_outside(stratum) || judgement.distinguishable) wrong_apart.add(judgement.names_wrong);
    if (stratum == Stratum::none) none.add(judgement.right);
    for (const ScoredInterval& interval : scored_intervals(scored)) {
      covered.add(interval.holds());
      off.push_back(interval.off());
    }
    if (judgement.is_small) continue;
    if (stratum == Stratum::single) singles.add(judgement.right);
    if (stratum == Stratum::single && judgement.distinguishable) alone.add(judgement.named_alone);
    if (stratum == Stratum::pair) pairs.add(judgement.right);
    if (is_outside(stratum)) outside.add(judgement.right);
    if (is_outside(stratum) && judgement.distinguishable) outside_apart.add(judgement.right);

    // Shrinks are compared where there is a gap to shrink.
    for (const Shrinks& s : scored.shrinks.heldout) {
      if (!is_large(s)) continue;
      heldout.push_back(s.report - s.hidden);
      close.add(std::abs(heldout.back()) <= kShrinkWithin);
    }
    if (const auto& s = scored.shrinks.unseen; s && is_large(*s)) {
      unseen.push_back(s->report - s->hidden);
      close_unseen.add(std::abs(unseen.back()) <= kShrinkWithin);
    }
  }

  // The figures with targets, then those without.
  return {
      share_figure("single_found", "singles named alone or in the only ambiguity set", ">= 95 %", singles, 0.95, 1),
      share_figure("single_named", "distinguishable singles, named alone", ">= 90 %", alone, 0.90, 1),
      share_figure("pair_found", "pairs, both effects named or each in a set", ">= 80 %", pairs, 0.80, 1),
      share_figure("outside_unknown", "withheld and foreign effects, called unknown", ">= 90 %", outside, 0.90, 1),
      share_figure("none_none", "nothing hidden, called none", ">= 99 %", none, 0.99, 1),
      share_figure("wrong_name", "reports that name an effect that is not hidden", "<= 2 %", wrong, 0, 0.02),
      share_figure("interval_covers", "95 % intervals of named effects that contain the hidden value", "90 to 98 %",
                   covered, 0.90, 0.98),
      difference_figure("shrink_heldout", "held-out shrink minus the true effect's, mean absolute difference",
                        "<= 0.05", heldout, kShrinkWithin),
      difference_figure("shrink_unseen", "the same on a manoeuvre that the diagnosis did not use", "<= 0.05", unseen,
                        kShrinkWithin),
      share_figure("outside_apart_unknown", "distinguishable withheld and foreign effects, called unknown", "",
                   outside_apart, 0, 1),
      share_figure(
          "wrong_name_apart",
          "reports that name an effect that is not hidden, without indistinguishable cases outside the catalogue", "",
          wrong_apart, 0, 1),
      median_figure("interval_off", "median error of the named values, in half intervals", "", off, 0, 0),
      share_figure("shrink_heldout_close", "held-out shrinks within 0.05 of the true effect's", "", close, 0, 1),
      share_figure("shrink_unseen_close", "the same on a manoeuvre that the diagnosis did not use", "", close_unseen, 0,
                   1),
  };
}

std::vector<EffectScore> scores_by_effect(const std::vector<ScoredCase>& cases) {
  std::map<std::string, EffectScore> scores;
  for (const ScoredCase& scored : cases) {
    if (scored.sealed.plan.stratum == Stratum::baseline) continue;  // have figures of their own
    const Judgement judgement = judge(scored.sealed.plan, scored.report);
    for (std::size_t i = 0; i < judgement.hidden.size(); ++i) {
      EffectScore& score = scores[judgement.hidden[i]];
      score.name = judgement.hidden[i];
      ++score.hidden;
      const Found found = judgement.found[i];
      score.named += found == Found::named;
      score.ambiguous += found == Found::ambiguous;
      score.missed += found == Found::missed;
      score.wrong += found == Found::wrong;
      const double floors = scored.sealed.plan.effects[i].floors;
      if ((found == Found::named || found == Found::ambiguous) &&
          (score.smallest_found_floors == 0 || floors < score.smallest_found_floors))
        score.smallest_found_floors = floors;
    }
  }
  std::vector<EffectScore> result;
  for (auto& [name, score] : scores) result.push_back(std::move(score));
  return result;
}

std::vector<OutsideScore> scores_outside(const std::vector<ScoredCase>& cases) {
  std::map<std::string, OutsideScore> scores;
  for (const ScoredCase& scored : cases) {
    const CasePlan& plan = scored.sealed.plan;
    if (!is_outside(plan.stratum)) continue;
    const std::string name = !plan.foreign.empty()      ? plan.foreign
                             : !plan.number.key.empty() ? "without " + plan.number.key
                                                        : "without " + plan.effects.front().effect;
    OutsideScore& score = scores[name];
    score.name = name;
    ++score.cases;
    const std::string verdict = scored.report ? scored.report->verdict : "";
    score.unknown += verdict == "unknown";
    score.none += verdict == "none";
    score.ambiguous += verdict == "ambiguous";
    score.named += verdict == "named";
  }
  std::vector<OutsideScore> result;
  for (auto& [name, score] : scores) result.push_back(std::move(score));
  return result;
}

std::vector<SizeScore> scores_by_size(const std::vector<ScoredCase>& cases) {
  // Sizes are up to a twentieth larger than planned, and smaller where the planned one cannot be reached.
  std::vector<SizeScore> scores{{0, 0.5}, {0.5, 1}, {1, 2}, {2, 3.5}, {3.5, 5.25}};
  if (is_imperfect(cases)) scores = {{0, 1}, {1, 2}, {2, 3}, {3, 4.5}, {4.5, 6.3}};
  for (const ScoredCase& scored : cases) {
    if (scored.sealed.plan.stratum != Stratum::single) continue;
    const HiddenEffect& hidden = scored.sealed.plan.effects.front();
    const double size = scored.sealed.plan.is_imperfect() ? hidden.times_background : hidden.floors;
    const auto band = std::ranges::find_if(scores, [&](const SizeScore& s) { return size < s.to; });
    SizeScore& score = band == scores.end() ? scores.back() : *band;
    const Judgement judgement = judge(scored.sealed.plan, scored.report);
    ++score.cases;
    score.seen += scored.report && scored.report->verdict != "none";
    score.found += judgement.right;
    score.named_alone += judgement.named_alone;
    score.names_wrong += judgement.names_wrong;
  }
  return scores;
}

}  // namespace kenaf::gap::challenge
