// Shifts of a stage due to small errors of the numbers of the robot's description, as they occur for every robot that
// was described from drawings and a scale.
//
// The numbers are a population: their relative errors have mean 0 and a common standard deviation, which is estimated
// with each model (likelihood.hpp). So a number gets a name only if its error is far larger than the others', and an
// effect only if small errors of all numbers do not explain as much. (Prior with an estimated scale: Gelman et al.
// 2013, Bayesian Data Analysis, 3rd ed., ch. 5.)
//
// Thread safety: pure functions, except that the simulator runs.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "gap/diagnose/effect_curves.hpp"
#include "gap/diagnose/stage_data.hpp"

namespace kenaf::gap::diagnose {

// Returns those of `possible` that are numbers of the description, except `valued` and parts of these.
std::vector<std::size_t> numbers_but(std::span<const candidates::Candidate> candidates,
                                     std::span<const std::size_t> possible, std::span<const std::size_t> valued);

// For each group, in columns: the principal directions of the shifts of the numbers among `possible`, longest first, at
// most 12; 1 sigma is an error of Candidate::whole in every number. Linear, from the point of each curve nearest to the
// present value.
std::vector<Eigen::MatrixXd> number_shapes(const StageData& data, const EffectCurves& curves,
                                           std::span<const std::size_t> possible);

// The same around a model: shifts of the numbers with its `settings` applied, except `valued`, whose values are
// estimated. A wider track does not change the track speeds of a robot, unless its turns are limited.
std::vector<Eigen::MatrixXd> number_shapes_around(const StageData& data,
                                                  std::span<const candidates::Candidate> candidates,
                                                  std::span<const std::size_t> possible, const Settings& settings,
                                                  std::span<const std::size_t> valued, const Simulate& simulate);
// The same against a baseline with equal errors of the numbers: minus their shifts without `settings`.
std::vector<Eigen::MatrixXd> number_shapes_of_change(const StageData& data,
                                                     std::span<const candidates::Candidate> candidates,
                                                     std::span<const std::size_t> possible, const Settings& settings,
                                                     std::span<const std::size_t> valued, const Simulate& simulate);

}  // namespace kenaf::gap::diagnose
