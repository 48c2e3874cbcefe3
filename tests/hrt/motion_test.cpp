// The motions are tested as pure state machines, against a plant whose behaviour is known in closed form. Goals are
// reached within their tolerance whatever the sign, rides take the time that the speed profile predicts, and a square
// closes. The orientation sensor holds the heading where the tracks differ and measures turns, past 180 degrees too,
// however much the tracks slip; without it the encoders and turn_efficiency count. Stuck, overcurrent and time-out are
// told apart, in robot time.
#include <catch2/catch.hpp>
#include <numbers>

#include "hrt/config.hpp"
#include "hrt/motion_forward.hpp"
#include "hrt/motion_turn.hpp"
#include "tests/hrt/plant.hpp"

using namespace kenaf::hrt;
using kenaf::hrt::test::Plant;
using kenaf::hrt::test::PlantSettings;

namespace {

constexpr double kOneDegree = std::numbers::pi / 180;

struct Ride {
  explicit Ride(const PlantSettings& settings, double turn_efficiency = 1)
      : plant(settings), estimator({settings.gauge_m, turn_efficiency}), now(estimator.update(plant.state)) {}

  // Runs a motion to its end; the tracks are then commanded to 0, as the library does.
  template <typename Motion>
  MotionStep run(Motion motion) {
    const double start_s = now.t_s;
    for (;;) {
      const MotionStep step = motion.step(now);
      if (step.finished) {
        duration_s = now.t_s - start_s;
        return step;
      }
      top_speed_mps = std::max(top_speed_mps, std::abs(step.track_speed_mps[1]));
      kenaf::robot::Command command;
      command.track_speed_mps = step.track_speed_mps;
      now = estimator.update(plant.advance(command));
    }
  }
  MotionStep forward(double distance_m) { return run(GoForward(limits, distance_m, heading_rad(), now)); }
  MotionStep turn(double angle_rad) {
    goal_rad = heading_rad() + angle_rad;
    return run(TurnInPlace(limits, *goal_rad, now));
  }
  double heading_rad() const { return goal_rad.value_or(now.heading_rad); }

  MotionLimits limits = motion_limits_from(default_config());
  Plant plant;
  Estimator estimator;
  Estimate now;
  std::optional<double> goal_rad;
  double duration_s = 0, top_speed_mps = 0;
};

}  // namespace

TEST_CASE("A distance is reached within 1 mm, forward and backward") {
  for (const double distance_m : {0.1, -0.1, 1.0, -0.03, 0.004}) {
    Ride ride({});
    const MotionStep end = ride.forward(distance_m);
    CAPTURE(distance_m, end.text);
    CHECK(end.code == HRT_OK);
    CHECK(end.track_speed_mps == std::array<double, 2>{0, 0});
    CHECK(std::abs(ride.plant.x_m - distance_m) <= 0.001);
    CHECK(std::abs(ride.plant.y_m) < 1e-9);
    CHECK(std::abs(ride.plant.track_mps[0]) < 0.005);  // it stands
  }
}

TEST_CASE("A distance within the tolerance moves nothing") {
  Ride ride({});
  CHECK(ride.forward(0).code == HRT_OK);
  CHECK(ride.plant.x_m == 0);
}

TEST_CASE("The profile: full speed is held, never passed, and the ride takes the time it should") {
  Ride ride({});
  CHECK(ride.forward(2.0).code == HRT_OK);
  CHECK(ride.top_speed_mps == Approx(0.2).epsilon(1e-9));
  // v = 0.2 m/s, a = 0.4 m/s^2: 0.5 s up over 0.05 m, (2 - 0.05 - 0.05) / 0.2 = 9.5 s, then down. From 2 a / k^2 =
  // 0.032 m on the speed is 5/s of the distance, through the drive's lag and a cycle, 0.06 s together: the roots of
  // 0.06 s^2 + s + 5 have the real part -8.3/s, so that half of the tolerance (0.0005 m) is there after
  // ln(64) / 8.3 = 0.5 s. Before that 0.1 s from 0.2 to 0.16 m/s, after it 0.05 s of standing: 10.65 s.
  CHECK(ride.duration_s == Approx(10.65).margin(0.15));
}

