#include "gap/compare/dp_matching.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace kenaf::gap::compare {

namespace {

enum class Step : std::uint8_t { both, real, sim };  // the index that grew

// The simulated frames with which one real frame is compared.
struct Row {
  std::size_t first, last;
  bool has(std::size_t sim) const { return first <= sim && sim <= last; }
  std::size_t size() const { return last - first + 1; }
};

class Window {
 public:
  Window(std::size_t real_count, std::size_t sim_count, std::optional<std::size_t> band)
      : last_sim_(sim_count - 1),
        slope_(real_count > 1 ? static_cast<double>(sim_count - 1) / static_cast<double>(real_count - 1) : 0),
        // Rows shift by the slope from one to the next and must touch; a single real frame needs all simulated ones.
        half_width_(real_count > 1 && band ? std::max({static_cast<double>(*band), std::ceil(slope_), 1.0})
                                           : static_cast<double>(sim_count)) {}

  Row row(std::size_t real) const {
    const double centre = slope_ * static_cast<double>(real);
    const auto first = static_cast<std::size_t>(std::max(0.0, std::ceil(centre - half_width_)));
    return {std::min(first, last_sim_), std::min(last_sim_, static_cast<std::size_t>(centre + half_width_))};
  }

 private:
  std::size_t last_sim_;
  double slope_, half_width_;
};

}  // namespace

std::size_t weighed_pairs(std::size_t real_count, std::size_t sim_count, std::optional<std::size_t> band) {
  if (!band) return real_count * sim_count;
  const Window window(real_count, sim_count, band);
  std::size_t count = 0;
  for (std::size_t i = 0; i < real_count; ++i) count += window.row(i).size();
  return count;
}

Matching match_paths(std::span<const Eigen::Vector2d> real, std::span<const Eigen::Vector2d> sim,
                     std::optional<std::size_t> band) {
  const std::size_t cells = weighed_pairs(real.size(), sim.size(), band);
  if (cells > kMostWeighedPairs) throw std::length_error("too many pairs of frames to match");
  constexpr double kNoWay = std::numeric_limits<double>::infinity();
  const Window window(real.size(), sim.size(), band);

  // The least cost of reaching pair (i, j) with distance d is
  //   g(i, j) = min(g(i-1, j-1) + 2 d, g(i-1, j) + d, g(i, j-1) + d),  g(0, 0) = 2 d.
  // It needs only the row before; the steps taken are kept for the way back.
  std::vector<Step> steps(cells);
  std::vector<std::size_t> row_begins(real.size());
  std::vector<double> before(sim.size(), kNoWay), here(sim.size(), kNoWay);
  std::size_t row_begin = 0;
  for (std::size_t i = 0; i < real.size(); ++i) {
    const Row row = window.row(i);
    const Row row_before = i > 0 ? window.row(i - 1) : Row{1, 0};
    for (std::size_t j = row.first; j <= row.last; ++j) {
      const double distance = (real[i] - sim[j]).norm();
      const double by_both = j > 0 && row_before.has(j - 1) ? before[j - 1] + 2 * distance : kNoWay;
      const double by_real = row_before.has(j) ? before[j] + distance : kNoWay;
      const double by_sim = j > row.first ? here[j - 1] + distance : kNoWay;
      const double best = std::min({by_both, by_real, by_sim});
      here[j] = i == 0 && j == 0 ? 2 * distance : best;
      steps[row_begin + j - row.first] = by_both == best ? Step::both : by_real == best ? Step::real : Step::sim;
    }
    row_begins[i] = row_begin;
    row_begin += row.size();
    std::swap(before, here);
  }

  // From the last pair the steps lead back to the first.
  Matching matching;
  matching.cost_m = before[sim.size() - 1] / static_cast<double>(real.size() + sim.size());
  std::size_t i = real.size() - 1, j = sim.size() - 1;
  matching.pairs.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j)});
  while (i > 0 || j > 0) {
    const Step step = steps[row_begins[i] + j - window.row(i).first];
    if (step != Step::sim) --i;
    if (step != Step::real) --j;
    matching.pairs.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j)});
  }
  std::ranges::reverse(matching.pairs);
  return matching;
}

}  // namespace kenaf::gap::compare
