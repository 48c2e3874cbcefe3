// What a stage shifts by where each number of the robot's description is a little off, as it is for every robot that was
// described from drawings and a scale.
//
// The numbers are a population: each is off by its own part of itself, the parts have mean 0 and one standard deviation, which
// is estimated with a model (likelihood.hpp). So a number gets a name only where it is off by far more than the others,
// and an effect only where numbers that are all a little off do not explain as much. (A prior of this kind, with its scale
// estimated: Gelman et al. 2013, Bayesian Data Analysis, 3rd ed., ch. 5.)
// Thread safety: a pure function.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "gap/diagnose/effect_curves.hpp"
#include "gap/diagnose/stage_data.hpp"

namespace kenaf::gap {

// Of each group, in columns: the directions in which the numbers among `possible` can be seen, longest first, at most 12
// together; 1 sigma is every number off by its Candidate::whole. Linear, from the point of each curve that is nearest to
// the present value.
std::vector<Eigen::MatrixXd> number_shapes(const StageData& data, const EffectCurves& curves,
                                           std::span<const std::size_t> possible);

}  // namespace kenaf::gap
