#include "gap/diagnose/side_by_side.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

namespace kenaf::gap::diagnose {
namespace {

// Distance to either side, as a fraction of that from neutral, for a shift of several floors (chosen): rough
// simulations differ by up to two floors, and a slope that is mostly roughness underestimates the value's error.
constexpr double kNearest = 0.1, kFarthest = 0.5, kShifted_floors = 6;
// A side that shifts more than this multiple of that is beyond a bend: a nearer one is tried.
constexpr double kRoundABend = 2;
constexpr int kTries = 4;
// If the nearest side still shifts by this share of the effect's whole shift, it is beyond a jump.
constexpr double kJump = 1.0 / 3;
// A side with a smaller shift is flat; bisections to find the end of the flat part.
constexpr double kSame_floors = 1;
constexpr int kHalvingsToNext = 6;
constexpr double kStraightTo = 0.5;  // of the way from neutral, where the curve has to return to its own shape
constexpr int kMostRounds = 3;
constexpr double kGained = 0.5;  // deviance that a round must gain to be followed by another

struct Known {
  double value;
  GroupVectors shift;
};

// On the line through two points.
Known on_line(const Known& a, const Known& b, double value) {
  const double share = (value - a.value) / (b.value - a.value);
  Known result{value, a.shift};
  for (std::size_t g = 0; g < a.shift.size(); ++g) result.shift[g] += share * (b.shift[g] - a.shift[g]);
  return result;
}

// The model with one of its values moved towards or away from neutral by a share of its distance.
struct Side {
  std::size_t place;
  bool outward;
  double share;
  double value = 0;
  GroupVectors shift{};  // of the model at this side
  bool jumps = false;    // between this side and the model, or the next nearer side
};

double value_at(const EffectCurves& curves, const Model& model, const Side& side) {
  const candidates::Candidate& candidate = curves.candidates[model.places[side.place].curve];
  const double factor = side.outward ? 1 + side.share : 1 / (1 + side.share);
  return std::clamp(candidate.present + factor * (model.places[side.place].value - candidate.present), candidate.min,
                    candidate.max);
}

// For a side without a shift: finds by bisection how far that holds, and the point after it.
void look_beyond_flat(const StageData& data, const EffectCurves& curves, const Simulate& simulate, const Model& model,
                      double length, Side& flat, std::vector<Side>& more) {
  const candidates::Candidate& candidate = curves.candidates[model.places[flat.place].curve];
  const auto moved_by = [&](const Side& side) { return length_in_noise(data, less(side.shift, model.shift)); };
  if (flat.jumps || length < kShifted_floors || moved_by(flat) > kSame_floors) return;
  const auto simulated_at = [&](double value) {
    std::vector<Settings> asked{settings_of(model.places)};
    asked.front()[flat.place].value = value;
    return Side{flat.place, flat.outward, 0, value, simulate(asked, Fidelity::every_run).front()};
  };

  // the end of the range, or neutral; if that is flat too, there is nothing to find
  const double end = model.places[flat.place].value > candidate.present ? candidate.max : candidate.min;
  Side next = simulated_at(flat.outward ? end : candidate.present);
  if (moved_by(next) <= kSame_floors) {
    if (flat.outward) flat = std::move(next);
    return;
  }

  // bisection between the flat point and the next one
  for (int i = 0; i < kHalvingsToNext; ++i) {
    Side between = simulated_at((flat.value + next.value) / 2);
    Side& replaced = moved_by(between) <= kSame_floors ? flat : next;
    replaced = std::move(between);
  }
  next.jumps = moved_by(next) > kJump * length;
  more.push_back(std::move(next));
}

// Both sides of each value, except the outer side of a value at the end of its range.
std::vector<Side> to_either_side(const StageData& data, const EffectCurves& curves, const Simulate& simulate,
                                 const Model& model) {
  // the first distance from the effect's mean slope: kShifted_floors over its length
  std::vector<Side> sides;
  std::vector<double> lengths;  // of each effect alone
  for (std::size_t i = 0; i < model.places.size(); ++i) {
    lengths.push_back(length_in_noise(data, shift_of(curves, {&model.places[i], 1})));
    for (const bool outward : {false, true}) {
      const Side side{i, outward, std::clamp(kShifted_floors / lengths[i], kNearest, kFarthest)};
      if (value_at(curves, model, side) != model.places[i].value) sides.push_back(side);
    }
  }

  // simulates all sides at once; those that shift too much are beyond a bend and move nearer, by the factor
  // sqrt(expected shift / shift)
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
    const bool is_last = i + 1 == kTries;
    for (std::size_t a = 0; a < asked.size(); ++a) {
      Side& side = sides[to_seek[a]];
      side.shift = std::move(simulated[a]);
      const double moved = length_in_noise(data, less(side.shift, model.shift));
      const double expected = std::max(kShifted_floors, side.share * lengths[side.place]);
      if (moved <= kRoundABend * expected) continue;
      side.jumps = is_last && moved > kJump * lengths[side.place];
      side.share *= std::sqrt(expected / moved);
      bent.push_back(to_seek[a]);
    }
    to_seek = std::move(bent);
  }

