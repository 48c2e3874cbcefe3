// DP matching leads from corner to corner by steps (1, 0), (0, 1) or (1, 1), and small cases prove it optimal by trying
// every way. Equal runs match on the diagonal at cost 0, exchanging the runs keeps the cost, waiting costs nothing (a
// delayed start, a run half as fast), and a constant offset across the path is the mean error. A band keeps pairs near
// the even course, and never leaves none.
#include "gap/compare/dp_matching.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <stdexcept>

using namespace kenaf::gap;
using namespace kenaf::gap::compare;
using Eigen::Vector2d;
using Path = std::vector<Vector2d>;

namespace {

// A wavy climb without two equal points, `count` frames at `step` of its length each.
Path climb(std::size_t count, double step) {
  Path path;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = step * static_cast<double>(i);
    path.emplace_back(x, 0.1 * std::sin(5 * x));
  }
  return path;
}

Path random_path(std::mt19937& random, std::size_t count) {
  std::uniform_real_distribution<double> place(-1, 1);
  Path path;
  for (std::size_t i = 0; i < count; ++i) path.emplace_back(place(random), place(random));
  return path;
}

// The least weighted sum from (0, 0) to (i, j), by trying every way.
double least_of_all_ways(const Path& a, const Path& b, std::size_t i, std::size_t j) {
  const double distance = (a[i] - b[j]).norm();
  if (i == 0 && j == 0) return 2 * distance;
  double least = 1e300;
  if (i > 0) least = std::min(least, least_of_all_ways(a, b, i - 1, j) + distance);
  if (j > 0) least = std::min(least, least_of_all_ways(a, b, i, j - 1) + distance);
  if (i > 0 && j > 0) least = std::min(least, least_of_all_ways(a, b, i - 1, j - 1) + 2 * distance);
  return least;
}

// What the pairs of a matching cost, added up from the pairs themselves.
double cost_of_pairs(const Path& a, const Path& b, const std::vector<FramePair>& pairs) {
  double sum = 2 * (a[0] - b[0]).norm();
  for (std::size_t k = 1; k < pairs.size(); ++k) {
    const auto steps = pairs[k].real - pairs[k - 1].real + pairs[k].sim - pairs[k - 1].sim;
    sum += steps * (a[pairs[k].real] - b[pairs[k].sim]).norm();
  }
  return sum / static_cast<double>(a.size() + b.size());
}

bool is_a_way(const std::vector<FramePair>& pairs, std::size_t real_count, std::size_t sim_count) {
  if (pairs.front() != FramePair{0, 0}) return false;
  if (pairs.back().real != real_count - 1 || pairs.back().sim != sim_count - 1) return false;
  for (std::size_t k = 1; k < pairs.size(); ++k) {
    const auto by_real = pairs[k].real - pairs[k - 1].real, by_sim = pairs[k].sim - pairs[k - 1].sim;
    if (by_real > 1 || by_sim > 1 || by_real + by_sim == 0) return false;
  }
  return true;
}

}  // namespace

TEST_CASE("The matching is the cheapest of all ways, on random runs of 1 to 6 frames") {
  std::mt19937 random(1);
  for (std::size_t n = 1; n <= 6; ++n) {
    for (std::size_t m = 1; m <= 6; ++m) {
      const Path a = random_path(random, n), b = random_path(random, m);
      const Matching matching = match_paths(a, b);
      CHECK(is_a_way(matching.pairs, n, m));
      const double least = least_of_all_ways(a, b, n - 1, m - 1) / static_cast<double>(n + m);
      CHECK(matching.cost_m == Approx(least).epsilon(1e-12));
      CHECK(cost_of_pairs(a, b, matching.pairs) == Approx(least).epsilon(1e-12));
    }
  }
}

