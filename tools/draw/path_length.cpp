#include "tools/draw/path_length.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "tools/draw/noise.hpp"

namespace kenaf::draw {

namespace {

constexpr double kStepInNoises = 15;  // chosen: noise across the step adds less than 1 % to it

Eigen::Vector3d noise_of_positions_m(std::span<const Eigen::Vector3d> positions) {
  // A repeated position is left out as a whole: one coordinate alone may stay as it is for other reasons.
  std::vector<Eigen::Vector3d> p;
  std::ranges::unique_copy(positions, std::back_inserter(p));
  Eigen::Vector3d noise_m;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> coordinates;
    for (const Eigen::Vector3d& position : p) coordinates.push_back(position[axis]);
    noise_m[axis] = noise_of(coordinates);
  }
  return noise_m;
}

}  // namespace

double path_length_m(std::span<const Eigen::Vector3d> positions) {
  if (positions.empty()) return 0;
  const Eigen::Vector3d noise = noise_of_positions_m(positions);
  const double least_m = kStepInNoises * noise.maxCoeff();
  // Two positions with noise lie 2 s^2 apart in each coordinate. What lies along the step moves its end, from which the
  // next one begins, so it adds nothing; what lies across does.
  const double across_m2 = 2 * noise.squaredNorm() - 2 * std::pow(noise.maxCoeff(), 2);
  const auto length_of = [across_m2](const Eigen::Vector3d& step) {
    return std::sqrt(std::max(0.0, step.squaredNorm() - across_m2));
  };

  double length_m = 0;
  Eigen::Vector3d from = positions.front();
  for (const Eigen::Vector3d& to : positions) {
    if ((to - from).norm() < least_m || to == from) continue;
    length_m += length_of(to - from);
    from = to;
  }
  // The rest is shorter than a step and may be all noise, along it too.
  const Eigen::Vector3d rest = positions.back() - from;
  return length_m + std::sqrt(std::max(0.0, rest.squaredNorm() - 2 * noise.squaredNorm()));
}

}  // namespace kenaf::draw