  // sides without a shift get the next point that has one
  std::vector<Side> next;
  for (Side& side : sides) look_beyond_flat(data, curves, simulate, model, lengths[side.place], side, next);
  std::ranges::move(next, std::back_inserter(sides));
  return sides;
}

// The additional shift of an effect with the others present: at its value, on either side, and extrapolated from there.
std::vector<Known> beside_others(const EffectCurves& curves, const Model& model, std::size_t place,
                                 const std::vector<Side>& sides) {
  const candidates::Candidate& candidate = curves.candidates[model.places[place].curve];
  const double present = candidate.present, value = model.places[place].value;
  const double end = value > present ? candidate.max : candidate.min;
  const Known here{value, shift_of(curves, {&model.places[place], 1})};
  std::vector<Known> points{here};
  for (const bool outward : {false, true}) {
    std::vector<Known> way{here};
    bool jumps = false;               // the last one
    for (const Side& side : sides) {  // of one direction, nearer ones first
      if (side.place != place || side.outward != outward || side.value == present) continue;
      way.push_back({side.value, here.shift});
      for (std::size_t g = 0; g < here.shift.size(); ++g) way.back().shift[g] += side.shift[g] - model.shift[g];
      jumps = side.jumps;
    }
    if (way.size() < 2) continue;
    const double straight_to = outward ? end : present + kStraightTo * (value - present);
    const Known &last = way.back(), &before = way[way.size() - 2];
    const double to_last = std::abs(last.value - value);
    if (to_last < std::abs(straight_to - value))
      way.push_back(jumps ? Known{straight_to, last.shift} : on_line(before, last, straight_to));
    std::ranges::move(way.begin() + 1, way.end(), std::back_inserter(points));
  }
  return points;
}

// Marks a jump between a point and its neighbour towards `from`.
void mark_jump(EffectCurve& curve, double from, double value) {
  const auto point = std::ranges::find(curve.points, value, &CurvePoint::value);
  (value > from ? point : point + 1)->jump = true;
}

// Replaces the points of the effects' own curves on this side of neutral by those with the model's other effects
// present.
void stand(const StageData& data, EffectCurves& curves, const Simulate& simulate, Model& model) {
  const std::vector<Side> sides = to_either_side(data, curves, simulate, model);
  // points with the other effects present
  std::vector<Setting> points;
  std::vector<GroupVectors> shifts;
  for (std::size_t i = 0; i < model.places.size(); ++i)
    for (Known& known : beside_others(curves, model, i, sides)) {
      points.push_back({model.places[i].curve, known.value});
      shifts.push_back(std::move(known.shift));
    }

  // replace the effect's own ones on that side, with their jumps
  for (const OnCurve& place : model.places) {
    const double present = curves.candidates[place.curve].present;
    std::erase_if(curves.curves[place.curve].points,
                  [&](const CurvePoint& point) { return (point.value - present) * (place.value - present) > 0; });
  }
  insert_points(curves, data, points, shifts, Fidelity::every_run);
  for (const Side& side : sides)
    if (side.jumps)
      mark_jump(curves.curves[model.places[side.place].curve], model.places[side.place].value, side.value);
  for (OnCurve& place : model.places) place = at_value(curves.curves, place.curve, place.value);
}

}  // namespace

StandingModel fit_side_by_side(const StageData& data, EffectCurves curves, const Simulate& simulate, Model model) {
  const auto is_present = [&](const OnCurve& place) { return place.value == curves.candidates[place.curve].present; };
  const EffectSet effects = effects_of(model);
  for (int round = 0; round < kMostRounds; ++round) {
    // an effect at its present value has no sides
    if (std::ranges::any_of(model.places, is_present)) break;
    // refits on the new curves, then simulates; kept only if the deviance falls
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

namespace {
EffectSet others_than(const Model& model, std::span<const std::size_t> places) {
  EffectSet others;
  for (std::size_t i = 0; i < model.places.size(); ++i)
    if (std::ranges::count(places, i) == 0) others.push_back(model.places[i].curve);
  return others;
}
}  // namespace

Model fit_without(const StageData& data, const StandingModel& standing, std::span<const std::size_t> places) {
  const EffectSet others = others_than(standing.model, places);
  if (others.empty()) return nominal_model(data);
  return fit_model(data, standing.curves, others, {}, standing.model.likelihood.discrepancies);
}

Model values_without(const StageData& data, const StandingModel& standing, std::span<const std::size_t> places) {
  const EffectSet others = others_than(standing.model, places);
  const Discrepancies& discrepancies = standing.model.likelihood.discrepancies;
  if (!others.empty()) return fit_values(data, standing.curves, others, {}, discrepancies);
  return {{}, shift_of(standing.curves, {}), true, likelihood_with(data, residuals_of(data), discrepancies)};
}

}  // namespace kenaf::gap::diagnose
