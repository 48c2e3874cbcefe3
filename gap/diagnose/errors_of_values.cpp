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

// Chosen: this many give a standard error to a sixth of itself. Half as many ask for 1.4 times the distance from no
// effect for the same certainty.
constexpr std::size_t kRobots = 16;
// Quantiles of Student's t with kRobots degrees of freedom in place of a normal distribution's 1.96 (kHalfWidth) and 4.
constexpr double kHalfWidthOfRobots = 2.120, kFourSigmaOfRobots = 5.364;

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

// For each group, in columns: what wrong numbers do to the robot with the model's effects (first half of the columns),
// and to the one without them. Against a baseline the former is the change of that difference, the latter nothing, as
// it is if not asked for.
std::vector<MatrixXd> differences_of_robots(const StageData& data, const StandingModel& standing,
                                            const NumbersOff& numbers, const Simulate& simulate, std::uint64_t seed) {
  const Settings model = settings_of(standing.model.places);
  Random random(seed);
  std::vector<Settings> with_effects{model}, without{{}};
  for (std::size_t i = 0; i < kRobots; ++i) {
    Settings off = drawn(standing.curves.candidates, numbers, random);
    with_effects.push_back(with(model, off));
    without.push_back(std::move(off));
  }
  const std::vector<GroupVectors> shifts = simulate(with_effects, Fidelity::coarse);
  std::vector<GroupVectors> shifts_without;
  if (numbers.also_before || numbers.also_without) shifts_without = simulate(without, Fidelity::coarse);
  std::vector<MatrixXd> differences;
  for (std::size_t g = 0; g < data.groups.size(); ++g) {
    MatrixXd& of_group = differences.emplace_back(MatrixXd::Zero(std::ssize(data.groups[g].bins), 2 * kRobots));
    for (std::size_t i = 0; i < kRobots; ++i) {
      auto changed = of_group.col(static_cast<Index>(i)), unchanged = of_group.col(static_cast<Index>(kRobots + i));
      changed = shifts[i + 1][g] - shifts[0][g];
      if (shifts_without.empty()) continue;
      unchanged = shifts_without[i + 1][g] - shifts_without[0][g];
      if (!numbers.also_before) continue;
      changed -= unchanged;
      unchanged.setZero();
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

double ErrorOfValue::half_width() const {
  return std::hypot(kHalfWidth * of_noise, kHalfWidthOfRobots * of_numbers);
}

double ErrorOfValue::four_sigma() const {
  return std::hypot(4 * of_noise, kFourSigmaOfRobots * std::max(of_numbers, of_numbers_without));
}

std::vector<ErrorOfValue> errors_of_values(const StageData& data, const StandingModel& standing,
                                           const NumbersOff& numbers, const Simulate& simulate, std::uint64_t seed) {
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
  const MatrixXd of_robots = covariance * products.topRightCorner(values, 2 * kRobots);

  // the covariance includes the numbers' linear shifts, which the robots replace here
  const VectorXd of_noise = covariance.diagonal() - of_shapes.rowwise().squaredNorm();
  const auto rms = [&](const auto& of_some) { return std::sqrt(of_some.squaredNorm() / kRobots); };
  std::vector<ErrorOfValue> errors;
  for (Index v = 0; v < values; ++v)
    errors.push_back({std::sqrt(std::max(0.0, of_noise[v])), rms(of_robots.row(v).head(kRobots)),
                      rms(of_robots.row(v).tail(kRobots))});
  return errors;
}

Interval widened(Interval interval, double half_width, const candidates::Candidate& candidate) {
  interval.from = std::min(interval.from, std::max(candidate.min, interval.value - half_width));
  interval.to = std::max(interval.to, std::min(candidate.max, interval.value + half_width));
  return interval;
}

}  // namespace kenaf::gap::diagnose
