// What the estimator makes of measurements, against hand-computed arcs.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <optional>

#include "hrt/estimate.hpp"
#include "robot/angles.hpp"
#include "robot/state.hpp"

using namespace kenaf;
using hrt::Estimate;
using hrt::Estimator;

namespace {

robot::State state_at(std::uint32_t frame, double left_m, double right_m) {
  robot::State state{};
  state.frame = frame;
  state.robot_time_s = 0.01 * frame;
  state.fields = robot::kHasEncoders;
  state.track_m = {left_m, right_m};
  return state;
}

}  // namespace

TEST_CASE("A quarter circle by the encoders ends a radius ahead and a radius to the left") {
  // Tracks 0.2 m apart on circles of 0.4 and 0.6 m: the centre drives a circle of 0.5 m.
  Estimator estimator({0.2, 1});
  const double quarter = std::numbers::pi / 2;
  Estimate last = estimator.update(state_at(1, 7, 7));  // where the encoders begin does not matter
  for (std::uint32_t i = 1; i <= 1000; ++i) {
    const double angle = quarter * i / 1000;
    last = estimator.update(state_at(1 + i, 7 + 0.4 * angle, 7 + 0.6 * angle));
  }
  CHECK(last.odometry_x_m == Approx(0.5).epsilon(1e-5));
  CHECK(last.odometry_y_m == Approx(0.5).epsilon(1e-5));
  CHECK(last.odometry_yaw_rad == Approx(quarter));
  CHECK(last.travel_m == Approx(7 + 0.5 * quarter));
}

TEST_CASE("Posture's yaw is unwrapped, and odometry begins at 0 whatever the yaw") {
  Estimator estimator({0.2, 1});
  Estimate last;
  for (std::uint32_t i = 0; i <= 2000; ++i) {
    robot::State state = state_at(1 + i, 0, 0);
    state.fields |= robot::kHasPosture;
    // 3 rad, then two and a half turns to the right at 0.9 degrees a cycle.
    state.posture_rad[2] = robot::wrap_angle(3 - std::min(5 * std::numbers::pi, i * 0.0157));
    last = estimator.update(state);
  }
  CHECK(last.heading_rad == Approx(3 - 5 * std::numbers::pi).margin(1e-6));
  CHECK(last.odometry_yaw_rad == Approx(-5 * std::numbers::pi).margin(1e-6));
}

TEST_CASE("Up a slope the odometry counts the ground plan") {
  Estimator estimator({0.2, 1});
  Estimate last;
  for (std::uint32_t i = 0; i <= 100; ++i) {
    robot::State state = state_at(1 + i, 0.01 * i, 0.01 * i);
    state.fields |= robot::kHasPosture;
    state.posture_rad[1] = -std::numbers::pi / 3;  // nose up by 60 degrees
    last = estimator.update(state);
  }
  CHECK(last.odometry_x_m == Approx(0.5));
}

TEST_CASE("A sensor that begins late or pauses makes nothing jump") {
  Estimator estimator({0.2, 1});
  robot::State nothing{};
  nothing.frame = 1;
  nothing.robot_time_s = 0.01;
  (void)estimator.update(nothing);
  robot::State late = state_at(2, 5, 5);
  late.fields |= robot::kHasPosture;
  late.posture_rad[2] = 1;
  Estimate now = estimator.update(late);
  CHECK(now.odometry_x_m == 0);
  CHECK(now.odometry_yaw_rad == 0);
  // What hrt.h tells of the sensor's yaw is yaw_deg; a motion under way holds a heading, which was 0.
  CHECK(now.heading_rad == 0);
  now = estimator.update(state_at(3, 5.1, 5.3));  // no posture: the heading stays, it does not become the encoders'
  CHECK(now.heading_rad == 0);
  for (std::uint32_t i = 0; i < 100; ++i) {
    late = state_at(4 + i, 5.1, 5.3);
    late.fields |= robot::kHasPosture;
    late.posture_rad[2] = 1.2;
    now = estimator.update(late);
  }
  CHECK(now.heading_rad == Approx(0.2));  // from 1 to 1.2 it turned
}

TEST_CASE("An orientation sensor slower than the cycle is followed as fast as one that is not") {
  Estimator estimator({0.2, 1});
  robot::State state = state_at(1, 0, 0);
  state.fields |= robot::kHasPosture;
  (void)estimator.update(state);
  for (std::uint32_t i = 2; i <= 10; ++i) (void)estimator.update(state_at(i, 0, 0));
  state.frame = 11;
  state.robot_time_s = 0.11;
  state.posture_rad[2] = 1;
  // 0.1 s after the value before: 1 - e^(-0.1 / 0.05)
  CHECK(estimator.update(state).heading_rad == Approx(0.864665));
}

