#include "gap/diagnose/cells.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "gap/diagnose/significance.hpp"

namespace kenaf::gap::diagnose {
namespace {

using Eigen::VectorXd;

// For bins that count and share a channel and a stretch: their sum over the root of their number.
template <class Counts>
std::vector<double> cells_of(const std::vector<Bin>& bins, double span_s, const VectorXd& white, double stretch_s,
                             Counts&& counts) {
  std::map<std::pair<std::size_t, std::size_t>, std::pair<double, double>> sums;
  for (std::size_t b = 0; b < bins.size(); ++b) {
    if (!counts(b)) continue;
    const auto stretch = static_cast<std::size_t>((static_cast<double>(bins[b].span) + 0.5) * span_s / stretch_s);
    auto& [sum, number] = sums[{bins[b].channel, stretch}];
    sum += white[static_cast<Eigen::Index>(b)], ++number;
  }
  std::vector<double> cells;
  for (const auto& [key, sum] : sums) cells.push_back(sum.first / std::sqrt(sum.second));
  return cells;
}

}  // namespace

double CellEnergy::p_of_noise(double inflation) const {
  return p_of_squares(sum / inflation, cells);
}

CellEnergy cell_energy(const StageData& data, const GroupVectors& rest, double stretch_s) {
  CellEnergy energy;
  const std::vector<VectorXd> white = whitened_rest(data, rest, no_discrepancy());
  for (std::size_t g = 0; g < data.groups.size(); ++g) {
    const StageGroup& group = data.groups[g];
    const double span_s = group.t_s.front() / (static_cast<double>(group.bins.front().span) + 0.5);
    const auto is_used = [&](std::size_t b) { return group.count[static_cast<Eigen::Index>(b)] > 0; };
    for (const double z : cells_of(group.bins, span_s, white[g], stretch_s, is_used)) {
      energy.sum += z * z;
      ++energy.cells;
    }
  }
  return energy;
}

double inflation_from_repeats(const std::vector<StageFeatures>& features, const NoiseFloor& floor,
                              const Deviations& repeats, double stretch_s) {
  std::vector<double> squares;
  for (std::size_t r = 0; r < features.size(); ++r) {
    if (repeats.of_runs[r].size() == 0) continue;
    const VectorXd white = floor.whiteners[r](repeats.of_runs[r]);
    const auto is_shared = [&](std::size_t b) { return repeats.shared[r][b]; };
    for (const double z : cells_of(features[r].bins, features[r].span_s, white, stretch_s, is_shared))
      squares.push_back(z * z);
  }
  if (squares.empty()) return 1;
  // the largest are events; the mean of the smallest 95 % of squared standard normals is 0.759
  std::ranges::sort(squares);
  squares.resize(std::max<std::size_t>(1, squares.size() * 95 / 100));
  double sum = 0;
  for (const double square : squares) sum += square;
  return std::max(1.0, sum / static_cast<double>(squares.size()) / 0.759);
}

}  // namespace kenaf::gap::diagnose
