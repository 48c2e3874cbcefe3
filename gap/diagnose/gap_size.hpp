// How large a gap is, and which share of it a model takes away.
//
// A gap is measured in units of noise, and each kind of channels counts by the share of its own gap: a voltage that is
// off by 300 times its noise must not hide track speeds that are off by 20 times theirs. Kind k with n_k bins of mean
// square B_k, of which F_k is noise and spread of repeats, has the weight (B_k - F_k) / B_k^2 for each bin, so that far
// above the noise a bin counts 1 / B_k, and a kind without a gap does not count.
//
// Thread safety: values and pure functions.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "gap/diagnose/noise_floor.hpp"
#include "gap/diagnose/stage_features.hpp"

namespace kenaf::gap::diagnose {

// Of each kind of channels.
struct KindSquares {
  std::vector<double> sum;  // of squares, in units of noise
  std::vector<double> bins;
};
// Of differences of each run, whitened; runs whose weight is 0 left out; `weights` empty: all count once.
KindSquares squares_by_kind(const std::vector<StageFeatures>& features, const NoiseFloor& floor,
                            const std::vector<Eigen::VectorXd>& differences, const std::vector<double>& weights = {});

// The weight of a bin of each kind. `floor`: of repeats or noise. All 1 where no kind has a gap.
std::vector<double> kind_weights(const KindSquares& before, const KindSquares& floor);

// Root of the weighted mean square: in units of noise.
double weighted_rms(const KindSquares& squares, const std::vector<double>& kind_weights);

// Share of the squared gap beyond `floor` that is gone, all rms: at most 1; below 0 where it grew. 0 where there is no
// gap.
double explained_share(double before, double after, double floor);
// 1 - (after - floor) / (before - floor), likewise.
double shrink(double before, double after, double floor);

}  // namespace kenaf::gap::diagnose
