#include "gap/diagnose/side_by_side.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace kenaf::gap {
namespace {

// How far to either side, of the way from neutral: so far that it shifts by several floors, for two simulations of what
// is rough differ by up to two, and a slope that is mostly roughness makes a value look surer than it is. Chosen.
constexpr double kNearest = 0.1, kFarthest = 0.5, kShifted_floors = 6;
// A side that shifts by as many times more than that is round a bend: it is sought nearer.
constexpr double kRoundABend = 2;
constexpr int kTries = 4;
constexpr double kStraightTo = 0.5;  // of the way from neutral: a curve has to come back to what it is there
constexpr int kMostRounds = 3;
constexpr double kGained = 0.5;  // deviance that a round must gain to be followed by another one

struct Known {
  double value;
  GroupVectors shift;
};

// On the straight line through two points.
Known on_line(const Known& a, const Known& b, double value) {
  const double share = (value - a.value) / (b.value - a.value);
  Known result{value, a.shift};
  for (std::size_t g = 0; g < a.shift.size(); ++g) result.shift[g] += share * (b.shift[g] - a.shift[g]);
  return result;
}

// The model with one of its values a share of the way from neutral nearer to it, or farther out.
struct Side {
  std::size_t place;
  bool outward;
  double share;
  double value = 0;
  GroupVectors shift{};  // of the model here
};

double value_at(const EffectCurves& curves, const Model& model, const Side& side) {
  const Candidate& candidate = curves.candidates[model.places[side.place].curve];
  const double factor = side.outward ? 1 + side.share : 1 / (1 + side.share);
  return std::clamp(candidate.present + factor * (model.places[side.place].value - candidate.present), candidate.min,
                    candidate.max);
}

GroupVectors difference(const GroupVectors& a, const GroupVectors& b) {
  GroupVectors result = a;
  for (std::size_t g = 0; g < a.size(); ++g) result[g] -= b[g];
  return result;
}

// Both sides of each value, but for the outer one of a value at the end of its range.
std::vector<Side> to_either_side(const StageData& data, const EffectCurves& curves, const Simulate& simulate,
                                 const Model& model) {
  std::vector<Side> sides;
  std::vector<double> lengths;  // of each effect alone
  for (std::size_t i = 0; i < model.places.size(); ++i) {
    lengths.push_back(length_in_noise(data, shift_of(curves, {&model.places[i], 1})));
    for (const bool outward : {false, true}) {
      const Side side{i, outward, std::clamp(kShifted_floors / lengths[i], kNearest, kFarthest)};
      if (value_at(curves, model, side) != model.places[i].value) sides.push_back(side);
    }
  }
  std::vector<std::size_t> to_seek(sides.size());
  std::iota(to_seek.begin(), to_seek.end(), std::size_t{0});
  for (int i = 0; i < kTries && !to_seek.empty(); ++i) {
    std::vector<Settings> asked;
    for (const std::size_t s : to_seek) {
      sides[s].value = value_at(curves, model, sides[s]);
      asked.push_back(settings_of(model.places));
      asked.back()[sides[s].place].value = sides[s].value;
    }
    std::vector<GroupVectors> simulated = simulate(asked, Fidelity::every_run);
    std::vector<std::size_t> bent;
    for (std::size_t a = 0; a < asked.size(); ++a) {
      Side& side = sides[to_seek[a]];
      side.shift = std::move(simulated[a]);
      const double moved = length_in_noise(data, difference(side.shift, model.shift));
      const double expected = std::max(kShifted_floors, side.share * lengths[side.place]);
      if (moved <= kRoundABend * expected) continue;
      side.share *= std::sqrt(expected / moved);
      bent.push_back(to_seek[a]);
    }
    to_seek = std::move(bent);
  }
  return sides;
}

// What the effect shifts on top of the others, where it stands, to either side, and straight on from there.
std::vector<Known> beside_others(const EffectCurves& curves, const Model& model, std::size_t place,
                                 const std::vector<Side>& sides) {
  const Candidate& candidate = curves.candidates[model.places[place].curve];
  const double present = candidate.present, value = model.places[place].value;
  const double end = value > present ? candidate.max : candidate.min;
  const Known here{value, shift_of(curves, {&model.places[place], 1})};
  std::vector<Known> points{here};
  for (const Side& side : sides) {
    if (side.place != place) continue;
    Known known{side.value, here.shift};
    for (std::size_t g = 0; g < known.shift.size(); ++g) known.shift[g] += side.shift[g] - model.shift[g];
    const double straight_to = side.outward ? end : present + kStraightTo * (value - present);
    if (straight_to != side.value) points.push_back(on_line(here, known, straight_to));
    points.push_back(std::move(known));
  }
  return points;
}

// Points of the curves where the model's effects stand, instead of those that they have alone on this side of neutral.
void stand(const StageData& data, EffectCurves& curves, const Simulate& simulate, Model& model) {
  const std::vector<Side> sides = to_either_side(data, curves, simulate, model);
  std::vector<Setting> points;
  std::vector<GroupVectors> shifts;
  for (std::size_t i = 0; i < model.places.size(); ++i)
    for (Known& known : beside_others(curves, model, i, sides)) {
      points.push_back({model.places[i].curve, known.value});
      shifts.push_back(std::move(known.shift));
    }
  for (const OnCurve& place : model.places) {
    const double present = curves.candidates[place.curve].present;
    std::erase_if(curves.curves[place.curve].points,
                  [&](const CurvePoint& point) { return (point.value - present) * (place.value - present) > 0; });
  }
  insert_points(curves, data, points, shifts, Fidelity::every_run);
  for (OnCurve& place : model.places) place = at_value(curves.curves, place.curve, place.value);
}

}  // namespace

StandingModel fit_side_by_side(const StageData& data, EffectCurves curves, const Simulate& simulate, Model model) {
  const auto is_present = [&](const OnCurve& place) { return place.value == curves.candidates[place.curve].present; };
  const EffectSet effects = effects_of(model);
  for (int round = 0; round < kMostRounds; ++round) {
    // one that is not there has no side to stand on
    if (std::ranges::any_of(model.places, is_present)) break;
    stand(data, curves, simulate, model);
    Model better = fit_model(data, curves, effects, beyond_curves(curves, model), model.likelihood.discrepancies);
    const std::vector<Settings> asked{settings_of(better.places)};
    better.shift = simulate(asked, Fidelity::every_run).front();
    better.exact = true;
    better.likelihood = likelihood_of(data, rest_of(data, better), better.likelihood.discrepancies);
    const double gained = model.deviance() - better.deviance();
    if (gained > 0) model = std::move(better);
    if (gained <= kGained) break;
  }
  return {std::move(model), std::move(curves)};
}

}  // namespace kenaf::gap
