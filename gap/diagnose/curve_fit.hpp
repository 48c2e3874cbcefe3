// Least squares on effect curves: the values of effects, alone or together, that explain most of a gap.
//
// Only inner products are needed.
// Effects are taken to add: that holds for small ones, and is corrected where a fit is confirmed by simulation.
//
// Thread safety: values and pure functions.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "gap/diagnose/effect_curves.hpp"

namespace kenaf::gap::diagnose {

// Inner products of all columns of the curves, and of what they are fitted to.
struct Products {
  double gap_gap = 0;
  Eigen::VectorXd shift_gap;
  Eigen::MatrixXd shift_shift;
};
// `target`: what is to be explained, of each group.
Products products_of(const std::vector<GroupWhitener>& whiteners, const std::vector<Eigen::MatrixXd>& shifts,
                     const GroupVectors& target);

// A place on a curve, as weights of at most two of its columns.
struct OnCurve {
  std::size_t curve;
  double value;  // of the parameter
  std::array<int, 2> column{-1, -1};
  std::array<double, 2> weight{0, 0};
  double segment = 1;  // by how much the value grows from the first column to the second
};
// Of a value where the curve jumps, the nearer end of the jump, with the slope beyond it (none between two jumps).
OnCurve at_value(const std::vector<EffectCurve>& curves, std::size_t curve, double value);

struct CurveFit {
  std::vector<OnCurve> places;  // one for each effect that is fitted, in the order asked
  double left = 0;              // squared length of what is not explained
};
// Of a curve that jumps the fits are at an end of the jump or elsewhere, never between.
CurveFit fit_one(const Products& products, const std::vector<EffectCurve>& curves, std::size_t curve);
CurveFit fit_two(const Products& products, const std::vector<EffectCurve>& curves, std::size_t first,
                 std::size_t second);
// Any number of effects: the optimum of one and of two; of more, from where the first two fit, two at a time in turn
// until nothing is gained.
CurveFit fit_together(const Products& products, const std::vector<EffectCurve>& curves,
                      std::span<const std::size_t> effects);

// Squared length of what is left with effects at given places.
double left_with(const Products& products, std::span<const OnCurve> places);
// The products of that rest of the gap.
Products without_places(const Products& products, std::span<const OnCurve> places);

// The shift at given places, of a group whose points' shifts are the columns; of all groups.
Eigen::VectorXd shift_at(const Eigen::MatrixXd& shifts, std::span<const OnCurve> places);
GroupVectors shift_of(const EffectCurves& curves, std::span<const OnCurve> places);
Settings settings_of(std::span<const OnCurve> places);

}  // namespace kenaf::gap::diagnose
