#include "gap/diagnose/gap_size.hpp"

#include <algorithm>
#include <cmath>

#include "gap/diagnose/channels.hpp"

namespace kenaf::gap::diagnose {

KindSquares no_squares() {
  return {std::vector<double>(kind_count(), 0), std::vector<double>(kind_count(), 0)};
}

KindSquares& operator+=(KindSquares& sum, const KindSquares& more) {
  for (std::size_t k = 0; k < sum.sum.size(); ++k) sum.sum[k] += more.sum[k], sum.bins[k] += more.bins[k];
  return sum;
}

std::vector<KindSquares> squares_of_runs(const std::vector<StageFeatures>& features, const NoiseFloor& floor,
                                         const std::vector<Eigen::VectorXd>& differences,
                                         const std::vector<std::vector<bool>>& counted) {
  std::vector<KindSquares> of_runs(features.size(), no_squares());
  for (std::size_t r = 0; r < features.size(); ++r) {
    if (features[r].bins.empty() || differences[r].size() == 0) continue;
    const Eigen::VectorXd white = floor.whiteners[r](differences[r]);
    for (std::size_t b = 0; b < features[r].bins.size(); ++b) {
      if (!counted.empty() && !counted[r][b]) continue;
      const std::size_t kind = kind_of(features[r].bins[b].channel);
      const double value = white[static_cast<Eigen::Index>(b)];
      of_runs[r].sum[kind] += value * value;
      ++of_runs[r].bins[kind];
    }
  }
  return of_runs;
}

KindSquares squares_by_kind(const std::vector<StageFeatures>& features, const NoiseFloor& floor,
                            const std::vector<Eigen::VectorXd>& differences,
                            const std::vector<std::vector<bool>>& counted) {
  KindSquares squares = no_squares();
  for (const KindSquares& of_run : squares_of_runs(features, floor, differences, counted)) squares += of_run;
  return squares;
}

KindSquares squares_of_floor(const std::vector<StageFeatures>& features, const NoiseFloor& floor,
                             const Deviations& repeats) {
  KindSquares noise = no_squares();
  for (const StageFeatures& run : features) {
    const Eigen::VectorXd sigma = noise_of_difference(run);
    for (std::size_t b = 0; b < run.bins.size(); ++b) {
      const std::size_t kind = kind_of(run.bins[b].channel);
      noise.sum[kind] += sigma[static_cast<Eigen::Index>(b)] * sigma[static_cast<Eigen::Index>(b)];
      ++noise.bins[kind];
    }
  }
  KindSquares squares = squares_by_kind(features, floor, repeats.of_runs, repeats.shared);
  for (std::size_t k = 0; k < squares.sum.size(); ++k)
    if (squares.sum[k] == 0) squares.sum[k] = noise.sum[k], squares.bins[k] = noise.bins[k];
  return squares;
}

std::vector<double> kind_weights(const KindSquares& before, const KindSquares& floor) {
  std::vector<double> weights(before.sum.size(), 0);
  for (std::size_t k = 0; k < weights.size(); ++k) {
    if (before.bins[k] == 0) continue;
    const double mean = before.sum[k] / before.bins[k];
    // differences below noise are no gap, even if repeats agree better: many such bins would hide a kind with a gap
    const double of_floor = std::max(1.0, floor.bins[k] > 0 ? floor.sum[k] / floor.bins[k] : 1);
    if (mean > of_floor) weights[k] = (mean - of_floor) / (mean * mean);
  }
  if (std::ranges::all_of(weights, [](double weight) { return weight == 0; })) std::ranges::fill(weights, 1.0);
  return weights;
}

double weighted_rms(const KindSquares& squares, const std::vector<double>& kind_weights) {
  double sum = 0, bins = 0;
  for (std::size_t k = 0; k < kind_weights.size(); ++k) {
    sum += kind_weights[k] * squares.sum[k];
    bins += kind_weights[k] * squares.bins[k];
  }
  return bins > 0 ? std::sqrt(sum / bins) : 0;
}

double explained_share(double before, double after, double floor) {
  if (before <= floor) return 0;
  return std::min(1.0, (before * before - after * after) / (before * before - floor * floor));
}

double shrink(double before, double after, double floor) {
  return before > floor ? std::min(1.0, 1 - (after - floor) / (before - floor)) : 0;
}

}  // namespace kenaf::gap::diagnose
