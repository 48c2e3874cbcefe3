#include "gap/diagnose/effect_curves.hpp"

#include <algorithm>
#include <cmath>

namespace kenaf::gap {
namespace {

// Parts of the way from neutral to an end of the range.
constexpr double kSpread[] = {0.25, 1};

constexpr double kRoughReach = 2;

// Times the length that a straight line has: through the inner one of two points at the outer one, through the outer
// one at the inner one.
constexpr double kBent = 2;
constexpr int kHalvings = 4;
constexpr double kInward = 0.25;  // of the way from neutral to the innermost point

std::ptrdiff_t present_point(const EffectCurve& curve) {
  return std::ranges::find(curve.points, -1, &CurvePoint::column) - curve.points.begin();
}

bool has_obstacles(const Observations& observations) {
  return std::ranges::any_of(observations.worlds, [](const physics::WorldDescription& world) {
    return !world.boxes.empty() || !world.meshes.empty();
  });
}

bool applies(const physics::EffectInfo& effect, const Observations& observations) {
  if (effect.name == "command_loss") return false;
  if (effect.name.starts_with("flipper_")) return observations.robot.has_flippers();
  if (effect.name.starts_with("obstacle_")) return has_obstacles(observations);
  return true;
}

// A straight line between an exact point and a rough one near it would lead anywhere. But the ends of a curve stay:
// without them no fit could go beyond the exact point.
void forget_rough_points(EffectCurve& curve, double exact_value) {
  const double neutral = present_value(curve), reach = kRoughReach * (exact_value - neutral);
  const double first = curve.points.front().value, last = curve.points.back().value;
  std::erase_if(curve.points, [&](const CurvePoint& point) {
    if (point.value == first || point.value == last) return false;
    const double from_neutral = point.value - neutral;
    return !point.exact && from_neutral * reach > 0 && std::abs(from_neutral) < std::abs(reach);
  });
}

double length_at(const EffectCurves& curves, int column) {
  double squares = 0;
  for (const Eigen::MatrixXd& shift : curves.shifts) squares += shift.col(column).squaredNorm();
  return std::sqrt(squares);
}

// Half way between neighbours to one side of neutral between which a bent curve becomes longer than `length`.
void add_halves(const EffectCurves& curves, std::size_t curve, double length, std::vector<NewPoint>& halves) {
  const std::vector<CurvePoint>& points = curves.curves[curve].points;
  const double neutral = present_value(curves.curves[curve]);
  for (std::size_t i = 1; i < points.size(); ++i) {
    const bool outward = points[i].value > neutral;
    const CurvePoint &inner = points[outward ? i - 1 : i], &outer = points[outward ? i : i - 1];
    if (inner.column < 0 || outer.column < 0) continue;
    const double inner_length = length_at(curves, inner.column), outer_length = length_at(curves, outer.column);
    const double straight = inner_length * (outer.value - neutral) / (inner.value - neutral);
    if (inner_length < length && outer_length > std::max(length, kBent * straight))
      halves.push_back({curve, (inner.value + outer.value) / 2});
  }
}

// Nearer to neutral than the innermost one of the points on a side, where that is longer than `length` and the next one
// not as much longer as it is farther out: what the effect does all at once comes before.
void add_inner(const EffectCurves& curves, std::size_t curve, double length, std::vector<NewPoint>& inner) {
  const std::vector<CurvePoint>& points = curves.curves[curve].points;
  const std::ptrdiff_t middle = present_point(curves.curves[curve]);
  const double neutral = points[static_cast<std::size_t>(middle)].value;
  for (const std::ptrdiff_t outward : {-1, 1}) {
    const std::ptrdiff_t last = middle + 2 * outward;
    if (last < 0 || last >= std::ssize(points)) continue;
    const CurvePoint &first = points[static_cast<std::size_t>(middle + outward)],
                     &second = points[static_cast<std::size_t>(last)];
    const double first_length = length_at(curves, first.column), second_length = length_at(curves, second.column);
    const double straight = second_length * (first.value - neutral) / (second.value - neutral);
    if (first_length > std::max(length, kBent * straight))
      inner.push_back({curve, neutral + kInward * (first.value - neutral)});
  }
}

}  // namespace

std::vector<EffectCurve> candidate_curves(const Observations& observations, std::span<const std::string> without) {
  std::vector<EffectCurve> curves;
  for (const physics::EffectInfo& effect : physics::effect_catalogue()) {
    if (!applies(effect, observations) || std::ranges::find(without, effect.name) != without.end()) continue;
    // an effect is one number to be found: each of its parameters is a candidate of its own
    for (const physics::EffectParameter& parameter : effect.parameters) {
      const double present = observations.robot.effects.*parameter.value;
      curves.push_back({&effect, &parameter, {{present, -1, true}}, 0});
    }
  }
  return curves;
}

double present_value(const EffectCurve& curve) {
  return curve.points[static_cast<std::size_t>(present_point(curve))].value;
}

double squared_length(const Whitened& runs) {
  double sum = 0;
  for (const Eigen::VectorXd& run : runs) sum += run.squaredNorm();
  return sum;
}

void set_whiteners(EffectCurves& curves, std::vector<Whitener> whiteners) {
  curves.whiteners = std::move(whiteners);
  for (std::size_t r = 0; r < curves.residual.size(); ++r) {
    curves.gap[r] = curves.whiteners[r](curves.residual[r]);
    for (Eigen::Index c = 0; c < curves.shifts[r].cols(); ++c)
      curves.shifts[r].col(c) = curves.whiteners[r](curves.raw_shifts[r].col(c));
  }
}

Variation varied(const EffectCurves& curves, std::span<const NewPoint> effects, const Predictor& predictor) {
  Variation variation = predictor.unvaried();
  for (const NewPoint& effect : effects) variation.effects.*curves.curves[effect.curve].parameter->value = effect.value;
  return variation;
}

void add_points(EffectCurves& curves, std::span<const NewPoint> points, Fidelity fidelity, Predictor& predictor) {
  std::vector<Variation> variations;
  for (const NewPoint& point : points) variations.push_back(varied(curves, {&point, 1}, predictor));
  insert_points(curves, points, predictor.shifts(variations, fidelity), fidelity);
}

void insert_points(EffectCurves& curves, std::span<const NewPoint> points, const std::vector<Shift>& shifts,
                   Fidelity fidelity) {
  const auto first = static_cast<int>(curves.shifts.front().cols());
  for (std::size_t r = 0; r < curves.shifts.size(); ++r) {
    for (auto* matrix : {&curves.raw_shifts[r], &curves.shifts[r]})
      matrix->conservativeResize(Eigen::NoChange, first + std::ssize(points));
    for (std::size_t p = 0; p < points.size(); ++p) {
      const auto column = first + static_cast<Eigen::Index>(p);
      curves.raw_shifts[r].col(column) = shifts[p][r];
      curves.shifts[r].col(column) = curves.whiteners[r](shifts[p][r]);
    }
  }
  for (std::size_t p = 0; p < points.size(); ++p) {
    EffectCurve& curve = curves.curves[points[p].curve];
    const CurvePoint added{points[p].value, first + static_cast<int>(p), fidelity == Fidelity::every_run};
    if (added.exact) forget_rough_points(curve, added.value);
    const auto place = std::ranges::lower_bound(curve.points, added.value, {}, &CurvePoint::value);
    if (place != curve.points.end() && place->value == added.value)
      *place = added;
    else
      curve.points.insert(place, added);
    curve.visible = std::max(curve.visible, length_at(curves, added.column));
  }
}

void follow_bends(EffectCurves& curves, const std::function<void(std::span<const NewPoint>)>& simulate) {
  const double gap = std::sqrt(squared_length(curves.gap));
  for (int i = 0; i < kHalvings; ++i) {
    std::vector<NewPoint> points;
    for (std::size_t c = 0; c < curves.curves.size(); ++c) {
      add_halves(curves, c, gap, points);
      add_inner(curves, c, gap, points);
    }
    if (points.empty()) return;
    simulate(points);
  }
}

EffectCurves scan_effects(std::vector<EffectCurve> candidates, const std::vector<Eigen::VectorXd>& residuals,
                          const NoiseFloor& floor, Predictor& predictor) {
  EffectCurves curves{std::move(candidates), residuals, {}, {}, residuals, {}};
  for (const Eigen::VectorXd& run : residuals) curves.raw_shifts.emplace_back(run.size(), 0);
  curves.shifts = curves.raw_shifts;
  set_whiteners(curves, floor.whiteners);
  std::vector<NewPoint> points;
  for (std::size_t c = 0; c < curves.curves.size(); ++c) {
    const double neutral = curves.curves[c].points.front().value;
    for (const double end : {curves.curves[c].parameter->min, curves.curves[c].parameter->max})
      for (const double part : kSpread)
        if (end != neutral) points.push_back({c, neutral + part * (end - neutral)});
  }
  add_points(curves, points, Fidelity::coarse, predictor);
  follow_bends(curves,
               [&](std::span<const NewPoint> halves) { add_points(curves, halves, Fidelity::coarse, predictor); });
  return curves;
}

}  // namespace kenaf::gap
