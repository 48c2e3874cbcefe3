#include "gap/diagnose/decision.hpp"

#include <algorithm>

#include "gap/diagnose/agreement.hpp"

namespace kenaf::gap {
namespace {

bool has_curve(const Model& model, std::size_t curve) {
  return std::ranges::any_of(model.places, [&](const OnCurve& place) { return place.curve == curve; });
}

// Curves that may stand in the place of the chosen model's effect, the others staying: itself first.
std::vector<std::size_t> rivals_of(const OnCurve& place, const Model& chosen, const std::vector<Model>& models,
                                   double margin) {
  std::vector<std::size_t> rivals{place.curve};
  for (const Model& model : models) {
    if (model.left - chosen.left > margin) break;
    if (has_curve(model, place.curve)) continue;
    const bool others_stay = std::ranges::all_of(chosen.places, [&](const OnCurve& other) {
      return other.curve == place.curve || has_curve(model, other.curve);
    });
    if (!others_stay) continue;
    for (const OnCurve& rival : model.places)
      if (!has_curve(chosen, rival.curve)) rivals.push_back(rival.curve);
  }
  return rivals;
}

bool at_an_end(const Model& model, const EffectCurves& curves) {
  return std::ranges::any_of(model.places, [&](const OnCurve& place) {
    const physics::EffectParameter& parameter = *curves.curves[place.curve].parameter;
    return (place.value <= parameter.min && parameter.min != parameter.neutral) ||
           (place.value >= parameter.max && parameter.max != parameter.neutral);
  });
}

// With enough effects anything can be explained: of three or more each must account for a share.
bool has_trifle(const Model& model, const EffectCurves& curves, double due) {
  if (model.places.size() <= 2) return false;
  for (std::size_t i = 0; i < model.places.size(); ++i)
    if (left_without(curves, model, i) - model.left <= due) return true;
  return false;
}

}  // namespace

Decision decide(EffectCurves& curves, const Coherence& coherence, const Spread& spread, const Simulator& simulator,
                const DecisionSettings& settings, std::uint64_t seed) {
  Decision decision;
  const double inflation = decision.inflation = spread.inflation;
  const double negligible = settings.negligible * settings.negligible * spread.squared_length;
  const Chance chance = draw_chance(curves, coherence, settings.null_draws, seed);
  decision.chance_coherent = static_cast<double>(coherence.cell_count());
  decision.nominal_coherent = coherence.energy(curves.gap);
  const double nominal_left = squared_length(curves.gap);

  decision.singles = search_singles(curves, coherence, simulator, settings.search);
  decision.p_left = p_of_energy(chance, decision.nominal_coherent / inflation);
  const double improvement = nominal_left - decision.singles.front().left - settings.rival_margin;
  decision.p_gap = std::min(1.0, 2 * std::min(p_of_improvement(chance, improvement / inflation), decision.p_left));
  Model nominal{{}, {}, true};
  for (const Eigen::VectorXd& run : curves.residual) nominal.shift.push_back(Eigen::VectorXd::Zero(run.size()));
  measure(nominal, curves, coherence);
  decision.best = nominal;
  if (decision.p_gap > settings.false_alarm) return decision;
  const bool unexplained = decision.p_left <= settings.false_alarm / 2;
  if (!unexplained && nominal_left - decision.singles.front().left < negligible) return decision;

  // from here on, what the simulation leaves open is taken around what fits best, no longer around the nominal model
  const auto look_around = [&](const Model& model) {
    set_whiteners(curves, simulator.whiteners_around(values_of(model.places)));
    measure(nominal, curves, coherence);
  };
  look_around(decision.singles.front());
  decision.singles = search_singles(curves, coherence, simulator, settings.search);
  // and a gap is one only if it is beyond that floor too
  decision.p_left = p_of_energy(chance, nominal.coherent / inflation);
  if (decision.p_left > settings.false_alarm / 2 && nominal.left - decision.singles.front().left < negligible) {
    decision.best = nominal;
    return decision;
  }

  const double share = settings.model_share * settings.model_share;
  const auto margin = [&](const Model& model) {
    return settings.rival_margin * inflation + share * std::max(0.0, nominal.left - model.left);
  };
  const auto p_left = [&](const Model& model) {
    return p_of_energy(chance, (model.coherent - share * nominal.coherent) / inflation);
  };
  // another effect must earn more than the luckiest of all pairs does by chance
  const double luck = 2 * chance.improvement[chance.improvement.size() * 99 / 100];
  const auto to_earn = [&](const Model& model) { return std::max({luck * inflation, margin(model), negligible}); };
  const auto is_needed = [&](const Model& fewer, const Model& more) {
    return fewer.left - more.left > to_earn(fewer) &&
           (p_left(fewer) <= settings.surprise || p_left(more) > settings.surprise);
  };
  const auto with_another = [&](const Model& model) {
    // sums of curves are rough: half of what another effect must earn is promising
    return search_sets(curves, coherence, simulator, settings.search,
                       model.places.size() == 1 ? all_pairs(curves) : with_one_more(curves, model),
                       model.left - to_earn(model) / 2);
  };

  decision.best = decision.singles.front();
  std::vector<Model> more = with_another(decision.best);
  while (!more.empty() && is_needed(decision.best, more.front())) {
    look_around(more.front());
    decision.singles = search_singles(curves, coherence, simulator, settings.search);
    Model fewer = decision.best.places.size() == 1 ? decision.singles.front() : decision.best;
    measure(fewer, curves, coherence);
    more = with_another(fewer);
    if (more.empty() || !is_needed(fewer, more.front())) {
      decision.best = fewer;
      for (Model& model : decision.together) measure(model, curves, coherence);
      break;
    }
    decision.best = more.front();
    decision.together = more;
    if (decision.best.places.size() == settings.most_effects || p_left(decision.best) > settings.surprise) break;
    more = with_another(decision.best);
  }
  decision.p_left = p_left(decision.best);
  const Agreement agree = agreement(curves, decision.best, coherence.groups(), settings.rival_margin);
  decision.p_agree =
      p_of_squares((agree.gained - share * (nominal.left - decision.best.left)) / inflation, agree.freedom);
  const auto doubt = [&](bool holds, Doubt which) {
    if (holds) decision.doubts.push_back(which);
  };
  doubt(decision.p_left <= settings.surprise, Doubt::much_left);
  doubt(decision.p_agree <= settings.surprise, Doubt::disagreement);
  doubt(at_an_end(decision.best, curves), Doubt::end_of_range);
  doubt(has_trifle(decision.best, curves, settings.due_share * (nominal.left - decision.best.left)), Doubt::trifle);
  if (!decision.doubts.empty()) {
    decision.verdict = Verdict::unknown;
    for (const OnCurve& place : decision.best.places) decision.rivals.push_back({place.curve});
    return decision;
  }
  decision.verdict = Verdict::named;
  const std::vector<Model>& alternatives = decision.best.places.size() == 1 ? decision.singles : decision.together;
  for (const OnCurve& place : decision.best.places) {
    decision.rivals.push_back(rivals_of(place, decision.best, alternatives, margin(decision.best)));
    if (decision.rivals.back().size() > 1) decision.verdict = Verdict::ambiguous;
  }
  return decision;
}

}  // namespace kenaf::gap
