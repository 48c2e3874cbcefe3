// DP matching of two paths in the vertical plane (dynamic programming, also called dynamic time warping): assigns the
// frames of both paths to each other, in order, with the least total distance.
//
// Symmetric form with steps (1, 0), (0, 1) and (1, 1), the last with weight 2, and no slope limit: H. Sakoe, S. Chiba,
// "Dynamic programming algorithm optimization for spoken word recognition", IEEE Trans. ASSP 26(1), 1978, P = 0. With
// that weight all warping paths from corner to corner have the total weight n + m, so that none is preferred for being
// short, and exchanging the two runs gives the same cost.
//
// Thread safety: pure functions.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace kenaf::gap::compare {

struct FramePair {
  std::uint32_t real, sim;  // indices of frames, from 0
  bool operator==(const FramePair&) const = default;
};

struct Matching {
  // From (0, 0) to (n - 1, m - 1). Every frame of both paths is in at least one pair; neither index ever decreases.
  std::vector<FramePair> pairs;
  double cost_m = 0;  // weighted mean distance: sum(weight * distance) / (n + m)
};

// Largest number of pairs of frames that are weighed; each takes a byte of memory.
inline constexpr std::size_t kMostWeighedPairs = std::size_t{1} << 28;

// Returns the number of pairs that match_paths() weighs.
std::size_t weighed_pairs(std::size_t real_count, std::size_t sim_count, std::optional<std::size_t> band);

// Points are (x, z) in m, finite; both paths have at least one. `band` (Sakoe and Chiba's window) is the largest
// distance of a pair from the straight line between the corners, in simulated frames; a band too narrow for any warping
// path is widened to the least that has one. Of paths with equal cost, returns the one with the diagonal steps nearest
// the end. Throws std::length_error if more than kMostWeighedPairs would have to be weighed.
Matching match_paths(std::span<const Eigen::Vector2d> real, std::span<const Eigen::Vector2d> sim,
                     std::optional<std::size_t> band = std::nullopt);

}  // namespace kenaf::gap::compare
