#include "gap/diagnose/side_by_side.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kenaf::gap {
namespace {

constexpr double kToEitherSide = 1.1;  // times the way from neutral
constexpr double kStraightTo = 0.5;    // of the way from neutral: a curve has to come back to what it is there
constexpr int kRounds = 3;
constexpr double kGained = 1e-3;  // share of what is left that a round must gain to be followed by another one

struct Known {
  double value;
  Shift shift;
};

// On the straight line through two points.
Known on_line(const Known& a, const Known& b, double value) {
  const double share = (value - a.value) / (b.value - a.value);
  Known result{value, a.shift};
  for (std::size_t r = 0; r < a.shift.size(); ++r) result.shift[r] += share * (b.shift[r] - a.shift[r]);
  return result;
}

// The model with one value a little nearer to neutral, and with it a little farther out unless it is at the end of its
// range.
std::vector<std::vector<NewPoint>> to_either_side(const EffectCurves& curves, const Model& model, std::size_t place) {
  const EffectCurve& curve = curves.curves[model.places[place].curve];
  const double neutral = present_value(curve), value = model.places[place].value;
  std::vector<std::vector<NewPoint>> sides;
  for (const double factor : {1 / kToEitherSide, kToEitherSide}) {
    const double wanted = std::clamp(neutral + factor * (value - neutral), curve.parameter->min, curve.parameter->max);
    if (wanted == value) continue;
    sides.push_back(values_of(model.places));
    sides.back()[place].value = wanted;
  }
  return sides;
}

// What the effect shifts on top of the others, where it stands, to either side, and straight on from there.
std::vector<Known> beside_others(const EffectCurves& curves, const Model& model, std::size_t place,
                                 const std::vector<std::vector<NewPoint>>& asked, std::span<const Shift> simulated) {
  const EffectCurve& curve = curves.curves[model.places[place].curve];
  const double neutral = present_value(curve), value = model.places[place].value;
  const double end = value > neutral ? curve.parameter->max : curve.parameter->min;
  const Known here{value, shift_of(curves, {&model.places[place], 1})};
  std::vector<Known> points{here};
  for (std::size_t i = 0; i < asked.size(); ++i) {
    Known side{asked[i][place].value, here.shift};
    for (std::size_t r = 0; r < side.shift.size(); ++r) side.shift[r] += simulated[i][r] - model.shift[r];
    const bool inner = std::abs(side.value - neutral) < std::abs(value - neutral);
    const double straight_to = inner ? neutral + kStraightTo * (value - neutral) : end;
    if (straight_to != side.value) points.push_back(on_line(here, side, straight_to));
    points.push_back(std::move(side));
  }
  return points;
}

// Points of the curves where the model's effects stand, instead of those that they have alone on this side of neutral.
void stand(EffectCurves& curves, const Simulator& simulator, Model& model) {
  std::vector<std::vector<NewPoint>> asked;
  std::vector<std::size_t> first;
  std::vector<std::vector<std::vector<NewPoint>>> sides;
  for (std::size_t i = 0; i < model.places.size(); ++i) {
    sides.push_back(to_either_side(curves, model, i));
    first.push_back(asked.size());
    asked.insert(asked.end(), sides[i].begin(), sides[i].end());
  }
  const std::vector<Shift> simulated = simulator.shifts(asked, Fidelity::every_run);
  std::vector<NewPoint> points;
  std::vector<Shift> shifts;
  for (std::size_t i = 0; i < model.places.size(); ++i)
    for (Known& known :
         beside_others(curves, model, i, sides[i], std::span(simulated).subspan(first[i], sides[i].size()))) {
      points.push_back({model.places[i].curve, known.value});
      shifts.push_back(std::move(known.shift));
    }
  for (const OnCurve& place : model.places) {
    EffectCurve& curve = curves.curves[place.curve];
    const double neutral = present_value(curve);
    std::erase_if(curve.points,
                  [&](const CurvePoint& point) { return (point.value - neutral) * (place.value - neutral) > 0; });
  }
  insert_points(curves, points, shifts, Fidelity::every_run);
  for (OnCurve& place : model.places) place = at_value(curves.curves, place.curve, place.value);
}

}  // namespace

Model fit_side_by_side(EffectCurves& curves, const Coherence& coherence, const Simulator& simulator, Model model) {
  const auto is_neutral = [&](const OnCurve& place) { return place.value == present_value(curves.curves[place.curve]); };
  const EffectSet effects = effects_of(model);
  for (int round = 0; round < kRounds; ++round) {
    // one that is not there has no side to stand on
    if (effects.size() < 2 || std::ranges::any_of(model.places, is_neutral)) break;
    stand(curves, simulator, model);
    Model better{fit_together(products_around(curves, model), curves.curves, effects).places, {}, true};
    const std::vector<std::vector<NewPoint>> asked{values_of(better.places)};
    better.shift = simulator.shifts(asked, Fidelity::every_run).front();
    measure(better, curves, coherence);
    const double gained = model.left - better.left;
    if (gained > 0) model = std::move(better);
    if (gained <= kGained * model.left) break;
  }
  return model;
}

}  // namespace kenaf::gap
