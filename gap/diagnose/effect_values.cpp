#include "gap/diagnose/effect_values.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "gap/diagnose/significance.hpp"
#include "gap/diagnose/trend.hpp"

namespace kenaf::gap::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// p value of Cochran's Q above which manoeuvres are taken to agree.
constexpr double kAgree = 0.05;
// Two places closer than this share of a curve's segment are one.
constexpr double kSamePlace = 1e-6;

MatrixXd slopes_of_group(const StandingModel& standing, std::size_t group) {
  const MatrixXd& shifts = standing.curves.shifts[group];
  MatrixXd result = MatrixXd::Zero(shifts.rows(), std::ssize(standing.model.places));
  for (std::size_t i = 0; i < standing.model.places.size(); ++i) {
    const OnCurve& place = standing.model.places[i];
    auto slope = result.col(static_cast<Index>(i));
    if (place.column[1] >= 0) slope += shifts.col(place.column[1]);
    if (place.column[0] >= 0) slope -= shifts.col(place.column[0]);
    if (place.segment != 0) slope /= place.segment;
  }
  return result;
}

// One manoeuvre's own estimate of one value, with the others fixed.
struct OwnValue {
  double offset, information;  // from the common value; 1 / variance
};

// One manoeuvre's own optimum on an effect's curve; `rest`: the model's whitened residual. Not along the slope, which
// would lead far out of the range where an effect saturates.
OwnValue own_value(const EffectCurves& curves, const OnCurve& place, const MatrixXd& shifts,
                   const GroupWhitener& whitener, const VectorXd& rest) {
  // the points of this curve alone, whitened
  EffectCurve curve{curves.curves[place.curve].candidate, {}};
  MatrixXd white(shifts.rows(), std::ssize(curves.curves[place.curve].points));
  for (const CurvePoint& point : curves.curves[place.curve].points) {
    const auto column = static_cast<int>(std::ssize(curve.points));
    white.col(column) = point.column < 0 ? VectorXd::Zero(shifts.rows()) : VectorXd(shifts.col(point.column));
    curve.points.push_back({point.value, column, point.exact, point.jump});
  }
  white = whitener(std::move(white));

  // the best place, and its information from the distance to it
  const std::vector<EffectCurve> alone{std::move(curve)};
  const OnCurve common = at_value(alone, 0, place.value);
  const VectorXd target = rest + shift_at(white, {&common, 1});
  const Products products{target.squaredNorm(), white.transpose() * target, white.transpose() * white};
  const OnCurve own = fit_one(products, alone, 0).places.front();
  const double offset = own.value - place.value;
  if (std::abs(offset) > kSamePlace * place.segment)
    return {offset, (shift_at(white, {&own, 1}) - shift_at(white, {&common, 1})).squaredNorm() / (offset * offset)};
  if (common.segment == 0) return {0, 0};
  return {offset, (white.col(common.column[1]) - white.col(common.column[0])).squaredNorm() /
                      (common.segment * common.segment)};
}

// +-kHalfWidth sigma, but not beyond a jump of the curve; next to a jump its whole segment, as the jump may be anywhere
// in it.
Interval interval_of(const EffectCurve& curve, const candidates::Candidate& candidate, double value, double sigma) {
  Interval interval{value, std::max(candidate.min, value - kHalfWidth * sigma),
                    std::min(candidate.max, value + kHalfWidth * sigma)};
  for (std::size_t i = 1; i < curve.points.size(); ++i) {
    const double a = curve.points[i - 1].value, b = curve.points[i].value;
    if (!curve.points[i].jump) continue;
    if (b <= value) interval.from = b == value ? a : std::max(interval.from, a);
    if (a >= value) interval.to = a == value ? b : std::min(interval.to, b);
  }
  return interval;
}

// Spread between manoeuvres by the method of moments, and the resulting variance of the mean.
struct RandomEffect {
  double spread = 0, p_agree = 1, variance_of_mean = 0;
};

