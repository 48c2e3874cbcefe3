// The residuals of one stage for the statistics: the mean over the repeats of each manoeuvre, its noise, and the
// simulation's open shapes.
//
// A model's discrepancy is the same in all repeats of a manoeuvre, so repeats are not independent evidence: they reduce
// the noise of their mean, and a manoeuvre counts once.
//
// Thread safety: values and pure functions.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "gap/diagnose/folds.hpp"
#include "gap/diagnose/noise_floor.hpp"
#include "gap/diagnose/stage_features.hpp"

namespace kenaf::gap::diagnose {

// Variance of a bin that does not count: huge compared with any noise in any unit.
inline constexpr double kVarianceIfUnused = 1e12;

// Consecutive bins of one channel.
struct Series {
  Eigen::Index first, count;
  std::size_t channel, kind;  // of diagnosis_channels(), of kind_of()
};

// One manoeuvre: a group of repeats. Vectors and rows of matrices are indexed by its bins.
struct StageGroup {
  std::vector<std::size_t> runs;
  std::vector<Bin> bins;  // those that any of its runs has; channel by channel, in the order of time
  std::vector<Series> series;
  std::vector<double> t_s;                        // middle of each bin, since the start
  std::vector<std::vector<Eigen::Index>> bin_of;  // for each run and each of its bins: the group's bin
  Eigen::VectorXd count;                          // number of used runs that have the bin
  Eigen::VectorXd residual;                       // measured minus nominal
  Eigen::VectorXd variance;                       // of the residual's independent noise
  Eigen::MatrixXd local_shapes;                   // in columns; each with a separate amount in this group, 1 sigma
  Eigen::MatrixXd shared_shapes;                  // in columns; each with one amount in all groups, 1 sigma
  Eigen::MatrixXd number_shapes;                  // likewise; 1 sigma is the error of the description's numbers
};

struct StageData {
  Passage passage;
  std::vector<StageGroup> groups;  // none without bins
};

// `repeats`: runs of each group. `residuals`: measured minus nominal for each run. `used`: the parts that count. Groups
// and bins do not depend on `used`, so that simulated shifts fit; a bin without a used run has a huge variance.
StageData stage_data(Passage passage, const std::vector<StageFeatures>& features,
                     const std::vector<std::vector<std::size_t>>& repeats,
                     const std::vector<Eigen::VectorXd>& residuals, const NoiseFloor& floor,
                     const UsedParts& used = {});

// Averages values of each run over the runs of each group, by bin.
std::vector<Eigen::VectorXd> mean_of_groups(const StageData& data, const std::vector<Eigen::VectorXd>& of_runs);

std::size_t bin_count(const StageData& data);

}  // namespace kenaf::gap::diagnose