TEST_CASE("Speed over distance is the square root of twice the deceleration, exponential at the end") {
  const Approach approach{0.2, 0.4, 5, 0.003};
  CHECK(approach.speed(10, 0.2, 0.01) == Approx(0.2));
  CHECK(approach.speed(0.04, 0.2, 0.01) == Approx(std::sqrt(2 * 0.4 * 0.04)));
  CHECK(approach.speed(0.01, 0.2, 0.01) == Approx(0.05));
  CHECK(approach.speed(-0.01, -0.2, 0.01) == Approx(-0.05));
  CHECK(approach.speed(0.0001, 0.2, 0.01) == Approx(0.003));
  CHECK(approach.speed(10, 0, 0.01) == Approx(0.004));       // 0.4 m/s^2 for 10 ms
  CHECK(std::abs(approach.speed(10, -0.2, 0.01)) <= 0.003);  // never a jump through 0
  // 0.9 s without progress are 0.6 s of pushing: ten times the slowest, and never above the fastest.
  CHECK(approach.speed(0.0001, 0.003, 0.01, 0.3) == Approx(0.003));
  CHECK(approach.speed(0.0001, 0.003, 0.01, 0.9) == Approx(0.03));
  CHECK(approach.speed(0.0001, 0.003, 0.01, 100) == Approx(0.2));
  // 1 m: (1 - 0.1) / 0.2 + 2 * 0.5 = 5.5 s, plus five time constants of 0.2 s.
  CHECK(approach.duration_s(1) == Approx(6.5));
  // 0.025 m: a triangle, 2 sqrt(0.025 / 0.4) = 0.5 s.
  CHECK(approach.duration_s(0.025) == Approx(1.5));
}

TEST_CASE("The heading is held where one track makes 4 % less ground than the other") {
  const PlantSettings settings{.turn_efficiency = 0.6, .ground_per_belt = {1.0, 0.96}};
  Ride held(settings);
  CHECK(held.forward(1.0).code == HRT_OK);
  // Left alone the robot would turn by 0.6 * 0.04 m / 0.2 m = 0.12 rad. Held, the error is what makes the tracks
  // differ enough: gain 4/s against 0.6 * 0.04 * 0.2 m/s / 0.2 m = 0.024 rad/s, so 0.024 / (0.6 * 4) = 0.01 rad.
  CHECK(std::abs(held.plant.yaw_rad) < 0.012);

  PlantSettings blind = settings;
  blind.has_posture = false;
  Ride alone(blind);
  CHECK(alone.forward(1.0).code == HRT_OK);
  CHECK(alone.plant.yaw_rad == Approx(-0.12).margin(0.003));
}

TEST_CASE("A heading that is off at the start is taken back, also when driving backward") {
  for (const double distance_m : {0.5, -0.5}) {
    Ride ride({.turn_efficiency = 0.6, .yaw_start_rad = 3 * kOneDegree});
    ride.goal_rad = 0;
    CHECK(ride.forward(distance_m).code == HRT_OK);
    CHECK(std::abs(ride.plant.yaw_rad) < 0.3 * kOneDegree);
  }
}

TEST_CASE("A turn is reached within 0.3 degrees although the tracks slip") {
  for (const double efficiency : {1.0, 0.7, 0.45}) {
    for (const double degrees : {90.0, -90.0, 180.0, 360.0, -720.0, 5.0}) {
      Ride ride({.turn_efficiency = efficiency, .yaw_start_rad = 170 * kOneDegree});
      const MotionStep end = ride.turn(degrees * kOneDegree);
      CAPTURE(efficiency, degrees, end.text);
      CHECK(end.code == HRT_OK);
      CHECK(std::abs(ride.plant.yaw_rad / kOneDegree - 170 - degrees) <= 0.3);
    }
  }
}

