// Finds runs that repeat each other.
//
// Thread safety: pure functions.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "gap/diagnose/observation.hpp"
#include "gap/diagnose/stage_features.hpp"

namespace kenaf::gap::diagnose {

// Groups runs with the same manoeuvre, world, initial speed, and commands, whose times may differ slightly as operators
// react to what they see. In the order of first occurrence. A dataset that gives one name to runs with different
// commands has as many groups as runs.
std::vector<std::vector<std::size_t>> repeats_of(const Observations& observations);

// The same, plus runs of the manoeuvre in which the operator gave the same commands at other times, or omitted some,
// because the outcome differed. Their differences count as spread, like those of repeats.
std::vector<std::vector<std::size_t>> same_command_sequence_of(const Observations& observations);

// The run of a group with the median duration.
std::size_t representative(const Observations& observations, const std::vector<std::size_t>& group);

// Deviations of runs from the mean of their repeats, by bins at the same time, scaled to the variance of one run.
struct Deviations {
  std::vector<Eigen::VectorXd> of_runs;   // empty for a run without repeats; 0 in bins that are not shared
  std::vector<std::vector<bool>> shared;  // shared_bins(): the other bins say nothing of repeats
};
Deviations deviations_from_repeats(const std::vector<StageFeatures>& features,
                                   const std::vector<Eigen::VectorXd>& residuals,
                                   const std::vector<std::vector<std::size_t>>& repeats);

// For each run, which of its bins at least one of its repeats also has.
std::vector<std::vector<bool>> shared_bins(const std::vector<StageFeatures>& features,
                                           const std::vector<std::vector<std::size_t>>& repeats);

}  // namespace kenaf::gap::diagnose