TEST_CASE("Equal runs match frame by frame and cost nothing, standing or moving") {
  for (const Path& path : {climb(50, 0.02), Path(20, Vector2d(0.3, 0.1))}) {
    const Matching matching = match_paths(path, path);
    CHECK(matching.cost_m == 0);
    REQUIRE(matching.pairs.size() == path.size());
    CHECK(std::ranges::all_of(matching.pairs, [](const FramePair& pair) { return pair.real == pair.sim; }));
  }
}

TEST_CASE("Exchanging the runs keeps the cost") {
  std::mt19937 random(2);
  const Path a = random_path(random, 40), b = random_path(random, 55);
  CHECK(match_paths(a, b).cost_m == Approx(match_paths(b, a).cost_m).epsilon(1e-12));
}

TEST_CASE("A run that starts 7 frames late costs nothing, and its frames match 7 later") {
  const Path real = climb(40, 0.02);
  Path sim(7, real.front());
  sim.insert(sim.end(), real.begin(), real.end());
  const Matching matching = match_paths(real, sim);
  CHECK(matching.cost_m == 0);
  for (const FramePair& pair : matching.pairs) {
    if (pair.real > 0) CHECK(pair.sim == pair.real + 7);
  }
}

TEST_CASE("A run half as fast along the same path matches with a slope of 2") {
  const Path real = climb(30, 0.02), sim = climb(59, 0.01);
  const Matching matching = match_paths(real, sim);
  // Every other simulated frame lies on a real one; those between are at most half a step from it. A step is at most
  // 0.02 sqrt(1 + 0.5^2) = 22.4 mm, and a third of the weight is theirs at most.
  CHECK(matching.cost_m < 0.0112 / 2);
  for (const FramePair& pair : matching.pairs) {
    CHECK(std::abs(static_cast<double>(pair.sim) - 2.0 * pair.real) <= 1);
  }
}

TEST_CASE("A run 30 mm above the other has a mean error of 30 mm") {
  Path real, sim;
  for (int i = 0; i < 40; ++i) {
    real.emplace_back(0.01 * i, 0.1);
    sim.emplace_back(0.01 * i, 0.13);
  }
  const Matching matching = match_paths(real, sim);
  CHECK(matching.cost_m == Approx(0.03).epsilon(1e-12));
  CHECK(matching.pairs.size() == 40);
}

TEST_CASE("A wide band changes nothing, and one too narrow is widened") {
  std::mt19937 random(3);
  const Path a = random_path(random, 60), b = random_path(random, 45);
  const Matching all = match_paths(a, b);
  CHECK(match_paths(a, b, 60).pairs == all.pairs);
  for (const std::size_t band : {0u, 1u, 3u, 10u}) {
    const Matching matching = match_paths(a, b, band);
    CHECK(is_a_way(matching.pairs, a.size(), b.size()));
    CHECK(matching.cost_m >= all.cost_m);
    const double width = std::max<double>(1, static_cast<double>(band));
    for (const FramePair& pair : matching.pairs) CHECK(std::abs(pair.sim - pair.real * 44.0 / 59.0) <= width);
  }
  // 30 simulated frames for each real one: a band of 0 is widened to reach from row to row
  CHECK(is_a_way(match_paths(random_path(random, 3), random_path(random, 61), 0).pairs, 3, 61));
  CHECK(is_a_way(match_paths(random_path(random, 61), random_path(random, 3), 0).pairs, 61, 3));
  CHECK(is_a_way(match_paths(random_path(random, 1), random_path(random, 9), 0).pairs, 1, 9));
}

TEST_CASE("A band makes runs matchable that are too long without one") {
  const std::size_t frames = 20000;  // 4e8 pairs, 20001 * 21 in the band
  const Path path = climb(frames, 1e-4);
  CHECK(weighed_pairs(frames, frames, std::nullopt) == frames * frames);
  CHECK(weighed_pairs(frames, frames, 10) == frames * 21 - 2 * 55);
  CHECK_THROWS_AS(match_paths(path, path), std::length_error);
  CHECK(match_paths(path, path, 10).cost_m == 0);
}
