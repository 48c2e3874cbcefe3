// Angles that wrap, and joints with limits.
#include "robot/angles.hpp"

#include <catch2/catch.hpp>
#include <numbers>
#include <vector>

using namespace kenaf::robot;
using std::numbers::pi;

TEST_CASE("An angle is wrapped to more than -pi and at most pi") {
  CHECK(wrap_angle(0) == 0);
  CHECK(wrap_angle(pi) == pi);
  CHECK(wrap_angle(-pi) == pi);
  CHECK(wrap_angle(3 * pi) == Approx(pi));
  CHECK(wrap_angle(-0.5 - 4 * pi) == Approx(-0.5));
  CHECK(wrap_angle(3.2) == Approx(3.2 - 2 * pi));
}

TEST_CASE("Unwrapped angles go on beyond half a turn, to both sides") {
  std::vector<double> angles{3, -3, 0, 3, -3, 3};
  unwrap(angles);
  const double expected[] = {3, -3 + 2 * pi, 2 * pi, 3 + 2 * pi, -3 + 4 * pi, 3 + 2 * pi};
  for (std::size_t i = 0; i < angles.size(); ++i) CHECK(angles[i] == Approx(expected[i]));
  std::vector<double> none;
  unwrap(none);
  CHECK(none.empty());
}

TEST_CASE("A joint with limits turns to the same direction within them, the nearest one, or to the nearer limit") {
  CHECK(reachable_angle(0.5, 0, -2, 2) == Approx(0.5));
  CHECK(reachable_angle(0.5 + 2 * pi, 0, -2, 2) == Approx(0.5));
  CHECK(reachable_angle(3, 0, -2, 2) == Approx(2));
  CHECK(reachable_angle(-3, 0, -2, 2) == Approx(-2));
  CHECK(reachable_angle(1, 6, -2 * pi, 2 * pi) == Approx(1));
  CHECK(reachable_angle(1, -4, -2 * pi, 2 * pi) == Approx(1 - 2 * pi));
}
