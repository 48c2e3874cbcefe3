// Whether effects of a model can stand in for each other, so that without one the others do some of what it does.
//
// Thread safety: pure functions.
#pragma once

#include <Eigen/Core>
#include <span>

#include "gap/diagnose/side_by_side.hpp"

namespace kenaf::gap::diagnose {

// Inner products of the shifts of a model's effects, in noise units without open shapes; square, in the order of its
// places.
Eigen::MatrixXd products_of_effects(const StageData& data, const StandingModel& standing);

// The smallest sine of the angle between the shifts of two of `places`: the part of one, rms, that no amount of the
// other does. 1 if none of them has a length.
double least_apart(const Eigen::MatrixXd& products, std::span<const std::size_t> places);

}  // namespace kenaf::gap::diagnose
