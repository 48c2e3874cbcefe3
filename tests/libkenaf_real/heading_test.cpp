// Heading by a yaw-rate gyro: signs, bias, wrapping.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "libkenaf_real/heading.hpp"

using kenaf::real::Heading;
constexpr double kPi = std::numbers::pi;

namespace {

void run(Heading& heading, double rate_radps, double roll_rad, double pitch_rad, bool standing, double seconds) {
  for (int i = 0; i < static_cast<int>(std::lround(100 * seconds)); ++i)
    heading.update(rate_radps, roll_rad, pitch_rad, standing, 0.01);
}

}  // namespace

TEST_CASE("A turn to the left is positive, and wraps at half a turn") {
  Heading heading;
  run(heading, 0.5, 0, 0, false, 2);
  CHECK(heading.yaw_rad() == Approx(1.0));
  run(heading, 0.5, 0, 0, false, 6);
  CHECK(heading.yaw_rad() == Approx(4.0 - 2 * kPi));
}

TEST_CASE("A bias that was learnt while the robot stood leaves no drift") {
  Heading heading;
  run(heading, 0.01, 0, 0, true, 0.5);
  // 0.2 s settle first, at the bias's full rate; from the first sample after them the mean is the bias; one sample more
  // or less
  CHECK(heading.yaw_rad() == Approx(0.01 * 0.2).margin(1.1e-4));
  CHECK(heading.bias_radps() == Approx(0.01));
  const double before = heading.yaw_rad();
  run(heading, 0.11, 0, 0, false, 10);
  CHECK(heading.yaw_rad() - before == Approx(1.0));
}

TEST_CASE("A robot that is turned by hand while its tracks stand does not teach a bias") {
  Heading heading;
  run(heading, 0.3, 0, 0, true, 2);
  CHECK(heading.bias_radps() == 0);
  CHECK(heading.yaw_rad() == Approx(0.6));
}

TEST_CASE("On a slope of 60 degrees half of the turn about the body's axis is felt as twice the yaw") {
  // yaw rate of z-y-x angles: r cos(roll) / cos(pitch), here r / 0.5
  Heading heading;
  run(heading, 0.1, 0, kPi / 3, false, 1);
  CHECK(heading.yaw_rad() == Approx(0.2));
}

TEST_CASE("A rate beyond a bias's, for most of a stand, is told") {
  Heading heading;
  run(heading, 0.08, 0, 0, true, 0.15);
  CHECK_FALSE(heading.unlearnt_radps());  // it may still rock
  run(heading, 0.08, 0, 0, true, 0.35);
  CHECK(heading.unlearnt_radps() == Approx(0.08));
  CHECK(heading.bias_radps() == 0);

  Heading bumped;
  run(bumped, 0.01, 0, 0, true, 0.5);
  run(bumped, 0.3, 0, 0, true, 0.1);
  CHECK_FALSE(bumped.unlearnt_radps());
}
