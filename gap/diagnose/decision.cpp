#include "gap/diagnose/decision.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "gap/diagnose/agreement.hpp"
#include "gap/diagnose/isolability.hpp"
#include "gap/diagnose/side_by_side.hpp"

namespace kenaf::gap {
namespace {

// Of what a gap has beyond chance, so much must an effect account for before the floor is taken around it (chosen).
constexpr double kFits = 0.5;

// At the angle below which two effects cannot be told apart, the one that is not there leaves this share of what the
// other one accounts for.
const double kAlike = std::pow(std::sin(kToldApart_deg / 180 * std::numbers::pi), 2);

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

// Values at the end of a range, of effects that would go on there: one that does no more by then has as good a fit well
// inside.
bool at_an_end(const Model& model, const EffectCurves& curves, double margin) {
  constexpr double kInside = 0.9;  // of the way from the present value
  const Products products = products_around(curves, model);
  const double left = left_with(products, model.places);
  for (std::size_t i = 0; i < model.places.size(); ++i) {
    const OnCurve& place = model.places[i];
    const physics::EffectParameter& parameter = *curves.curves[place.curve].parameter;
    const bool at_min = place.value <= parameter.min && parameter.min != parameter.neutral;
    const bool at_max = place.value >= parameter.max && parameter.max != parameter.neutral;
    if (!at_min && !at_max) continue;
    std::vector<OnCurve> inside = model.places;
    const double present = present_value(curves.curves[place.curve]);
    inside[i] = at_value(curves.curves, place.curve, present + kInside * (place.value - present));
    if (left_with(products, inside) - left > margin) return true;
  }
  return false;
}

// With enough effects anything can be explained: of three or more each must account for a share.
bool has_trifle(const Model& model, const EffectCurves& curves, double due) {
  if (model.places.size() <= 2) return false;
  for (std::size_t i = 0; i < model.places.size(); ++i)
    if (left_without(curves, model, i) - model.left <= due) return true;
  return false;
}

// The steps of docs/gap-method.md, section 4, in their order.
class Decider {
 public:
  Decider(EffectCurves& curves, const Coherence& coherence, const Spread& spread, const Simulator& simulator,
          const DecisionSettings& settings, std::uint64_t seed)
      : curves_(curves),
        coherence_(coherence),
        simulator_(simulator),
        settings_(settings),
        chance_(draw_chance(curves, coherence, settings.null_draws, seed)),
        inflation_(spread.inflation),
        negligible_(settings.negligible * settings.negligible * spread.squared_length),
        numerics_(settings.model_share * settings.model_share),
        nominal_{{}, {}, true} {
    for (const Eigen::VectorXd& run : curves.residual) nominal_.shift.push_back(Eigen::VectorXd::Zero(run.size()));
    measure(nominal_, curves_, coherence_);
  }

  Decision decide() {
    d_.inflation = inflation_;
    d_.singles = singles();
    if (!is_gap()) return d_;
    // from here on, what the simulation leaves open is taken around what fits best, no longer around the nominal model;
    // and a gap is one only if it is beyond that floor too
    if (fits(d_.singles.front())) {
      look_around(d_.singles.front());
      if (!is_gap()) return d_;
    }
    take_effects();
    if (d_.best.places.size() == 1) stand(d_.singles.front());
    if (!d_.beside.empty()) std::swap(curves_.curves, d_.beside);
    doubt();
    if (d_.doubts.empty())
      name();
    else
      d_.verdict = Verdict::unknown;
    if (!d_.beside.empty()) std::swap(curves_.curves, d_.beside);
    return d_;
  }

 private:
  std::vector<Model> singles() { return search_singles(curves_, coherence_, simulator_, settings_.search); }

  void look_around(const Model& model) {
    set_whiteners(curves_, simulator_.whiteners_around(values_of(model.places)));
    measure(nominal_, curves_, coherence_);
    d_.singles = singles();
  }

  double p_of_nominal() const { return p_of_energy(chance_, nominal_.coherent / inflation_); }
  double p_of_best_single() const {
    const double improvement = nominal_.left - d_.singles.front().left - settings_.rival_margin;
    return p_of_improvement(chance_, improvement / inflation_);
  }
  // Beyond chance, and either in many places at once or so large that somebody would see it.
  bool is_gap() {
    d_.best = nominal_;
    d_.p_left = p_of_nominal();
    d_.p_gap = std::min(1.0, 2 * std::min(p_of_best_single(), d_.p_left));
    return d_.p_gap <= settings_.false_alarm &&
           (d_.p_left <= settings_.false_alarm / 2 || nominal_.left - d_.singles.front().left >= negligible_);
  }

  // Around a model that does not fit, the simulation may leave anything open: belts that fight each other, a robot that
  // tips where the real one never was.
  bool fits(const Model& model) const {
    const double beyond_chance = nominal_.coherent - inflation_ * static_cast<double>(coherence_.cell_count());
    return nominal_.coherent - model.coherent >= kFits * beyond_chance;
  }

