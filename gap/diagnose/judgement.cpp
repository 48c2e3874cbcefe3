#include "gap/diagnose/judgement.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace kenaf::gap::diagnose {
namespace {

// Effects substitute for each other if together they explain more than this multiple of their single shares (chosen).
constexpr double kCommon = 2;

constexpr HeldOutShares::OfEffect kNotHeldOut{
    GapMeasure::kNotMeasured, GapMeasure::kNotMeasured, GapMeasure::kNotMeasured, 0, GapMeasure::kNotMeasured, 0, 0};

bool is_lack_of_share(Doubt doubt) {
  return doubt == Doubt::not_held_out || doubt == Doubt::negligible;
}

// Doubts that say nothing of effects that stand in for each other: one takes up what another misses.
bool is_misfit_of_one(Doubt doubt) {
  return doubt == Doubt::disagreement || doubt == Doubt::trend || is_misfit_of_kinds(doubt);
}

// Doubts that the model's other effects may have caused.
bool depends_on_others(Doubt doubt) {
  return doubt == Doubt::negligible || doubt == Doubt::little_explained || is_misfit_of_kinds(doubt);
}

// Shares of the stage's whole gap, without and with errors of the description's numbers in both models.
bool takes_off_enough(const HeldOutShares::OfEffect& share, const DecisionSettings& settings) {
  return share.of_stage >= settings.stage_share && share.beyond_numbers >= settings.stage_share;
}

double change_by(const ModelEffect& effect, const candidates::Candidate& candidate) {
  return std::abs(effect.value.value.value - candidate.present);
}

// A set of effects, and the weaker one of its shares with repeats and with manoeuvres held out.
struct SetOfEffects {
  std::vector<std::size_t> places;
  HeldOutShares::OfEffect share;
};

// Small sets first, and of the same size those that explain most.
std::vector<SetOfEffects> in_order(const std::vector<HeldOutShares::OfSet>& sets,
                                   const std::vector<HeldOutShares::OfSet>& sets_by_manoeuvre,
                                   const DecisionSettings& settings) {
  std::vector<SetOfEffects> ordered;
  for (std::size_t s = 0; s < sets.size(); ++s) {
    const HeldOutShares::OfEffect &by_repeat = sets[s].share, &by_manoeuvre = sets_by_manoeuvre[s].share;
    const bool is_weaker =
        by_manoeuvre.shown_by_others >= settings.evidence && by_manoeuvre.of_kind < by_repeat.of_kind;
    ordered.push_back({sets[s].places, is_weaker ? by_manoeuvre : by_repeat});
  }
  std::ranges::stable_sort(ordered, [](const SetOfEffects& a, const SetOfEffects& b) {
    return a.places.size() != b.places.size() ? a.places.size() < b.places.size() : a.share.of_stage > b.share.of_stage;
  });
  return ordered;
}

bool explains_enough(const SetOfEffects& set, const DecisionSettings& settings) {
  return set.share.of_kind >= settings.effect_share && takes_off_enough(set.share, settings) &&
         set.share.model_of_kind >= settings.model_share;
}

// Effects that substitute for each other, like a lag and a ramp: without one the others explain most of it, without all
// of them the gap remains. They are named as a set, the smallest that explains enough, with the effects that also
// substitute for it.
void name_in_sets(std::vector<ModelEffect>& effects, const std::vector<SetOfEffects>& sets,
                  const DecisionSettings& settings) {
  // their individual shares are unknown, so manoeuvres, parts of them, and kinds of channels may disagree on these
  const auto lacks_share = [&](std::size_t place) {
    const std::vector<Doubt>& doubts = effects[place].doubts;
    return std::ranges::any_of(doubts, is_lack_of_share) &&
           std::ranges::all_of(doubts, [](Doubt doubt) { return is_lack_of_share(doubt) || is_misfit_of_one(doubt); });
  };
  const auto is_named = [&](std::size_t place) { return effects[place].doubts.empty(); };
  const auto alone = [&](std::size_t place) { return std::max(0.0, effects[place].share.of_stage); };

  // enough of a share, but a misfit, which others may take up
  const auto only_misfits = [&](std::size_t place) {
    return !is_named(place) && std::ranges::all_of(effects[place].doubts, is_misfit_of_one);
  };

  // An effect is in one set at most; with a name of its own only in one whose members substitute for it, and if it
  // misfits only in one whose members do enough together that none does alone.
  const auto may_join = [&](std::size_t place) {
    return effects[place].partners.empty() && (lacks_share(place) || is_named(place) || only_misfits(place));
  };
  const auto sum_alone = [&](const SetOfEffects& set) {
    double sum = 0;
    for (const std::size_t place : set.places) sum += alone(place);
    return sum;
  };
  const auto substitute = [&](const SetOfEffects& set) { return set.share.of_stage > kCommon * sum_alone(set); };
  const auto do_together = [&](const SetOfEffects& set) {
    return set.share.of_stage - sum_alone(set) >= settings.stage_share;
  };
  const auto is_named_together = [&](const SetOfEffects& set) {
    return std::ranges::all_of(set.places, may_join) && std::ranges::any_of(set.places, lacks_share) &&
           explains_enough(set, settings) && (std::ranges::none_of(set.places, is_named) || substitute(set)) &&
           (std::ranges::none_of(set.places, only_misfits) || do_together(set));
  };

  // whether with one more effect without a share the set explains so much more that this would be a cause: it would
  // leave the model without a name, and the set with it
  const auto grows_to = [&](const SetOfEffects& set, const SetOfEffects& larger) {
    if (larger.places.size() != set.places.size() + 1 || !std::ranges::includes(larger.places, set.places))
      return false;
    const std::size_t more = *std::ranges::find_if(
        larger.places, [&](std::size_t place) { return std::ranges::count(set.places, place) == 0; });
    return lacks_share(more) && is_named_together(larger) &&
           larger.share.of_stage - set.share.of_stage >= settings.stage_share;
  };

  for (const SetOfEffects& smallest : sets) {
    if (!is_named_together(smallest)) continue;
    const SetOfEffects* set = &smallest;
    for (const SetOfEffects& larger : sets)
      if (grows_to(*set, larger)) set = &larger;

    // its members are named, as each other's partners and rivals
    for (const std::size_t place : set->places) {
      ModelEffect& effect = effects[place];
      effect.doubts.clear();
      effect.share_of_set = set->share;
      for (const std::size_t other : set->places) {
        if (other == place) continue;
        effect.partners.push_back(other);
        effect.rivals.insert(effect.rivals.begin() + std::ssize(effect.partners), effects[other].candidate);
      }
    }
  }
}

// Of a stage with a gap and these effects.
Verdict verdict_of(const std::vector<ModelEffect>& effects) {
  bool any_named = false, any_rival = false;
  for (const ModelEffect& effect : effects) {
    any_named |= effect.doubts.empty();
    any_rival |= effect.doubts.empty() && effect.rivals.size() > 1;
  }
  return any_rival ? Verdict::ambiguous : any_named ? Verdict::named : Verdict::unknown;
}

bool has_names(const StageDecision& decision) {
  return decision.verdict == Verdict::named || decision.verdict == Verdict::ambiguous;
}

std::vector<std::size_t> places_where(const StageDecision& decision, bool (*holds)(const ModelEffect&)) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < decision.effects.size(); ++i)
    if (holds(decision.effects[i])) places.push_back(i);
  return places;
}

}  // namespace

