// The size of a gap, and the share of it that a model removes.
//
// A gap is measured in units of noise, and each kind of channels is weighted by its own gap: a voltage error of 300
// noise units must not hide track speed errors of 20. A bin of kind k with mean square B_k, of which F_k is noise and
// spread of repeats, has the weight (B_k - F_k) / B_k^2: about 1 / B_k far above the noise, and 0 without a gap.
//
// Thread safety: values and pure functions.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "gap/diagnose/noise_floor.hpp"
#include "gap/diagnose/repeats.hpp"
#include "gap/diagnose/stage_features.hpp"

namespace kenaf::gap::diagnose {

// Sums over each kind of channels.
struct KindSquares {
  std::vector<double> sum;  // sum of squares, in units of noise
  std::vector<double> bins;
};
KindSquares no_squares();
KindSquares& operator+=(KindSquares& sum, const KindSquares& more);

// Squares of each run's whitened differences, none of a run without any. `counted`: for each run, the bins that count;
// empty: all.
std::vector<KindSquares> squares_of_runs(const std::vector<StageFeatures>& features, const NoiseFloor& floor,
                                         const std::vector<Eigen::VectorXd>& differences,
                                         const std::vector<std::vector<bool>>& counted = {});
// Their sum over all runs.
KindSquares squares_by_kind(const std::vector<StageFeatures>& features, const NoiseFloor& floor,
                            const std::vector<Eigen::VectorXd>& differences,
                            const std::vector<std::vector<bool>>& counted = {});
// Those of the spread of repeats; in kinds of channels without it, those that noise alone is expected to have: 1 in
// each bin, more in a difference from a baseline (noise_of_difference()).
KindSquares squares_of_floor(const std::vector<StageFeatures>& features, const NoiseFloor& floor,
                             const Deviations& repeats);

// The weight of a bin of each kind. `floor`: of repeats or noise. All 1 if no kind has a gap.
std::vector<double> kind_weights(const KindSquares& before, const KindSquares& floor);

// Root of the weighted mean square, in units of noise.
double weighted_rms(const KindSquares& squares, const std::vector<double>& kind_weights);

// Explained share of the squared gap beyond `floor`; all arguments are rms. At most 1, negative if the gap grew, 0
// without a gap.
double explained_share(double before, double after, double floor);
// 1 - (after - floor) / (before - floor), likewise.
double shrink(double before, double after, double floor);

}  // namespace kenaf::gap::diagnose