TEST_CASE(
    "A lost orientation sensor leaves the heading to the encoders, and when it comes back the heading does not jump") {
  Estimator estimator({0.2, 1});
  const auto state = [](std::uint32_t cycle, double right_m, std::optional<double> yaw_rad) {
    robot::State out = state_at(cycle, 0, right_m);
    if (yaw_rad) out.fields |= robot::kHasPosture;
    out.posture_rad[2] = yaw_rad.value_or(0);
    return out;
  };
  (void)estimator.update(state(1, 0, 1.0));
  // the right track runs 1 mm a cycle: 0.005 rad at a gauge of 0.2 m. Lost after 0.25 s; then what was missed counts
  // too
  Estimate now;
  for (std::uint32_t i = 1; i <= 24; ++i) now = estimator.update(state(1 + i, 1e-3 * i, {}));
  CHECK(now.heading_rad == 1.0);
  for (std::uint32_t i = 25; i <= 100; ++i) now = estimator.update(state(1 + i, 1e-3 * i, {}));
  CHECK(now.heading_rad == Approx(1.5));
  // it began anew, at another zero: from here on its changes count
  now = estimator.update(state(102, 0.1, -2.0));
  CHECK(now.heading_rad == Approx(1.5));
  for (std::uint32_t i = 0; i < 100; ++i) now = estimator.update(state(103 + i, 0.1, -1.8));
  CHECK(now.heading_rad == Approx(1.7));
  CHECK(now.odometry_yaw_rad == Approx(0.7));
}

TEST_CASE("Time goes on where the robot's clock is put back, and the same to the last bit where it is not") {
  Estimator estimator({0.2, 1});
  Estimate now;
  for (std::uint32_t i = 1; i <= 100; ++i) {
    now = estimator.update(state_at(i, 0, 0));
    REQUIRE(now.t_s == static_cast<double>(10'000'000 * (i - 1)) * 1e-9);
  }
  robot::State state = state_at(101, 0, 0);
  state.robot_time_s = 0;  // a world's Reset: how long this cycle lasted is not known
  now = estimator.update(state);
  CHECK(now.dt_s == 0);
  CHECK(now.t_s == Approx(0.99));
  state = state_at(102, 0, 0);
  state.robot_time_s = 0.01;
  now = estimator.update(state);
  CHECK(now.dt_s == Approx(0.01));
  CHECK(now.t_s == Approx(1.0));
}

TEST_CASE("A world's reset is no motion, for the odometry nor for the heading") {
  for (const bool has_posture : {true, false}) {
    INFO(has_posture);
    Estimator estimator({0.2, 1});
    const auto cycle = [&](std::uint32_t number, double time_s, double left_m, double right_m, double yaw_rad) {
      robot::State out = state_at(number, left_m, right_m);
      out.robot_time_s = time_s;
      if (has_posture) out.fields |= robot::kHasPosture;
      out.posture_rad[2] = yaw_rad;
      return out;
    };
    // 1 m ahead, then the right track alone by 0.2 m: a turn by 1 rad at a gauge of 0.2 m, and 0.1 m more of travel
    (void)estimator.update(cycle(1, 0, 3, 3, 0.5));
    (void)estimator.update(cycle(2, 10, 4, 4, 0.5));
    Estimate now = estimator.update(cycle(3, 20, 4, 4.2, 1.5));
    const double x_m = now.odometry_x_m, y_m = now.odometry_y_m;
    CHECK_FALSE(now.world_was_reset);
    CHECK(now.heading_rad - (has_posture ? 0.5 : 0) == Approx(1));
    CHECK(std::hypot(x_m, y_m) == Approx(1.1).margin(0.02));

    // The robot is back at its start: encoders at 0, as it looked at first.
    const double heading_rad = now.heading_rad;
    now = estimator.update(cycle(4, 0, 0, 0, 0.5));
    CHECK(now.world_was_reset);
    CHECK(now.odometry_x_m == x_m);
    CHECK(now.odometry_y_m == y_m);
    CHECK(now.odometry_yaw_rad == Approx(1));
    CHECK(now.heading_rad == heading_rad);
    CHECK(now.travel_m == 0);

    // From there on it counts again: 0.5 m along the heading of the odometry, 1 rad.
    now = estimator.update(cycle(5, 10, 0.5, 0.5, 0.5));
    CHECK_FALSE(now.world_was_reset);
    CHECK(now.odometry_x_m - x_m == Approx(0.5 * std::cos(1)));
    CHECK(now.odometry_y_m - y_m == Approx(0.5 * std::sin(1)));
    CHECK(now.heading_rad == Approx(heading_rad));
  }
}

TEST_CASE("The tracks stand while they move less than the encoders resolve") {
  Estimator estimator({0.2, 1});
  (void)estimator.update(state_at(1, 0, 0));
  CHECK(estimator.update(state_at(2, 0.0002, 0)).still_s == Approx(0.01));
  CHECK(estimator.update(state_at(3, 0.0, 0.0002)).still_s == Approx(0.02));
  CHECK(estimator.update(state_at(4, 0.0, 0.0003)).still_s == 0);
  CHECK(estimator.update(state_at(5, 0.0, 0.0003)).still_s == Approx(0.01));
  // Creeping adds up: 0.1 mm a cycle is motion.
  Estimate now;
  double longest = 0;
  for (std::uint32_t i = 0; i < 100; ++i) {
    now = estimator.update(state_at(6 + i, 0.0001 * i, 0.0003));
    longest = std::max(longest, now.still_s);
  }
  CHECK(longest < 0.045);
}