std::vector<std::size_t> places_of_sets(const HeldOutShares& shares, const HeldOutShares& shares_by_manoeuvre,
                                        const DecisionSettings& settings) {
  const auto is_small = [&](const HeldOutShares::OfEffect& share) {
    return !(share.of_kind >= settings.effect_share) || !takes_off_enough(share, settings);
  };
  if (std::ranges::none_of(shares.effects, is_small) && std::ranges::none_of(shares_by_manoeuvre.effects, is_small))
    return {};
  std::vector<std::size_t> places(shares.effects.size());
  std::iota(places.begin(), places.end(), std::size_t{0});
  return places;
}

void judge(StageDecision& d, std::span<const candidates::Candidate> candidates, const HeldOutShares& shares,
           const HeldOutShares& shares_by_manoeuvre, const DecisionSettings& settings) {
  using Share = HeldOutShares::OfEffect;
  for (std::size_t i = 0; i < d.effects.size(); ++i) {
    ModelEffect& effect = d.effects[i];
    effect.share = shares.effects[i];
    effect.share_by_manoeuvre = shares_by_manoeuvre.effects[i];
    // an effect that a single manoeuvre shows can only be held out by repeats
    if (effect.share_by_manoeuvre.shown_by_others < settings.evidence) effect.share_by_manoeuvre = kNotHeldOut;

    // the smaller share counts; fmin ignores one that is NaN
    const auto least = [&](auto member) { return std::fmin(effect.share.*member, effect.share_by_manoeuvre.*member); };
    if (effect.at_bound) effect.doubts.push_back(Doubt::end_of_range);
    const double change = change_by(effect, candidates[effect.candidate]);
    if (change < settings.ordinary * effect.ordinarily_off) effect.doubts.push_back(Doubt::ordinary);
    if (change < settings.agreement * effect.value.spread) effect.doubts.push_back(Doubt::disagreement);
    if (effect.value.trend > settings.steady * change) effect.doubts.push_back(Doubt::trend);
    if (effect.value.by_kind.apart > settings.alike * change) effect.doubts.push_back(Doubt::kinds_differ);
    if (effect.value.by_kind.left > settings.left_of_kind) effect.doubts.push_back(Doubt::leaves_much);
    if (!(least(&Share::of_kind) >= settings.effect_share))
      effect.doubts.push_back(Doubt::not_held_out);
    else if (!(least(&Share::of_stage) >= settings.stage_share) ||
             !(least(&Share::beyond_numbers) >= settings.stage_share))
      effect.doubts.push_back(Doubt::negligible);
    if (!(least(&Share::model_of_kind) >= settings.model_share)) effect.doubts.push_back(Doubt::little_explained);
  }

  // then sets, and the verdict from what has a name
  name_in_sets(d.effects, in_order(shares.sets, shares_by_manoeuvre.sets, settings), settings);
  d.verdict = verdict_of(d.effects);
}

