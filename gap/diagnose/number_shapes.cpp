#include "gap/diagnose/number_shapes.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace kenaf::gap::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

// Chosen: more directions add a few per cent of the numbers' shifts.
constexpr Index kMostDirections = 12;
// Length in noise, for relative errors of 1, below which a direction is invisible at errors of a few per cent.
constexpr double kVisibleDirection = 3;

const CurvePoint* nearest_to_present(const EffectCurve& curve, double present) {
  const CurvePoint* nearest = nullptr;
  for (const CurvePoint& point : curve.points)
    if (point.column >= 0 &&
        (nearest == nullptr || std::abs(point.value - present) < std::abs(nearest->value - present)))
      nearest = &point;
  return nearest;
}

// `settings` with an ordinary error of one number, and the size of that error.
struct SlightlyOff {
  Settings settings;
  double by;
};
SlightlyOff slightly_off(const candidates::Candidate& candidate, std::size_t number, Settings settings) {
  const double step = ordinarily_off(candidate) - candidate.present;
  const auto set = std::ranges::find(settings, number, &Setting::candidate);
  if (set == settings.end()) {
    settings.push_back({number, candidate.present + step});
    return {std::move(settings), step};
  }
  const bool fits = candidate.min <= set->value + step && set->value + step <= candidate.max;
  set->value += fits ? step : -step;
  return {std::move(settings), fits ? step : -step};
}

// For each group, the shift of each number with `settings` applied, for a relative error of 1.
std::vector<MatrixXd> shifts_beside(const StageData& data, std::span<const candidates::Candidate> candidates,
                                    std::span<const std::size_t> numbers, const Settings& settings,
                                    const Simulate& simulate) {
  std::vector<Settings> asked{settings};
  std::vector<double> scales;
  for (const std::size_t c : numbers) {
    SlightlyOff moved = slightly_off(candidates[c], c, settings);
    asked.push_back(std::move(moved.settings));
    scales.push_back(candidates[c].whole / moved.by);
  }
  const std::vector<GroupVectors> simulated = simulate(asked, Fidelity::coarse);
  std::vector<MatrixXd> shifts;
  for (std::size_t g = 0; g < data.groups.size(); ++g) {
    shifts.emplace_back(std::ssize(data.groups[g].bins), std::ssize(numbers));
    for (std::size_t n = 0; n < numbers.size(); ++n)
      shifts.back().col(static_cast<Index>(n)) = scales[n] * (simulated[n + 1][g] - simulated[0][g]);
  }
  return shifts;
}

bool share_a_key(const candidates::Candidate& a, const candidates::Candidate& b) {
  return std::ranges::any_of(a.keys, [&](const std::string& key) { return std::ranges::count(b.keys, key) > 0; });
}

// The principal directions of the shifts of all numbers. `shifts`: for each group, one column per number, for a
// relative error of 1.
std::vector<MatrixXd> principal_directions(const StageData& data, std::vector<MatrixXd> shifts) {
  const Index numbers = shifts.empty() ? 0 : shifts.front().cols();
  if (numbers == 0) return shifts;
  MatrixXd products = MatrixXd::Zero(numbers, numbers);
  for (std::size_t g = 0; g < shifts.size(); ++g) {
    const MatrixXd white = data.groups[g].variance.cwiseSqrt().cwiseInverse().asDiagonal() * shifts[g];
    products.noalias() += white.transpose() * white;
  }

  // eigenvectors of the covariance of all shifts, in units of noise
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(products);
  Index count = 0;
  while (count < std::min(kMostDirections, numbers) &&
         eigen.eigenvalues()[numbers - 1 - count] > kVisibleDirection * kVisibleDirection)
    ++count;
  const MatrixXd directions = eigen.eigenvectors().rightCols(count).rowwise().reverse();
  for (MatrixXd& group : shifts) group = group * directions;
  return shifts;
}

}  // namespace

std::vector<std::size_t> numbers_but(std::span<const candidates::Candidate> candidates,
                                     std::span<const std::size_t> possible, std::span<const std::size_t> valued) {
  const auto has_value = [&](std::size_t c) {
    return std::ranges::any_of(valued, [&](std::size_t other) {
      return other == c || candidates::is_part_of(candidates[c], candidates[other]) ||
             (candidates[other].is_relative && share_a_key(candidates[c], candidates[other]));
    });
  };
  std::vector<std::size_t> numbers;
  for (const std::size_t c : possible)
    if (candidates[c].whole > 0 && !has_value(c)) numbers.push_back(c);
  return numbers;
}

std::vector<MatrixXd> number_shapes(const StageData& data, const EffectCurves& curves,
                                    std::span<const std::size_t> possible) {
  std::vector<int> columns;
  std::vector<double> scales;
  for (const std::size_t c : possible) {
    const candidates::Candidate& candidate = curves.candidates[c];
    if (candidate.whole == 0) continue;
    const CurvePoint* point = nearest_to_present(curves.curves[c], candidate.present);
    if (point == nullptr) continue;
    columns.push_back(point->column);
    scales.push_back(candidate.whole / (point->value - candidate.present));
  }
  const Eigen::Map<const Eigen::VectorXd> scale(scales.data(), std::ssize(scales));
  std::vector<MatrixXd> shifts;
  for (std::size_t g = 0; g < data.groups.size(); ++g)
    shifts.emplace_back(curves.shifts[g](Eigen::all, columns) * scale.asDiagonal());
  return principal_directions(data, std::move(shifts));
}

std::vector<MatrixXd> number_shapes_around(const StageData& data, std::span<const candidates::Candidate> candidates,
                                           std::span<const std::size_t> possible, const Settings& settings,
                                           std::span<const std::size_t> valued, const Simulate& simulate) {
  const std::vector<std::size_t> which = numbers_but(candidates, possible, valued);
  return principal_directions(data, shifts_beside(data, candidates, which, settings, simulate));
}

std::vector<MatrixXd> number_shapes_of_change(const StageData& data, std::span<const candidates::Candidate> candidates,
                                              std::span<const std::size_t> possible, const Settings& settings,
                                              std::span<const std::size_t> valued, const Simulate& simulate) {
  const std::vector<std::size_t> which = numbers_but(candidates, possible, valued);
  std::vector<MatrixXd> shifts = shifts_beside(data, candidates, which, settings, simulate);
  const std::vector<MatrixXd> before = shifts_beside(data, candidates, which, {}, simulate);
  for (std::size_t g = 0; g < shifts.size(); ++g) shifts[g] -= before[g];
  return principal_directions(data, std::move(shifts));
}

}  // namespace kenaf::gap::diagnose
