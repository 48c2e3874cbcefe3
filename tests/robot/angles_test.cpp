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

TEST_CASE("Half a turn is reached by the side that was asked for, if a limit is half a turn in fewer digits") {
  const double limit = 3.14159265;  // share/robots/kenaf.toml: 3.6e-9 less than pi
  for (const double present : {-3.0, -1e-3, 0.0, 1e-3, 3.0, 3.2}) {
    INFO(present);
    CHECK(reachable_angle(pi, present, -limit, limit) == limit);
    CHECK(reachable_angle(-pi, present, -limit, limit) == -limit);
    // as clients of USARSim write it
    CHECK(reachable_angle(3.1416, present, -limit, limit) == limit);
    CHECK(reachable_angle(-3.142, present, -limit, limit) == -limit);
  }
  // Three quarters of a turn up are a quarter down; 3.15 is beyond, and 3.15 - 2 pi = -3.1332.
  CHECK(reachable_angle(1.5 * pi, 0, -limit, limit) == Approx(-0.5 * pi));
  CHECK(reachable_angle(3.15, 0, -limit, limit) == Approx(3.15 - 2 * pi));
}

TEST_CASE("A joint of more than a turn goes to the nearer of two equal angles, also from one end to the other") {
  CHECK(reachable_angle(2 * pi, 0.1, -2 * pi, 2 * pi) == Approx(0).margin(1e-9));
  CHECK(reachable_angle(2 * pi, 6, -2 * pi, 2 * pi) == Approx(2 * pi));
  CHECK(reachable_angle(6.2832, 6, -6.28, 6.28) == Approx(6.2832 - 2 * pi).margin(1e-9));  // 0.0032 beyond its end
}