void doubt_unless_simulated(StageDecision& d, double on_runs, double on_manoeuvres, const DecisionSettings& settings) {
  if (!has_names(d)) return;
  const bool shown_by_others = std::ranges::all_of(d.effects, [&](const ModelEffect& effect) {
    return effect.share_by_manoeuvre.shown_by_others >= settings.evidence;
  });
  const bool on_runs_too_little = !(on_runs >= settings.stage_share);
  const bool on_manoeuvres_too_little = (shown_by_others || !d.complete) && !(on_manoeuvres >= settings.stage_share);
  if (!on_runs_too_little && !on_manoeuvres_too_little) return;
  for (ModelEffect& effect : d.effects)
    effect.doubts.push_back(on_runs_too_little ? Doubt::not_simulated : Doubt::not_predicted);
  d.verdict = verdict_of(d.effects);
}

void doubt_uncertain_values(StageDecision& d, std::span<const candidates::Candidate> candidates) {
  if (!has_names(d)) return;
  for (ModelEffect& effect : d.effects) {
    // members of a set have no values of their own
    if (effect.partners.empty() && change_by(effect, candidates[effect.candidate]) < effect.sure_from)
      effect.doubts.push_back(Doubt::uncertain);
  }
  d.verdict = verdict_of(d.effects);
}

std::vector<std::size_t> places_with_name(const StageDecision& decision) {
  return places_where(decision, [](const ModelEffect& effect) { return effect.doubts.empty(); });
}

std::vector<std::size_t> places_to_keep(const StageDecision& decision) {
  return places_where(decision, [](const ModelEffect& effect) {
    return effect.is_named_elsewhere || std::ranges::all_of(effect.doubts, is_misfit_of_kinds);
  });
}

std::vector<std::size_t> places_to_try(const StageDecision& decision) {
  return places_where(decision, [](const ModelEffect& effect) {
    return effect.is_named_elsewhere || std::ranges::all_of(effect.doubts, depends_on_others);
  });
}

}  // namespace kenaf::gap::diagnose
