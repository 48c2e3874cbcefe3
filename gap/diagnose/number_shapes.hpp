// What a stage shifts by where each number of the robot's description is a little off, as it is for every robot that
// was described from drawings and a scale.
//
// The numbers are a population: each is off by its own part of itself, the parts have mean 0 and one standard
// deviation, which is estimated with a model (likelihood.hpp). So a number gets a name only where it is off by far more
// than the others, and an effect only where numbers that are all a little off do not explain as much. (A prior of this
// kind, with its scale estimated: Gelman et al. 2013, Bayesian Data Analysis, 3rd ed., ch. 5.)
//
// Thread safety: pure functions, apart from what the simulator does.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "gap/diagnose/effect_curves.hpp"
#include "gap/diagnose/stage_data.hpp"

namespace kenaf::gap::diagnose {

// Those of `possible` that are numbers of the description, but for `valued` and what is a part of them.
std::vector<std::size_t> numbers_but(std::span<const candidates::Candidate> candidates,
                                     std::span<const std::size_t> possible, std::span<const std::size_t> valued);

// Of each group, in columns: the directions in which the numbers among `possible` can be seen, longest first, at most
// 12 together; 1 sigma is every number off by its Candidate::whole. Linear, from the point of each curve that is
// nearest to the present value.
std::vector<Eigen::MatrixXd> number_shapes(const StageData& data, const EffectCurves& curves,
                                           std::span<const std::size_t> possible);

// The same around a model: what the numbers shift beside its `settings`, but for those of `valued`, whose values are
// estimated. A track that is wider does nothing to a robot that is told its track speeds, and a lot to one whose turns
// are limited.
std::vector<Eigen::MatrixXd> number_shapes_around(const StageData& data,
                                                  std::span<const candidates::Candidate> candidates,
                                                  std::span<const std::size_t> possible, const Settings& settings,
                                                  std::span<const std::size_t> valued, const Simulate& simulate);
// What of that is left against a baseline, in which the numbers are off as well: less what they shift without
// `settings`.
std::vector<Eigen::MatrixXd> number_shapes_of_change(const StageData& data,
                                                     std::span<const candidates::Candidate> candidates,
                                                     std::span<const std::size_t> possible, const Settings& settings,
                                                     std::span<const std::size_t> valued, const Simulate& simulate);

}  // namespace kenaf::gap::diagnose
