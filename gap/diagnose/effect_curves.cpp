#include "gap/diagnose/effect_curves.hpp"

#include <algorithm>
#include <cmath>

namespace kenaf::gap {
namespace {

// Parts of the way from neutral to an end of the range.
constexpr double kSpread[] = {0.04, 0.2, 0.5, 1};

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

}  // namespace

std::vector<EffectCurve> candidate_curves(const Observations& observations, std::span<const std::string> without) {
  std::vector<EffectCurve> curves;
  for (const physics::EffectInfo& effect : physics::effect_catalogue()) {
    if (!applies(effect, observations) || std::ranges::find(without, effect.name) != without.end()) continue;
    // an effect is one number to be found: each of its parameters is a candidate of its own
    for (const physics::EffectParameter& parameter : effect.parameters) {
      const double present = observations.robot.effects.*parameter.value;
      curves.push_back({&effect, &parameter, {{present, -1}}, 0});
    }
  }
  return curves;
}

void add_points(EffectCurves& curves, std::span<const NewPoint> points, const std::vector<Eigen::VectorXd>& nominal,
                const NoiseFloor& floor, Predictor& predictor) {
  std::vector<Variation> variations;
  for (const NewPoint& point : points) {
    variations.push_back(predictor.nominal());
    variations.back().effects.*curves.curves[point.curve].parameter->value = point.value;
  }
  const auto predicted = predictor.predict(variations);
  const auto first = static_cast<int>(curves.shifts.front().cols());
  for (std::size_t r = 0; r < nominal.size(); ++r) {
    curves.shifts[r].conservativeResize(nominal[r].size(), first + std::ssize(points));
    for (std::size_t p = 0; p < points.size(); ++p)
      curves.shifts[r].col(first + static_cast<Eigen::Index>(p)) =
          floor.whiteners[r](predicted[p][r] - nominal[r]);
  }
  for (std::size_t p = 0; p < points.size(); ++p) {
    EffectCurve& curve = curves.curves[points[p].curve];
    const CurvePoint added{points[p].value, first + static_cast<int>(p)};
    curve.points.insert(std::ranges::upper_bound(curve.points, added.value, {}, &CurvePoint::value), added);
    double length = 0;
    for (const Eigen::MatrixXd& shift : curves.shifts) length += shift.col(added.column).squaredNorm();
    curve.visible = std::max(curve.visible, std::sqrt(length));
  }
}

EffectCurves scan_effects(std::vector<EffectCurve> candidates, const std::vector<Eigen::VectorXd>& residuals,
                          const std::vector<Eigen::VectorXd>& nominal, const NoiseFloor& floor, Predictor& predictor) {
  EffectCurves curves{std::move(candidates), {}, {}};
  for (std::size_t r = 0; r < residuals.size(); ++r) {
    curves.gap.push_back(floor.whiteners[r](residuals[r]));
    curves.shifts.emplace_back(residuals[r].size(), 0);
  }
  std::vector<NewPoint> points;
  for (std::size_t c = 0; c < curves.curves.size(); ++c) {
    const double neutral = curves.curves[c].points.front().value;
    for (const double end : {curves.curves[c].parameter->min, curves.curves[c].parameter->max})
      for (const double part : kSpread)
        if (end != neutral) points.push_back({c, neutral + part * (end - neutral)});
  }
  add_points(curves, points, nominal, floor, predictor);
  return curves;
}

}  // namespace kenaf::gap
