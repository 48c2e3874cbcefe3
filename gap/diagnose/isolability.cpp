#include "gap/diagnose/isolability.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/features.hpp"
#include "gap/parallel.hpp"
#include "rollout/roll_out.hpp"

namespace kenaf::gap {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kVisible = 3;     // floors: shorter shifts have no direction to speak of
constexpr double kLongest_s = 40;  // of a manoeuvre that is worth proposing, at most (chosen)
constexpr double kSlope = 0.1;     // of the way back to neutral, for the direction of a value

// The point nearest to neutral that is long enough to have a direction; the longest one where none is.
int direction_column(const EffectCurve& curve, const VectorXd& length) {
  int best = -1;
  for (const CurvePoint& point : curve.points) {
    if (point.column < 0) continue;
    if (best < 0) {
      best = point.column;
      continue;
    }
    const bool best_visible = length[best] >= kVisible, visible = length[point.column] >= kVisible;
    if (visible == best_visible ? (visible ? length[point.column] < length[best] : length[point.column] > length[best])
                                : visible)
      best = point.column;
  }
  return best;
}

physics::Effects effects_of(const physics::RobotDescription& robot, const EffectCurves& curves, const Model& model,
                            std::ptrdiff_t changed) {
  physics::Effects effects = robot.effects;
  for (std::size_t i = 0; i < model.places.size(); ++i) {
    const EffectCurve& curve = curves.curves[model.places[i].curve];
    const double neutral = robot.effects.*curve.parameter->value;
    const double back = static_cast<std::ptrdiff_t>(i) == changed ? kSlope : 0;
    effects.*curve.parameter->value = model.places[i].value + back * (neutral - model.places[i].value);
  }
  return effects;
}

VectorXd without_span(VectorXd vector, const std::vector<VectorXd>& directions) {
  MatrixXd basis(vector.size(), std::ssize(directions));
  for (std::size_t i = 0; i < directions.size(); ++i) basis.col(static_cast<Eigen::Index>(i)) = directions[i];
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(basis);
  const MatrixXd q = qr.householderQ() * MatrixXd::Identity(basis.rows(), qr.rank());
  vector -= q * (q.transpose() * vector);
  return vector;
}

double score_of(const rollout::Manoeuvre& manoeuvre, const physics::RobotDescription& nominal,
                const EffectCurves& curves, std::span<const Model> rivals, const NoiseFloor& floor, double span_s) {
  std::vector<std::string> ignored;
  const physics::WorldDescription world = physics::load_world(manoeuvre.world, ignored);
  rollout::RollOutOptions options;
  options.noise_scale = options.mocap_noise_m = options.mocap_noise_rad = 0;
  const runs::Run plain = rollout::roll_out(nominal, world, manoeuvre, options).run;
  const FeatureMap map(plain, span_s);
  const rollout::Manoeuvre replay = rollout::replay_of(plain, manoeuvre.name);
  const auto whitened = [&](const Model& model, std::ptrdiff_t changed) {
    physics::RobotDescription robot = nominal;
    robot.effects = effects_of(nominal, curves, model, changed);
    VectorXd features = map.of(rollout::roll_out(robot, world, replay, options).run) - map.measured();
    for (std::size_t b = 0; b < map.bins().size(); ++b) {
      const double sigma = floor.sigma[map.bins()[b].channel];
      features[static_cast<Eigen::Index>(b)] *= sigma > 0 ? 1 / sigma : 0;  // a channel that nobody measured
    }
    return features;
  };
  std::vector<VectorXd> shift;
  std::vector<std::vector<VectorXd>> slopes;
  for (const Model& rival : rivals) {
    shift.push_back(whitened(rival, -1));
    slopes.emplace_back();
    for (std::ptrdiff_t i = 0; i < std::ssize(rival.places); ++i)
      slopes.back().push_back(whitened(rival, i) - shift.back());
  }
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t a = 0; a < rivals.size(); ++a)
    for (std::size_t b = a + 1; b < rivals.size(); ++b) {
      std::vector<VectorXd> free = slopes[a];
      free.insert(free.end(), slopes[b].begin(), slopes[b].end());
      least = std::min(least, without_span(shift[a] - shift[b], free).norm());
    }
  return least;
}

}  // namespace

Isolability isolability(const EffectCurves& curves) {
  const Products products = products_of(curves, curves.gap);
  const VectorXd length = products.shift_shift.diagonal().cwiseSqrt();
  Isolability result;
  std::vector<int> columns;
  for (std::size_t c = 0; c < curves.curves.size(); ++c) {
    const int column = direction_column(curves.curves[c], length);
    if (column < 0 || length[column] < 1) continue;
    result.curves.push_back(c);
    columns.push_back(column);
  }
  const auto count = std::ssize(columns);
  result.angle_deg = MatrixXd::Zero(count, count);
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < count; ++j) {
      if (i == j) continue;
      const int a = columns[static_cast<std::size_t>(i)], b = columns[static_cast<std::size_t>(j)];
      const double cosine = std::abs(products.shift_shift(a, b)) / (length[a] * length[b]);
      result.angle_deg(i, j) = std::acos(std::min(1.0, cosine)) * 180 / std::numbers::pi;
    }
  return result;
}

std::vector<NextManoeuvre> rank_manoeuvres(const physics::RobotDescription& robot, const EffectCurves& curves,
                                           std::span<const Model> rivals, const NoiseFloor& floor, double span_s,
                                           unsigned threads, const std::atomic<bool>* stop) {
  std::vector<NextManoeuvre> ranking;
  if (rivals.size() < 2) return ranking;
  std::vector<rollout::Manoeuvre> manoeuvres = rollout::shipped_manoeuvres();
  std::erase_if(manoeuvres, [&](const rollout::Manoeuvre& manoeuvre) {
    const bool moves_flippers =
        std::ranges::any_of(manoeuvre.phases, [](const rollout::Phase& phase) { return phase.flipper_rad.has_value(); });
    return manoeuvre.at_most_s() > kLongest_s || (moves_flippers && !robot.has_flippers());
  });
  std::vector<std::size_t> separates;
  for (const Model& rival : rivals)
    for (const OnCurve& place : rival.places)
      if (std::ranges::count(separates, place.curve) == 0) separates.push_back(place.curve);
  ranking.resize(manoeuvres.size());
  for_each_job(manoeuvres.size(), threads, [&](std::size_t m) {
    check_goes_on(stop);
    ranking[m] = {manoeuvres[m].name, separates, score_of(manoeuvres[m], robot, curves, rivals, floor, span_s)};
  });
  std::ranges::stable_sort(ranking, std::ranges::greater{}, &NextManoeuvre::expected_score);
  return ranking;
}

}  // namespace kenaf::gap
