// Which runs repeat each other.
//
// Thread safety: pure functions.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "gap/diagnose/observation.hpp"
#include "gap/diagnose/stage_features.hpp"

namespace kenaf::gap::diagnose {

// Runs that share a manoeuvre, a world, the speed with which they begin, and their commands, which need not be the same
// at every time: an operator decides by what he sees. In the order in which each first comes. A dataset that calls all
// of its runs by one name although each has commands of its own has as many groups as runs.
std::vector<std::vector<std::size_t>> repeats_of(const Observations& observations);

// The same, and with them the runs of that manoeuvre in which the operator gave the same orders at other times, or left
// one out: he saw another outcome. How such runs differ is spread, as between repeats.
std::vector<std::vector<std::size_t>> same_orders_of(const Observations& observations);

// The run of a group whose duration is the middle one.
std::size_t representative(const Observations& observations, const std::vector<std::size_t>& group);

// How each run deviates from the mean of its repeats, by bins at the same time; scaled so that its variance is that of
// one run. Empty for a run without repeats; 0 where one repeat alone goes on.
std::vector<Eigen::VectorXd> deviations_from_repeats(const std::vector<StageFeatures>& features,
                                                     const std::vector<Eigen::VectorXd>& residuals,
                                                     const std::vector<std::vector<std::size_t>>& repeats);

// The bins of a group's runs that more than one of them has.
std::vector<std::vector<bool>> shared_bins(const std::vector<StageFeatures>& features,
                                           const std::vector<std::vector<std::size_t>>& repeats);

}  // namespace kenaf::gap::diagnose
