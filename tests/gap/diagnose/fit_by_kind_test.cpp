// An effect has to fit in each kind of channels that shows it. Effects here shift the position by 100 and the yaw by
// 100 for each unit of their value (lengths in noise), evenly over all 24 bins of the manoeuvres' means of either.
#include "gap/diagnose/fit_by_kind.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/gap/diagnose/linear_world.hpp"

using namespace kenaf::gap::diagnose;
using kenaf::test::LinearWorld;
using kenaf::test::position;
using kenaf::test::Whole;
using kenaf::test::world;
using kenaf::test::yaw;

namespace {

constexpr double kBinsOfKind = 24, kBorneOut = 9;

// Orthogonal to yaw() in the same channel: the sign changes from bin to bin.
Whole trembling_yaw(double length) {
  Whole whole = yaw(length);
  for (Eigen::Index i = 1; i < whole.size(); i += 2) whole[i] = -whole[i];
  return whole;
}

// Of the effect fitted to this gap with noise alone.
FitByKind fit_of(const Whole& gap) {
  const StageData data = world().data(gap);
  StandingModel standing = world().fitted({position(100) + yaw(100)}, data, {0});
  standing.model = fit_values(data, standing.curves, std::vector<std::size_t>{0}, {}, no_discrepancy());
  return fit_by_kind(data, standing, rest_of(data, standing.model), kBorneOut).front();
}

std::size_t kind(const char* column) {
  return kind_of(LinearWorld::channel_of(column));
}

}  // namespace

TEST_CASE("The cause fits in all kinds of channels, whatever noise does") {
  for (const bool noisy : {false, true}) {
    const FitByKind fit = fit_of(50 * (position(1) + yaw(1)) + (noisy ? 1 : 0) * world().noise(4));
    CHECK(fit.left == 0);
    CHECK(fit.apart == 0);
  }
}

TEST_CASE("What moves the position like an effect and the yaw less wants two values") {
  // 0.5 of the effect in the position, 0.2 in the yaw: the fit takes the middle, 0.35, and misses each by 15 of 35, of
  // which 4 times the noise's squares could be noise with a memory
  const FitByKind fit = fit_of(position(50) + yaw(20));
  CHECK(fit.apart == Approx(0.15));
  CHECK(fit.left == Approx(std::sqrt(15.0 * 15.0 - 4 * kBinsOfKind) / 35));
}

TEST_CASE("The kind of channels that fits worst is told") {
  // the position wants 0.5 and nothing else; in the yaw as much trembles as the effect turns
  const FitByKind fit = fit_of(position(50) + yaw(50) + trembling_yaw(40));
  CHECK(fit.left == Approx(std::sqrt(40.0 * 40.0 - 4 * kBinsOfKind) / 50));
  CHECK(fit.left_in == kind("yaw_rad"));
  CHECK(fit.apart == 0);
}

TEST_CASE("An effect is not blamed for a kind of channels in which it is a small part of the gap") {
  // 50 of 304 in the yaw
  CHECK(fit_of(position(50) + yaw(50) + trembling_yaw(300)).left == 0);
  // nor for the value that it would have there, while the position still wants 0.15 more
  CHECK(fit_of(position(50) + yaw(20) + trembling_yaw(300)).apart == Approx(0.15));
  CHECK(fit_of(position(50) + yaw(20) + trembling_yaw(300)).apart_in == kind("x_m"));
}

TEST_CASE("An effect is not blamed for a kind of channels in which it hardly acts") {
  // of its squared shift 400 / 10400 = 4 % is in the yaw, where as much trembles as it turns; 900 / 10900 = 8 % are
  // more
  const auto fit_with_yaw = [](double length) {
    const StageData data = world().data(position(100) + yaw(length) + trembling_yaw(length));
    StandingModel standing = world().fitted({position(100) + yaw(length)}, data, {0});
    standing.model = fit_values(data, standing.curves, std::vector<std::size_t>{0}, {}, no_discrepancy());
    return fit_by_kind(data, standing, rest_of(data, standing.model), kBorneOut).front();
  };
  CHECK(fit_with_yaw(20).left == 0);
  CHECK(fit_with_yaw(30).left == Approx(std::sqrt(30.0 * 30.0 - 4 * kBinsOfKind) / 30));
}

TEST_CASE("Values of kinds that the data do not bear out are not apart") {
  // each kind wants a value 0.02 from the common one: 2 sigma, that is 4 of deviance for the needed 9
  CHECK(fit_of(position(52) + yaw(48)).apart == 0);
  CHECK(fit_of(position(54) + yaw(46)).apart == Approx(0.04));
}
