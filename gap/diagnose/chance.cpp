#include "gap/diagnose/chance.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "gap/diagnose/model_search.hpp"

namespace kenaf::gap {
namespace {

using Eigen::VectorXd;

double p_value(const std::vector<double>& sorted, double value) {
  const auto reached = sorted.end() - std::ranges::lower_bound(sorted, value);
  return static_cast<double>(reached + 1) / static_cast<double>(sorted.size() + 1);
}

}  // namespace

Chance draw_chance(const EffectCurves& curves, const Coherence& coherence, std::size_t draws, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Chance chance;
  Products products = products_of(curves, curves.gap);
  Whitened noise = curves.gap;
  for (std::size_t i = 0; i < draws; ++i) {
    for (VectorXd& run : noise)
      for (double& value : run) value = normal(random);
    products.gap_gap = squared_length(noise);
    products.shift_gap.setZero();
    for (std::size_t r = 0; r < noise.size(); ++r)
      products.shift_gap.noalias() += curves.shifts[r].transpose() * noise[r];
    double best = 0;
    for (std::size_t c = 0; c < curves.curves.size(); ++c)
      best = std::max(best, products.gap_gap - fit_one(products, curves.curves, c).left);
    chance.improvement.push_back(best);
    chance.energy.push_back(coherence.energy(noise));
  }
  std::ranges::sort(chance.improvement);
  std::ranges::sort(chance.energy);
  return chance;
}

double p_of_improvement(const Chance& chance, double value) {
  return p_value(chance.improvement, value);
}

double p_of_energy(const Chance& chance, double value) {
  const std::vector<double>& sorted = chance.energy;
  const double p = p_value(sorted, value);
  if (p > 2.0 / static_cast<double>(sorted.size())) return p;
  double mean = 0, square = 0;
  for (const double energy : sorted) mean += energy, square += energy * energy;
  mean /= static_cast<double>(sorted.size());
  const double sigma = std::sqrt(std::max(1e-12, square / static_cast<double>(sorted.size()) - mean * mean));
  return std::min(p, 0.5 * std::erfc((value - mean) / sigma / std::sqrt(2.0)));
}

double inflation_from_repeats(const std::vector<FeatureMap>& features, const NoiseFloor& floor,
                              const std::vector<VectorXd>& deviations, double stretch_s) {
  std::vector<double> squares;
  for (std::size_t r = 0; r < features.size(); ++r) {
    if (deviations[r].size() == 0) continue;
    const Coherence one({features[r]}, {{0}}, stretch_s);
    for (const Cell& cell : one.cells({floor.whiteners[r](deviations[r])})) squares.push_back(cell.z * cell.z);
  }
  if (squares.empty()) return 1;
  std::ranges::sort(squares);
  squares.resize(std::max<std::size_t>(1, squares.size() * 95 / 100));
  double sum = 0;
  for (const double square : squares) sum += square;
  // the mean of the lower 95 % of squares of a standard normal is 0.759
  return std::max(1.0, sum / static_cast<double>(squares.size()) / 0.759);
}

}  // namespace kenaf::gap
