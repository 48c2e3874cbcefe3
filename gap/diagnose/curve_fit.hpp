// Least squares on effect curves: the values of one or more effects that explain most of a gap.
//
// Only inner products are needed. Effects are assumed to add, which holds for small ones; simulation corrects the sum
// where a fit is confirmed.
//
// Thread safety: values and pure functions.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "gap/diagnose/effect_curves.hpp"

namespace kenaf::gap::diagnose {

// Inner products of all columns of the curves with each other and with the target.
struct Products {
  double gap_gap = 0;
  Eigen::VectorXd shift_gap;
  Eigen::MatrixXd shift_shift;
};
// `target`: the residual to be explained, for each group.
Products products_of(const std::vector<GroupWhitener>& whiteners, const std::vector<Eigen::MatrixXd>& shifts,
                     const GroupVectors& target);

// A point on a curve, as weights of at most two of its columns.
struct OnCurve {
  std::size_t curve;
  double value;  // of the parameter
  std::array<int, 2> column{-1, -1};
  std::array<double, 2> weight{0, 0};
  double segment = 1;  // increase of the value from the first column to the second
};
// For a value inside a jump of the curve, returns the nearer end of the jump, with the slope beyond it (none between
// two jumps).
OnCurve at_value(const std::vector<EffectCurve>& curves, std::size_t curve, double value);

struct CurveFit {
  std::vector<OnCurve> places;  // one per fitted effect, in the order of the request
  double left = 0;              // squared length of the residual
};
// Fits are never inside a jump of a curve.
CurveFit fit_one(const Products& products, const std::vector<EffectCurve>& curves, std::size_t curve);
CurveFit fit_two(const Products& products, const std::vector<EffectCurve>& curves, std::size_t first,
                 std::size_t second);
// Any number of effects. Exact optimum for one or two; for more, starts from the fit of the first two and optimises
// pairs in turn until nothing is gained.
CurveFit fit_together(const Products& products, const std::vector<EffectCurve>& curves,
                      std::span<const std::size_t> effects);

// Squared length of the residual with effects at the given places.
double left_with(const Products& products, std::span<const OnCurve> places);
// The products of that residual.
Products without_places(const Products& products, std::span<const OnCurve> places);

// The shift at given places: for one group, whose points' shifts are the columns; for all groups.
Eigen::VectorXd shift_at(const Eigen::MatrixXd& shifts, std::span<const OnCurve> places);
GroupVectors shift_of(const EffectCurves& curves, std::span<const OnCurve> places);
Settings settings_of(std::span<const OnCurve> places);

}  // namespace kenaf::gap::diagnose
