// Lengths and turns of measured paths: what was driven, not what was measured.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "tools/draw/noise.hpp"
#include "tools/draw/path_length.hpp"
#include "tools/draw/turns.hpp"

using namespace kenaf;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr int kRateHz = 100;

// Positions of `duration_s` at 100 Hz, each with white noise of `noise_m` in x and y, as a camera or a scan match
// gives.
template <class PositionAt>
std::vector<Eigen::Vector3d> measured(double duration_s, double noise_m, PositionAt position_at) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 1);
  std::vector<Eigen::Vector3d> positions;
  for (int i = 0; i <= duration_s * kRateHz; ++i) {
    Eigen::Vector3d p = position_at(static_cast<double>(i) / kRateHz);
    p.x() += noise_m * noise(random);
    p.y() += noise_m * noise(random);
    positions.push_back(p);
  }
  return positions;
}

template <class HeadingAt>
std::vector<double> headings(double duration_s, double noise_rad, HeadingAt heading_at) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 1);
  std::vector<double> yaw_rad;
  for (int i = 0; i <= duration_s * kRateHz; ++i) {
    const double yaw = heading_at(static_cast<double>(i) / kRateHz) + noise_rad * noise(random);
    yaw_rad.push_back(std::remainder(yaw, 2 * std::numbers::pi));
  }
  return yaw_rad;
}

}  // namespace

TEST_CASE("Noise is told from motion, also in a source slower than the rows") {
  const auto circle = measured(20, 0.005, [](double t) { return Eigen::Vector3d(std::cos(t), std::sin(t), 0); });
  std::vector<double> x, held;
  for (std::size_t i = 0; i < circle.size(); ++i) {
    x.push_back(circle[i].x());
    held.push_back(circle[i - i % 5].x());
  }
  CHECK_THAT(draw::noise_of(x), WithinRel(0.005, 0.1));
  CHECK_THAT(draw::noise_of(held), WithinRel(0.005, 0.15));
  CHECK(draw::noise_of(std::vector<double>{1, 2, 5}) == 0);
}

// Summed step by step, 20 s at 100 Hz with 5 mm of noise would be 2000 steps of about sqrt(pi) * 5 mm: 18 m too long.
TEST_CASE("The length of a path does not grow with noise") {
  for (const double noise_m : {0.0, 0.002, 0.005, 0.03}) {
    INFO("noise of " << noise_m << " m");
    const auto standing = [](double) { return Eigen::Vector3d(1, 2, 0); };
    CHECK_THAT(draw::path_length_m(measured(20, noise_m, standing)), WithinAbs(0, 5 * noise_m));
    const auto straight = [](double t) { return Eigen::Vector3d(0.3 * t, 0.4 * t, 0); };  // 0.5 m/s
    CHECK_THAT(draw::path_length_m(measured(20, noise_m, straight)), WithinRel(10.0, 0.01));
    const auto circle = [](double t) { return Eigen::Vector3d(2 * std::cos(t / 4), 2 * std::sin(t / 4), 0); };
    CHECK_THAT(draw::path_length_m(measured(20, noise_m, circle)), WithinRel(10.0, 0.01));
    const auto there_and_back = [](double t) { return Eigen::Vector3d(5 - std::abs(t / 2 - 5), 0, 0); };
    CHECK_THAT(draw::path_length_m(measured(20, noise_m, there_and_back)), WithinRel(10.0, 0.02));
  }
}

TEST_CASE("The length of a path counts the climb") {
  // 3 m ahead and 4 m up in every metre's proportion: 5 m.
  const auto climb = measured(10, 0.001, [](double t) { return Eigen::Vector3d(0.3 * t, 0, 0.4 * t); });
  CHECK_THAT(draw::path_length_m(climb), WithinRel(5.0, 0.01));
  CHECK(draw::path_length_m({}) == 0);
}

TEST_CASE("Turns count beyond half a turn, to each side for itself") {
  for (const double noise_rad : {0.0, 0.1 * kDegree, 0.5 * kDegree}) {
    INFO("noise of " << noise_rad / kDegree << " degrees");
    const double within = 5 * noise_rad + 1e-9;
    const draw::Turns twice = draw::turns_of(headings(20, noise_rad, [](double t) { return 36 * kDegree * t; }));
    CHECK_THAT(twice.left_rad, WithinAbs(720 * kDegree, within));
    CHECK(twice.right_rad == 0);
    // 90 degrees to the right in 9 s, and 110 back to the left in 11 s.
    const auto there_and_back = [](double t) { return (std::abs(t - 9) - 9) * 10 * kDegree; };
    const draw::Turns both = draw::turns_of(headings(20, noise_rad, there_and_back));
    CHECK_THAT(both.right_rad, WithinAbs(90 * kDegree, within));
    CHECK_THAT(both.left_rad, WithinAbs(110 * kDegree, within));
  }
}

TEST_CASE("Swaying is no turn") {
  const draw::Turns none =
      draw::turns_of(headings(20, 0.05 * kDegree, [](double t) { return 1.2 * kDegree * std::sin(3 * t); }));
  CHECK(none.left_rad == 0);
  CHECK(none.right_rad == 0);
  CHECK(draw::turns_of({}).left_rad == 0);
}
