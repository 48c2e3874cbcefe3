#include "gap/diagnose/errors_of_values.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "gap/random_numbers.hpp"

namespace kenaf::gap::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Chosen: this many give a standard error to a quarter of itself.
constexpr int kRobots = 8;
constexpr double kOfRobots = 2.306;  // like kHalfWidth, for Student's t with kRobots degrees of freedom

// Errors of the numbers alone; uniform, like a tolerance.
Settings drawn(std::span<const candidates::Candidate> candidates, const NumbersOff& numbers, Random& random) {
  const double most = std::numbers::sqrt3 * numbers.sigma;
  Settings settings;
  for (const std::size_t c : numbers.candidates) {
    const candidates::Candidate& candidate = candidates[c];
    const double value = candidate.present + uniform(random, -most, most) * candidate.whole;
    settings.push_back({c, std::clamp(value, candidate.min, candidate.max)});
  }
  return settings;
}

Settings with(Settings settings, const Settings& more) {
  settings.insert(settings.end(), more.begin(), more.end());
  return settings;
}

// For each group, in columns: the difference of each drawn robot from the model's.
std::vector<MatrixXd> differences_of_robots(const StageData& data, const StandingModel& standing,
                                            const NumbersOff& numbers, const Simulate& simulate, std::uint64_t seed) {
  const Settings model = settings_of(standing.model.places);
  Random random(seed);
  std::vector<Settings> asked{model}, before{{}};
  for (int i = 0; i < kRobots; ++i) {
    Settings off = drawn(standing.curves.candidates, numbers, random);
    asked.push_back(with(model, off));
    before.push_back(std::move(off));
  }
  const std::vector<GroupVectors> shifts = simulate(asked, Fidelity::fine);
  std::vector<GroupVectors> shifts_before;
  if (numbers.also_before) shifts_before = simulate(before, Fidelity::fine);
  std::vector<MatrixXd> differences;
  for (std::size_t g = 0; g < data.groups.size(); ++g) {
    differences.emplace_back(std::ssize(data.groups[g].bins), kRobots);
    for (std::size_t i = 0; i < kRobots; ++i) {
      VectorXd difference = shifts[i + 1][g] - shifts[0][g];
      if (numbers.also_before) difference -= shifts_before[i + 1][g] - shifts_before[0][g];
      differences.back().col(static_cast<Index>(i)) = difference;
    }
  }
  return differences;
}

// Concatenates the columns of each group.
std::vector<MatrixXd> concatenated(std::vector<MatrixXd> left, const std::vector<MatrixXd>& right) {
  for (std::size_t g = 0; g < left.size(); ++g) {
    const Index count = left[g].cols();
    left[g].conservativeResize(Eigen::NoChange, count + right[g].cols());
    left[g].rightCols(right[g].cols()) = right[g];
  }
  return left;
}

}  // namespace

VectorXd errors_of_values(const StageData& data, const StandingModel& standing, const NumbersOff& numbers,
                          const Simulate& simulate, std::uint64_t seed) {
  const Discrepancies& discrepancies = standing.model.likelihood.discrepancies;
  std::vector<MatrixXd> number_shapes;
  for (const StageGroup& group : data.groups) number_shapes.push_back(discrepancies.numbers_off * group.number_shapes);

  // generalised least squares is linear: the error of the values from each difference
  const std::vector<MatrixXd> slope = slopes(data, standing);
  const Index values = slope.front().cols(), shapes = number_shapes.front().cols();
  const MatrixXd products = inner_products(
      whiteners_of(data, discrepancies),
      concatenated(concatenated(slope, number_shapes), differences_of_robots(data, standing, numbers, simulate, seed)));
  const MatrixXd covariance = products.topLeftCorner(values, values).completeOrthogonalDecomposition().pseudoInverse();
  const MatrixXd of_shapes = covariance * products.block(0, values, values, shapes);
  const MatrixXd of_robots = covariance * products.topRightCorner(values, kRobots);

  // the covariance includes the numbers' linear shifts, which the robots replace here
  constexpr double kFew = kOfRobots / kHalfWidth;
  const VectorXd of_noise = covariance.diagonal() - of_shapes.rowwise().squaredNorm();
  const VectorXd of_numbers = kFew * kFew * of_robots.rowwise().squaredNorm() / kRobots;
  return (of_noise.cwiseMax(0) + of_numbers).cwiseSqrt();
}

Interval widened(Interval interval, double standard_error, const candidates::Candidate& candidate) {
  const double half = kHalfWidth * standard_error;
  interval.from = std::min(interval.from, std::max(candidate.min, interval.value - half));
  interval.to = std::max(interval.to, std::min(candidate.max, interval.value + half));
  return interval;
}

}  // namespace kenaf::gap::diagnose
