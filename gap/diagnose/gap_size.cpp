#include "gap/diagnose/gap_size.hpp"

#include <algorithm>
#include <cmath>

#include "gap/diagnose/channels.hpp"

namespace kenaf::gap::diagnose {

KindSquares squares_by_kind(const std::vector<StageFeatures>& features, const NoiseFloor& floor,
                            const std::vector<Eigen::VectorXd>& differences, const std::vector<double>& weights) {
  KindSquares squares{std::vector<double>(kind_count(), 0), std::vector<double>(kind_count(), 0)};
  for (std::size_t r = 0; r < features.size(); ++r) {
    const double weight = weights.empty() ? 1 : weights[r];
    if (weight == 0 || features[r].bins.empty() || differences[r].size() == 0) continue;
    const Eigen::VectorXd white = floor.whiteners[r](differences[r]);
    for (std::size_t b = 0; b < features[r].bins.size(); ++b) {
      const std::size_t kind = kind_of(features[r].bins[b].channel);
      const double value = white[static_cast<Eigen::Index>(b)];
      squares.sum[kind] += weight * value * value;
      squares.bins[kind] += weight;
    }
  }
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
