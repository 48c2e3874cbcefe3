// Pairs the runs of two datasets for comparison.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "formats/runs/dataset.hpp"

namespace kenaf::gap::compare {

struct RunPair {
  std::size_t real, sim;  // indices in Dataset::runs
  std::size_t repeat;     // of the manoeuvre, from 0
};

struct LeftOutRun {
  enum class Side { real, sim } side;
  std::size_t index;  // in Dataset::runs
  std::string why;    // in words
};

struct RunPairs {
  std::vector<RunPair> pairs;  // in the order of the real runs
  std::vector<LeftOutRun> left_out;
};

// Pairs the k-th repeat of a manoeuvre with the k-th of the other dataset, in the order in which the datasets list
// them. Runs without a manoeuvre's name count as one manoeuvre. Runs without a counterpart are left out, with the
// reason.
RunPairs pair_runs(const runs::Dataset& real, const runs::Dataset& sim);

}  // namespace kenaf::gap::compare