TEST_CASE("Positive is to the left: the right track drives forward") {
  Ride ride({});
  TurnInPlace turn(ride.limits, 90 * kOneDegree, ride.now);
  (void)turn.step(ride.now);
  const MotionStep step = turn.step(ride.estimator.update(ride.plant.advance(kenaf::robot::Command{})));
  CHECK(step.track_speed_mps[0] < 0);
  CHECK(step.track_speed_mps[1] == -step.track_speed_mps[0]);
}

TEST_CASE("Without an orientation sensor a turn is the encoders' times turn_efficiency") {
  PlantSettings settings{.turn_efficiency = 0.6, .has_posture = false};
  Ride calibrated(settings, 0.6);
  CHECK(calibrated.turn(90 * kOneDegree).code == HRT_OK);
  CHECK(std::abs(calibrated.plant.yaw_rad / kOneDegree - 90) <= 0.3);
  Ride uncalibrated(settings, 1);
  CHECK(uncalibrated.turn(90 * kOneDegree).code == HRT_OK);
  CHECK(uncalibrated.plant.yaw_rad / kOneDegree == Approx(0.6 * 90).margin(0.3));
}

TEST_CASE("Blocked tracks are stuck after stuck_time_s of robot time") {
  for (const double period_s : {0.01, 0.002}) {
    Ride ride({.period_s = period_s, .tracks_blocked = true});
    const MotionStep forward = ride.forward(0.1);
    CHECK(forward.code == HRT_E_STUCK);
    CHECK(forward.text.find("0 mm of 100 mm") != std::string::npos);
    CHECK(ride.duration_s == Approx(1.0).margin(2 * period_s));
    CHECK(ride.turn(90 * kOneDegree).code == HRT_E_STUCK);
  }
}

TEST_CASE("Noise of the orientation sensor is no progress") {
  Ride ride({.yaw_noise_rad = 0.1 * kOneDegree, .tracks_blocked = true});
  CHECK(ride.turn(90 * kOneDegree).code == HRT_E_STUCK);
  CHECK(ride.duration_s < 3);
}

TEST_CASE("A track current above the limit is stuck before any encoder shows it") {
  Ride ride({.idle_a = 5});  // tracks spin in front of a wall: they travel, but pull hard
  ride.limits.stuck_current_a = 4;
  const MotionStep end = ride.forward(1.0);
  CHECK(end.code == HRT_E_STUCK);
  CHECK(end.text.find("stuck_current_a") != std::string::npos);
  CHECK(ride.duration_s == Approx(1.0).margin(0.02));
}

TEST_CASE("A robot that gets on, but far too slowly, runs into the time limit") {
  Ride ride({.max_track_mps = 0.002});
  const MotionStep end = ride.forward(1.0);
  CHECK(end.code == HRT_E_TIMEOUT);
  // Three times the profile's 6.5 s, plus 5 s.
  CHECK(ride.duration_s == Approx(3 * 6.5 + 5).margin(0.05));
}

TEST_CASE("Tracks that need 10 mm/s to get going are pushed until they do") {
  Ride ride({.dead_band_mps = 0.01});
  CHECK(ride.forward(0.1).code == HRT_OK);
  CHECK(std::abs(ride.plant.x_m - 0.1) <= 0.001);
  CHECK(ride.turn(45 * kOneDegree).code == HRT_OK);
  CHECK(std::abs(ride.plant.yaw_rad / kOneDegree - 45) <= 0.3);
}

TEST_CASE("A square of 100 mm closes within 10 mm and 2 degrees: slip, noise, off-centre turns, unequal tracks") {
  Ride ride({.turn_efficiency = 0.55,
             .ground_per_belt = {0.98, 0.96},
             .turn_centre_m = 0.02,
             .yaw_noise_rad = 0.1 * kOneDegree});
  for (int side = 0; side < 4; ++side) {
    REQUIRE(ride.forward(0.1).code == HRT_OK);
    REQUIRE(ride.turn(90 * kOneDegree).code == HRT_OK);
  }
  CHECK(std::hypot(ride.plant.x_m, ride.plant.y_m) < 0.003);
  CHECK(std::abs(ride.plant.yaw_rad / kOneDegree - 360) < 0.5);
}
