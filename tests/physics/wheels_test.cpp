// Robots on wheels: rolling, skid steering, steps, casters.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "physics/world.hpp"
#include "tests/physics/scenes.hpp"

namespace kenaf::physics {
namespace {

// Four wheels of radius 0.1 m and width 40 mm, axles 0.4 m apart, 0.5 m from side to side; 20 kg above the middle.
RobotDescription four_wheels(double friction) {
  RobotDescription robot = load_robot("kenaf");
  robot.flipper.clear();
  robot.body.mass_kg = 20;
  robot.body.size_m = {0.4, 0.3, 0.1};
  robot.body.p_BBcm_m = {0, 0, 0};
  robot.body.inertia_kgm2 = {0.3, 0.4, 0.6};
  robot.drive.max_force_n = 1000;
  robot.drive.max_speed_mps = 1;
  robot.track.clear();
  for (const double x : {0.2, -0.2})
    robot.track.push_back({.length_m = 0.2,
                           .end_radius_m = 0.1,
                           .width_m = 0.04,
                           .p_BT_m = {x, 0.25, -0.02},
                           .friction_along = friction,
                           .friction_across = friction,
                           .pieces = 1,
                           .lug_height_m = 0});
  return robot;
}

double turned_rad(World& world, RobotId id, double time_s) {
  const double before = yaw_of(world.truth(id).X_WB);
  run(world, time_s);
  return std::remainder(yaw_of(world.truth(id).X_WB) - before, 2 * std::numbers::pi);
}

}  // namespace

TEST_CASE("A robot on wheels stands on its lowest points") {
  // B is 0.12 m above ground; 20 kg on 8 points of 200 kN/m sink in by 20 g / 1.6 MN/m = 0.12 mm
  World world(ground(), {}, 1);
  const RobotDescription robot = four_wheels(1);
  CHECK(robot.has_wheels());
  CHECK(robot.ride_height_m() == Approx(0.12));
  CHECK(robot.contact_length_m() == Approx(0.4));
  CHECK(robot.track_length_m() == Approx(0.6));
  CHECK(robot.track_gauge_m() == Approx(0.5));
  CHECK(robot.outer_width_m() == Approx(0.54));
  const RobotId id = world.add_robot(robot, "a", {{0, 0, 0.13}, Eigen::Quaterniond::Identity()});
  run(world, 2);
  CHECK(world.truth(id).X_WB.p.z() == Approx(0.12 - 20 * kGravity / 1.6e6).margin(2e-6));
  CHECK(roll_pitch_yaw(world.truth(id).X_WB.q).norm() < 1e-6);
}

TEST_CASE("Wheels roll as far as their rims turn") {
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(four_wheels(1), "a", {});
  world.set_command(id, drive(0.3, 0.3));
  run(world, 1);
  const double from_m = world.truth(id).X_WB.p.x(), rim_m = world.truth(id).track_m[robot::kLeft];
  run(world, 2);
  CHECK(world.truth(id).X_WB.p.x() - from_m == Approx(0.6).epsilon(1e-3));
  CHECK(world.truth(id).track_m[robot::kLeft] - rim_m == Approx(0.6).epsilon(1e-3));
  CHECK(std::abs(world.truth(id).X_WB.p.y()) < 1e-6);
}

// Turning in place, quasi-static, isotropic friction, a quarter of the load on each wheel, half of it at each of its
// two edges: the rate w at which the friction's moment about the middle is zero. At (x, y) the slip is (u - w y, w x):
//   sum [ y (u - w y) - x (w x) ] / |slip| = 0        x = 0.2, y = 0.25 -+ 0.02 (both signs of x alike)
// It depends on no friction coefficient.
TEST_CASE("Four wheels turn in place at the rate at which their friction has no moment") {
  constexpr double kSpeed_mps = 0.2;
  const auto moment = [](double w) {
    double sum = 0;
    for (const double y : {0.23, 0.27})
      sum += (y * (kSpeed_mps - w * y) - 0.2 * w * 0.2) / std::hypot(kSpeed_mps - w * y, w * 0.2);
    return sum;
  };
  double low = 0, high = kSpeed_mps / 0.23;
  for (int i = 0; i < 60; ++i) (moment((low + high) / 2) > 0 ? low : high) = (low + high) / 2;
  // Near enough as if each wheel had one point: u y = w (x^2 + y^2), w = 0.2 * 0.25 / (0.04 + 0.0625) = 0.488 rad/s,
  // 0.61 of what wheels without slip would: 0.4 / 0.5 = 0.8 rad/s.
  CHECK(low == Approx(0.488).epsilon(0.02));
  for (const double friction : {0.5, 1.0}) {
    World world(ground(), {}, 1);
    const RobotId id = world.add_robot(four_wheels(friction), "a", {});
    world.set_command(id, drive(-kSpeed_mps, kSpeed_mps));
    run(world, 2);
    CHECK(turned_rad(world, id, 2) / 2 == Approx(low).epsilon(2e-3));
    CHECK(world.truth(id).X_WB.p.head<2>().norm() < 1e-3);
  }
}

// Six wheels: the middle pair, in the line of the centre of mass, slides along only, and helps to turn.
TEST_CASE("A middle pair of wheels makes a robot turn faster") {
  RobotDescription robot = four_wheels(1);
  robot.track.insert(robot.track.begin() + 1, robot.track.front());
  robot.track[1].p_BT_m.x() = 0;
  constexpr double kSpeed_mps = 0.2;
  const auto moment = [](double w) {
    double sum = 0;
    for (const double y : {0.23, 0.27}) {
      for (const double x : {0.2, 0.0, -0.2}) {
        const double slip_mps = std::hypot(kSpeed_mps - w * y, w * x);
        sum += (y * (kSpeed_mps - w * y) - x * w * x) / slip_mps;
      }
    }
    return sum;
  };
  double low = 0.3, high = kSpeed_mps / 0.27;
  for (int i = 0; i < 60; ++i) (moment((low + high) / 2) > 0 ? low : high) = (low + high) / 2;
  CHECK(low > 0.55);
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(robot, "a", {});
  world.set_command(id, drive(-kSpeed_mps, kSpeed_mps));
  run(world, 2);
  CHECK(turned_rad(world, id, 2) / 2 == Approx(low).epsilon(2e-3));
}

// The highest step that the front wheels of a slow robot climb, all wheels driven. Statics with the front wheels at the
// edge and lifted off the ground, normal inclined by a from the vertical, cos a = (r - h) / r, rear ones (N_r) at their
// limit mu N_r, l = b + r sin a from the rear contact to the edge, c from it to the centre of mass, weight W:
//   x: F_x = -mu N_r                 z: F_z = W - N_r
//   about the rear contact: F_z l - F_x h = W c   =>   N_r = W (l - c) / (l - mu h)
// The edge holds if the force along the rim is at most mu times that towards the axle:
//   F_x cos a + F_z sin a <= mu (F_z cos a - F_x sin a)
double highest_step_m(double mu) {
  constexpr double r = 0.1, b = 0.4, c = 0.2;
  const auto holds = [&](double h) {
    const double cos_a = (r - h) / r, sin_a = std::sqrt(1 - cos_a * cos_a), l = b + r * sin_a;
    const double rear = (l - c) / (l - mu * h), F_x = -mu * rear, F_z = 1 - rear;
    return F_x * cos_a + F_z * sin_a <= mu * (F_z * cos_a - F_x * sin_a);
  };
  double low = 0, high = r;
  for (int i = 0; i < 60; ++i) (holds((low + high) / 2) ? low : high) = (low + high) / 2;
  return low;
}

TEST_CASE("Front wheels climb the steps that statics allows, and no higher ones") {
  const auto climbs = [](double mu, double step_m) {
    WorldDescription world_of_step = ground();
    world_of_step.boxes.push_back(fixed_box({2, 2, step_m}, {1.6, 0, step_m / 2}));
    World world(world_of_step, {}, 1);
    const RobotId id = world.add_robot(four_wheels(mu), "a", {{0.29, 0, 0.12}, Eigen::Quaterniond::Identity()});
    // slowly: at 0.05 m/s its momentum carries the robot up 4 mm more
    world.set_command(id, drive(0.01, 0.01));
    run(world, 15);
    return -roll_pitch_yaw(world.truth(id).X_WB.q).y() > 0.6 * std::asin(step_m / 0.4);
  };
  for (const double mu : {0.4, 0.6}) {
    const double limit_m = highest_step_m(mu);
    INFO("friction " << mu << ": up to " << limit_m << " m");
    CHECK(climbs(mu, 0.96 * limit_m));
    CHECK_FALSE(climbs(mu, 1.05 * limit_m));
  }
}

// Two driven wheels on an axle through the centre of mass, and a caster behind without friction: no moment resists but
// the wheels' own width, so the robot turns as wheels without slip, about the axle's middle.
TEST_CASE("Two wheels and a caster turn about the axle") {
  RobotDescription robot = four_wheels(1);
  robot.track.resize(1);
  robot.track.front().p_BT_m.x() = 0;
  robot.track.front().width_m = 0.004;
  robot.body.p_BBcm_m = {-0.05, 0, 0};
  robot.caster.push_back({.p_BC_m = {-0.2, 0, -0.08}, .radius_m = 0.04, .width_m = 0.02, .friction = 0});
  CHECK(robot.has_wheels());
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(robot, "a", {});
  world.set_command(id, drive(-0.2, 0.2));
  run(world, 1);
  CHECK(turned_rad(world, id, 2) / 2 == Approx(0.4 / 0.5).epsilon(0.01));
  CHECK(world.truth(id).X_WB.p.head<2>().norm() < 2e-3);
  CHECK(std::abs(roll_pitch_yaw(world.truth(id).X_WB.q).y()) < 1e-3);
}

TEST_CASE("A caster holds its robot back by its friction and its load") {
  // 0.05 m of 0.2 m behind the axle: a quarter of 20 kg on the caster; at 0.2 of friction it costs 0.2 * 5 g = 9.81 N
  RobotDescription robot = four_wheels(1);
  robot.track.resize(1);
  robot.track.front().p_BT_m.x() = 0;
  robot.body.p_BBcm_m = {-0.05, 0, -0.12};
  robot.caster.push_back({.p_BC_m = {-0.2, 0, -0.08}, .radius_m = 0.04, .width_m = 0.02, .friction = 0.2});
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(robot, "a", {});
  world.set_command(id, drive(0.2, 0.2));
  run(world, 3);
  const RobotTruth truth = world.truth(id);
  CHECK(truth.track_force_n[robot::kLeft] + truth.track_force_n[robot::kRight] ==
        Approx(0.2 * 20 * kGravity / 4).epsilon(0.01));
}

// Of real robots, each side against the other: the distance between wheels that roll without slip and turn the robot as
// fast. No number of the descriptions was fitted to it.
//   husky    1.07 m: turns 0.52 of what slipless wheels 0.555 m apart would (norlab-ulaval/DRIVE)
//   warthog  1.86 m: turns 0.58 of what slipless wheels 1.08 m apart would, on asphalt (the same)
//   jackal   0.563 m: "wheel_separation_multiplier: 1.5" of 0.376 m (jackal_control/config/control.yaml)
//   p3at     0.588 m: 2 / DiffConvFactor, 0.0034 rad/s per mm/s (AriaCoda, params/p3at-sh.p)
TEST_CASE("Robots on wheels turn on the spot as the real ones do") {
  struct Real {
    const char* name;
    double width_m;
  };
  for (const Real& real : {Real{"husky", 1.07}, {"warthog", 1.86}, {"jackal", 0.563}, {"p3at", 0.588}}) {
    const RobotDescription robot = load_robot(real.name);
    World world(ground(), {}, 1);
    const RobotId id = world.add_robot(robot, "a", {{0, 0, robot.ride_height_m()}, Eigen::Quaterniond::Identity()});
    world.set_command(id, drive(-0.3, 0.3));
    run(world, 2);
    const double width_m = 0.6 / (turned_rad(world, id, 2) / 2);
    INFO(real.name << ": " << width_m << " m");
    CHECK(width_m == Approx(real.width_m).epsilon(0.1));
  }
}

}  // namespace kenaf::physics