  double of_numerics(const Model& model) const { return numerics_ * std::max(0.0, nominal_.left - model.left); }
  double margin(const Model& model) const { return settings_.rival_margin * inflation_ + of_numerics(model); }
  double p_left(const Model& model) const {
    return p_of_energy(chance_, (model.coherent - numerics_ * nominal_.coherent) / inflation_);
  }
  // Of three or more effects each must account for this.
  double due(const Model& model) const { return settings_.due_share * (nominal_.left - model.left); }
  // Another effect must earn more than the luckiest of all pairs does by chance.
  double to_earn(const Model& model) const {
    const double luck = 2 * chance_.improvement[chance_.improvement.size() * 99 / 100];
    return std::max({luck * inflation_, margin(model), negligible_, model.places.size() > 1 ? due(model) : 0});
  }
  bool is_needed(const Model& fewer, const std::vector<Model>& more) const {
    return !more.empty() && fewer.left - more.front().left > to_earn(fewer) &&
           (p_left(fewer) <= settings_.surprise || p_left(more.front()) > settings_.surprise);
  }
  std::vector<Model> with_another(const Model& model) const {
    // sums of curves are rough: half of what another effect must earn is promising
    return search_sets(curves_, coherence_, simulator_, settings_.search,
                       model.places.size() == 1 ? all_pairs(curves_) : with_one_more(curves_, model),
                       model.left - to_earn(model) / 2);
  }

  void take_effects() {
    d_.best = d_.singles.front();
    std::vector<Model> more = with_another(d_.best);
    while (is_needed(d_.best, more)) {
      weigh_around(more.front());
      more = with_another(d_.best);
      if (!is_needed(d_.best, more)) return weigh_around(d_.best);
      d_.together = std::move(more);
      stand(d_.together.front());
      if (d_.best.places.size() == settings_.most_effects || p_left(d_.best) > settings_.surprise) return;
      more = with_another(d_.best);
    }
  }

  // What was taken so far, in the floor around a model.
  void weigh_around(const Model& model) {
    look_around(model);
    if (d_.best.places.size() == 1) d_.best = d_.singles.front();
    measure(d_.best, curves_, coherence_);
    for (Model& together : d_.together) measure(together, curves_, coherence_);
    std::ranges::stable_sort(d_.together, {}, &Model::left);
  }

  // Takes it, fitted where it stands.
  void stand(Model& model) {
    const std::vector<EffectCurve> before = curves_.curves;
    d_.best = model = fit_side_by_side(curves_, coherence_, simulator_, std::move(model));
    d_.beside = std::exchange(curves_.curves, before);
  }

  void doubt() {
    const auto doubt = [&](bool holds, Doubt which) {
      if (holds) d_.doubts.push_back(which);
    };
    d_.p_left = p_left(d_.best);
    const Agreement agree =
        agreement(curves_, d_.best, coherence_.groups(), settings_.rival_margin, numerics_, simulator_.numerics());
    const double expected = inflation_ + agree.of_numerics / std::max(1.0, agree.freedom);
    d_.p_agree = p_of_squares(agree.gained / expected, agree.freedom);
    doubt(d_.p_left <= settings_.surprise, Doubt::much_left);
    d_.left_in_drive = left_in_drives(curves_, d_.best, coherence_, inflation_);
    doubt(d_.left_in_drive && d_.left_in_drive->p <= settings_.surprise, Doubt::left_in_drive);
    doubt(d_.p_agree <= settings_.surprise, Doubt::disagreement);
    doubt(at_an_end(d_.best, curves_, settings_.rival_margin * inflation_), Doubt::end_of_range);
    doubt(has_trifle(d_.best, curves_, due(d_.best)), Doubt::trifle);
    d_.undone = undone(curves_, d_.best, coherence_);
    doubt(d_.undone.has_value(), Doubt::undone);
    for (const OnCurve& place : d_.best.places) d_.rivals.push_back({place.curve});
  }

  void name() {
    d_.verdict = Verdict::named;
    const std::vector<Model>& alternatives = d_.best.places.size() == 1 ? d_.singles : d_.together;
    // a look-alike that leaves more than repeats differ by would get no name itself
    const double most_left =
        kWithinRepeats * kWithinRepeats * simulator_.repeats_around(d_.best.shift) + numerics_ * nominal_.left;
    for (std::size_t i = 0; i < d_.best.places.size(); ++i) {
      const double accounted = left_without(curves_, d_.best, i) - d_.best.left;
      d_.rivals[i] = rivals_of(
          d_.best.places[i], d_.best, alternatives,
          std::max(margin(d_.best), std::min(margin(d_.best) + kAlike * accounted, most_left - d_.best.left)));
      if (d_.rivals[i].size() > 1) d_.verdict = Verdict::ambiguous;
    }
  }

  EffectCurves& curves_;
  const Coherence& coherence_;
  const Simulator& simulator_;
  const DecisionSettings& settings_;
  const Chance chance_;
  const double inflation_, negligible_, numerics_;
  Model nominal_;
  Decision d_;
};

}  // namespace

Decision decide(EffectCurves& curves, const Coherence& coherence, const Spread& spread, const Simulator& simulator,
                const DecisionSettings& settings, std::uint64_t seed) {
  return Decider(curves, coherence, spread, simulator, settings, seed).decide();
}

}  // namespace kenaf::gap
