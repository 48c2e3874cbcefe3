// DP matching of two paths in the vertical plane (dynamic programming; also called dynamic time warping): which frame
// of one belongs to which frame of the other, in order, so that they lie as near each other as can be.
//
// Symmetric form with steps (1, 0), (0, 1) and (1, 1), the last with weight 2, and no slope limit: H. Sakoe, S. Chiba,
// "Dynamic programming algorithm optimization for spoken word recognition", IEEE Trans. ASSP 26(1), 1978, P = 0. With
// that weight every path from corner to corner weighs n + m in all, so that no step is cheaper than another, and
// exchanging the two runs gives the same cost.
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
  // From (0, 0) to (n - 1, m - 1). Every frame of both paths is in at least one pair; neither index ever falls.
  std::vector<FramePair> pairs;
  double cost_m = 0;  // weighted mean distance: the sum of weight * distance, over n + m
};

// How many pairs of frames are weighed at most: a byte of memory each.
inline constexpr std::size_t kMostWeighedPairs = std::size_t{1} << 28;

// How many pairs match_paths() weighs.
std::size_t weighed_pairs(std::size_t real_count, std::size_t sim_count, std::optional<std::size_t> band);

// Points are (x, z) in m, finite; both paths have at least one. `band` (Sakoe and Chiba's window): how many simulated
// frames a pair may be away from the straight line between the corners; where this is too narrow for a way to exist, it
// is widened to the least that has one. Of ways that cost the same, the one with the diagonal steps nearest the end.
// Throws std::length_error where more than kMostWeighedPairs would have to be weighed.
Matching match_paths(std::span<const Eigen::Vector2d> real, std::span<const Eigen::Vector2d> sim,
                     std::optional<std::size_t> band = std::nullopt);

}  // namespace kenaf::gap::compare