RandomEffect random_effect(const std::vector<OwnValue>& own) {
  // weighted mean and Cochran's Q = sum w (x - mean)^2, w = 1 / variance
  double weights = 0, squares = 0, sum = 0;
  for (const auto& [offset, information] : own) {
    weights += information, squares += information * information, sum += information * offset;
  }
  RandomEffect result;
  if (weights <= 0) return result;
  const double mean = sum / weights;
  double q = 0;
  for (const auto& [offset, information] : own) q += information * (offset - mean) * (offset - mean);
  // the effective number of manoeuvres, as those with little information are no degrees of freedom; at least two, or
  // tiny misfits compared with one dominant manoeuvre would count as spread
  const double manoeuvres = std::max(2.0, weights * weights / squares);
  const double freedom = manoeuvres - 1;
  result.p_agree = p_of_squares(q, freedom);

  // DerSimonian and Laird: spread^2 = (Q - freedom) / (W (1 - 1 / n_eff)), W = sum w, n_eff = W^2 / sum w^2; with the
  // spread, each manoeuvre has the weight 1 / (1 / w + spread^2)
  const double variance = std::max(0.0, (q - freedom) / (weights * (1 - 1 / manoeuvres)));
  if (result.p_agree < kAgree) result.spread = std::sqrt(variance);
  double with_spread = 0;
  for (const auto& [offset, information] : own)
    if (information > 0) with_spread += 1 / (1 / information + result.spread * result.spread);
  result.variance_of_mean = 1 / with_spread;
  return result;
}

}  // namespace

std::vector<MatrixXd> slopes(const StageData& data, const StandingModel& standing) {
  std::vector<MatrixXd> result;
  for (std::size_t g = 0; g < data.groups.size(); ++g) result.push_back(slopes_of_group(standing, g));
  return result;
}

std::vector<EffectValue> effect_values(const StageData& data, const StandingModel& standing, double borne_out) {
  const Model& model = standing.model;
  const std::vector<GroupWhitener> whiteners = whiteners_of(data, model.likelihood.discrepancies);

  // generalised least squares: the covariance of all values together
  const std::vector<MatrixXd> columns = slopes(data, standing);
  const MatrixXd information = inner_products(whiteners, columns);
  const MatrixXd covariance = information.completeOrthogonalDecomposition().pseudoInverse();

  // each manoeuvre's own estimate of each value, with shared shapes at their most likely amounts
  std::vector<std::vector<OwnValue>> own(model.places.size());
  const GroupVectors residual = rest_of(data, model);
  const std::vector<VectorXd> rest = whitened_rest(data, residual, model.likelihood.discrepancies);
  for (std::size_t g = 0; g < data.groups.size(); ++g)
    for (std::size_t e = 0; e < model.places.size(); ++e)
      own[e].push_back(own_value(standing.curves, model.places[e], standing.curves.shifts[g], whiteners[g], rest[g]));

  // per effect the interval by the larger of both standard errors, its trend, and its fit in kinds of channels
  const GroupVectors left = without_open_shapes(data, residual, model.likelihood.discrepancies);
  const std::vector<FitByKind> by_kind = fit_by_kind(data, standing, left, borne_out);
  std::vector<EffectValue> values;
  for (std::size_t e = 0; e < model.places.size(); ++e) {
    const candidates::Candidate& candidate = standing.curves.candidates[model.places[e].curve];
    const RandomEffect random = random_effect(own[e]);
    const auto i = static_cast<Index>(e);
    const double variance = information(i, i) > 0 ? covariance(i, i) : std::numeric_limits<double>::infinity();
    const double sigma = std::sqrt(std::max(variance, random.spread > 0 ? random.variance_of_mean : 0.0));
    const double value = model.places[e].value;
    values.push_back({interval_of(standing.curves.curves[model.places[e].curve], candidate, value, sigma),
                      random.spread, random.p_agree, trend(data, columns, i, value - candidate.present, left),
                      by_kind[e]});
  }
  return values;
}

}  // namespace kenaf::gap::diagnose
