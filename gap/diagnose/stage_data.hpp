// The residuals of one stage as the statistics see them: the mean over the repeats of each manoeuvre, its noise, and
// shapes that the simulation leaves open.
//
// What a model lacks is alike in all repeats of a manoeuvre, so repeats are no independent evidence of an effect: they
// make the noise of their mean smaller, and a manoeuvre counts once.
//
// Thread safety: values and pure functions.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "gap/diagnose/folds.hpp"
#include "gap/diagnose/noise_floor.hpp"
#include "gap/diagnose/stage_features.hpp"

namespace kenaf::gap::diagnose {

// Bins of one channel, in a row.
struct Series {
  Eigen::Index first, count;
  std::size_t channel, kind;  // of diagnosis_channels(), of kind_of()
};

// One manoeuvre: a group of repeats. Vectors and rows of matrices are its bins.
struct StageGroup {
  std::vector<std::size_t> runs;
  std::vector<Bin> bins;  // that any of its runs has; channel by channel, in the order of time
  std::vector<Series> series;
  std::vector<double> t_s;                        // of each bin's middle, since the start
  std::vector<std::vector<Eigen::Index>> bin_of;  // of each run, of each of its bins: the group's
  Eigen::VectorXd count;                          // of used runs that have a bin
  Eigen::VectorXd residual;                       // measured minus nominal
  Eigen::VectorXd variance;                       // of its independent noise
  Eigen::MatrixXd local_shapes;                   // in columns; each with an amount of its own in this group, 1 sigma
  Eigen::MatrixXd shared_shapes;                  // in columns; each with one amount in all groups, 1 sigma
  Eigen::MatrixXd number_shapes;                  // likewise; 1 sigma is as far as numbers of the description are off
};

struct StageData {
  Passage passage;
  std::vector<StageGroup> groups;  // none that has no bins
};

// `repeats`: runs of each group. `residuals`: measured minus nominal of each run. `used`: what of them counts.
// Groups and bins are the same whatever is used, so that what was simulated of them fits; a bin that no used run has is
// as good as not measured.
StageData stage_data(Passage passage, const std::vector<StageFeatures>& features,
                     const std::vector<std::vector<std::size_t>>& repeats,
                     const std::vector<Eigen::VectorXd>& residuals, const NoiseFloor& floor,
                     const UsedParts& used = {});

// Values of each run, as the groups have them: means over all of their runs.
std::vector<Eigen::VectorXd> mean_of_groups(const StageData& data, const std::vector<Eigen::VectorXd>& of_runs);

std::size_t bin_count(const StageData& data);

}  // namespace kenaf::gap::diagnose
