// Tracks drive, hold, turn and climb as far as friction and motors allow. The references are closed forms: the belt's
// commanded speed, momentum shared between belt and ground, the turning rate at which the moment of friction vanishes,
// and the forces needed on an incline and at a step. A world turned by any angle gives the same run, as no axis is
// special.
#include <catch2/catch.hpp>

#include "tests/physics/scenes.hpp"

using namespace kenaf;
using namespace kenaf::physics;

TEST_CASE("Robot and belt reach the commanded speed within 0.1 %") {
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(load_robot("kenaf"), "a", {});
  world.set_command(id, drive(0.2, 0.2));
  run(world, 3);
  CHECK(world.truth(id).track_mps[robot::kLeft] == Approx(0.2).epsilon(1e-3));
  CHECK(world.truth(id).v_WB_mps.x() == Approx(0.2).epsilon(1e-3));
  // the speed loop is a lag of 0.05 s: 0.2 (3 - 0.05) m
  CHECK(world.truth(id).X_WB.p.x() == Approx(0.59).margin(2e-3));
  world.set_command(id, drive(-0.2, -0.2));
  run(world, 2);
  CHECK(world.truth(id).v_WB_mps.x() == Approx(-0.2).epsilon(1e-3));
}

TEST_CASE("Tracks that drive alike do not pull against each other") {
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(load_robot("kenaf"), "a", {});
  world.set_command(id, drive(0.2, 0.2));
  run(world, 3);
  CHECK(std::abs(world.truth(id).track_force_n[robot::kLeft]) < 0.5);
  CHECK(std::abs(world.truth(id).track_force_n[robot::kRight]) < 0.5);
}

TEST_CASE("A stopped belt is plain friction") {
  const double slope = std::numbers::pi / 6;
  const auto slide_m = [slope](double friction, double yaw) {
    World world(ground(1, slope), {}, 1);
    const Pose X_WP{Eigen::Vector3d::Zero(), rotation_from({0, slope, 0})};
    const RobotId id =
        world.add_robot(plain_tracks(friction), "a", compose(X_WP, {{0, 0, 0.09}, rotation_from({0, 0, yaw})}));
    const double start = (X_WP.q.conjugate() * world.truth(id).X_WB.p).x();
    run(world, 1);
    return (X_WP.q.conjugate() * world.truth(id).X_WB.p).x() - start;
  };
  for (const double yaw : {0.0, std::numbers::pi / 2}) {
    CHECK(slide_m(0.3, yaw) == Approx(kGravity * (0.5 - 0.3 * std::sqrt(3.0) / 2) / 2).epsilon(0.02));
    CHECK(std::abs(slide_m(0.7, yaw)) < 1e-3);
  }
}

TEST_CASE("A robot without a command stays where it is") {
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(load_robot("kenaf"), "a", {});
  run(world, 0.5);
  const Pose before = world.truth(id).X_WB;
  run(world, 10);
  CHECK((world.truth(id).X_WB.p - before.p).norm() < 1e-4);
}

// It leans with its tracks on the edge of a step. By symmetry each of them holds half, and nothing that creeps lets one
// take over: what they pull against each other is gone 1 / e^(6 / 0.5) after 6 s. What stays is of normal forces, which
// differ by as little as the robot is turned.
TEST_CASE("Both tracks hold alike a robot that rests against a step") {
  WorldDescription description = ground();
  description.boxes.push_back(fixed_box({1, 4, 0.2}, {1.5, 0, 0.1}));
  World world(description, {}, 1);
  const RobotId id = world.add_robot(load_robot("kenaf"), "a", {});
  world.set_command(id, drive(0.2, 0.2));
  run(world, 5);
  world.set_command(id, drive(0, 0));
  run(world, 1);
  const Pose before = world.truth(id).X_WB;
  REQUIRE(roll_pitch_yaw(before.q).y() < -0.3);
  run(world, 6);
  const RobotTruth truth = world.truth(id);
  const double left_n = truth.track_force_n[robot::kLeft], right_n = truth.track_force_n[robot::kRight];
  CHECK(left_n + right_n > 20);
  CHECK(left_n / right_n == Approx(1).margin(0.02));
  CHECK((truth.X_WB.p - before.p).norm() < 1e-6);
}

// 20 kg and two belts of 1.5 kg. Friction across could hold a robot straight whose left track pulls alone, too.
TEST_CASE("Both tracks pull alike while a robot speeds up, slows down and climbs a slope") {
  for (const double slope_rad : {0.0, 0.2}) {
    WorldDescription description = ground();
    description.gravity_W_mps2 = kGravity * Eigen::Vector3d(-std::sin(slope_rad), 0, -std::cos(slope_rad));
    World world(description, {}, 1);
    const RobotId id = world.add_robot(load_robot("kenaf"), "a", {});
    run(world, 0.5);
    double speed_mps = world.truth(id).v_WB_mps.x(), belt_mps = world.truth(id).track_mps[robot::kLeft];
    for (int i = 0; i < 1000; ++i) {
      world.set_command(id, i < 500 ? drive(0.2, 0.2) : drive(-0.1, -0.1));
      world.step();
      const RobotTruth truth = world.truth(id);
      const double left_n = truth.track_force_n[robot::kLeft], right_n = truth.track_force_n[robot::kRight];
      const double needed_n = 20 * ((truth.v_WB_mps.x() - speed_mps) / 1e-3 + kGravity * std::sin(slope_rad)) +
                              3 * (truth.track_mps[robot::kLeft] - belt_mps) / 1e-3;
      speed_mps = truth.v_WB_mps.x();
      belt_mps = truth.track_mps[robot::kLeft];
      INFO("slope " << slope_rad << ", step " << i);
      REQUIRE(std::abs(left_n - right_n) / 2 < 0.01 * 138);  // the largest pull: (20 + 3) kg 0.3 m/s / 0.05 s
      if (i % 500 > 5) REQUIRE(left_n + right_n == Approx(needed_n).epsilon(0.02).margin(0.5));
    }
  }
}

TEST_CASE("3 mm/s does not fall asleep") {
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(load_robot("kenaf"), "a", {});
  world.set_command(id, drive(0.003, 0.003));
  run(world, 20);
  CHECK(world.truth(id).X_WB.p.x() == Approx(0.003 * 19.95).margin(2e-4));
}

TEST_CASE("A belt drives the same way whichever body Bullet calls the first") {
  for (const bool robot_first : {true, false}) {
    for (const double mass_kg : {0.0, 1e5}) {
      World world(ground(), {}, 1);
      Box platform = fixed_box({4, 4, 0.1}, {0, 0, 0.05});
      platform.mass_kg = mass_kg;
      RobotId id{};
      if (robot_first) id = world.add_robot(plain_tracks(1), "a", {{0, 0, 0.3}, Eigen::Quaterniond::Identity()});
      world.add_box(platform);
      if (!robot_first) id = world.add_robot(plain_tracks(1), "a", {{0, 0, 0.3}, Eigen::Quaterniond::Identity()});
      run(world, 1);
      const double start = world.truth(id).X_WB.p.x();
      world.set_command(id, drive(0.2, 0.2));
      run(world, 2);
      CHECK(world.truth(id).X_WB.p.x() - start == Approx(0.39).margin(5e-3));
    }
  }
}

TEST_CASE("Side faces do not drive") {
  World world(ground(), {}, 1);
  // on its left side: the outer face of the left track is down
  const RobotId id = world.add_robot(plain_tracks(1), "a", {{0, 0, 0.2}, rotation_from({-std::numbers::pi / 2, 0, 0})});
  run(world, 0.5);
  const Eigen::Vector3d before = world.truth(id).X_WB.p;
  world.set_command(id, drive(0.4, 0.4));
  run(world, 2);
  CHECK((world.truth(id).X_WB.p - before).norm() < 5e-3);
}

TEST_CASE("A belt's speed adds to that of the ground under it") {
  // a slab of the robot's own mass on ground without friction: momentum stays 0, so each gets half of 0.2 m/s
  World world(ground(0), {}, 1);
  const BoxId slab = world.add_box(loose_box({3, 2, 0.1}, {{0, 0, 0.05}, Eigen::Quaterniond::Identity()}, 15, 1));
  const RobotId id = world.add_robot(plain_tracks(1), "a", {{0, 0, 0.2}, Eigen::Quaterniond::Identity()});
  run(world, 0.5);
  world.set_command(id, drive(0.2, 0.2));
  run(world, 0.5);
  const double slab_before = world.box_pose(slab).p.x();
  run(world, 1);
  CHECK(world.truth(id).v_WB_mps.x() == Approx(0.1).epsilon(0.01));
  CHECK(world.box_pose(slab).p.x() - slab_before == Approx(-0.1).epsilon(0.01));
}

namespace {

// Yaw rate of a vehicle that turns in place, quasi-static, uniform pressure under both tracks, isotropic Coulomb
// friction: the rate at which the friction's moment is zero,
//   sum [ y (v - w y) - w x^2 ] / |(v - w y, w x)| = 0 over one track.
double uniform_pressure_turn_radps(const RobotDescription& robot, double speed_mps) {
  const double length = robot.track.front().length_m - 2 * robot.track.front().end_radius_m;
  const double inner = robot.track.front().p_BT_m.y() - robot.track.front().width_m / 2;
  const auto moment = [&](double w) {
    double sum = 0;
    for (int i = 0; i < 100; ++i) {
      for (int j = 0; j < 20; ++j) {
        const double x = length * ((i + 0.5) / 100 - 0.5), y = inner + robot.track.front().width_m * (j + 0.5) / 20;
        sum += (y * (speed_mps - w * y) - w * x * x) / std::hypot(speed_mps - w * y, w * x);
      }
    }
    return sum;
  };
  double low = 0, high = 2 * speed_mps / inner;
  for (int i = 0; i < 60; ++i) (moment((low + high) / 2) > 0 ? low : high) = (low + high) / 2;
  return low;
}

}  // namespace

TEST_CASE("The turning rate comes out of the load's spread") {
  for (const char* name : {"kenaf", "marmotte"}) {
    RobotDescription robot = load_robot(name);
    robot.flipper.clear();
    robot.track.front().pieces = 6;
    robot.body.p_BBcm_m.x() = 0;
    for (const double friction : {0.5, 1.0}) {
      robot.track.front().friction_along = robot.track.front().friction_across = friction;
      robot.drive.max_force_n = 1000;
      World world(ground(), {}, 1);
      const RobotId id = world.add_robot(robot, "a", {});
      world.set_command(id, drive(-0.2, 0.2));
      run(world, 1);
      const double before = yaw_of(world.truth(id).X_WB);
      run(world, 1);
      const double turned = std::remainder(yaw_of(world.truth(id).X_WB) - before, 2 * std::numbers::pi);
      const double expected = uniform_pressure_turn_radps(robot, 0.2);
      INFO(name << ", friction " << friction << ": " << turned << " rad/s, uniform pressure " << expected);
      CHECK(turned == Approx(expected).epsilon(0.10));
      CHECK(world.truth(id).X_WB.p.head<2>().norm() < 0.005);
    }
  }
}

// The same sum over the points that a belt stands on: on both of its edges, a piece's length apart, half the load at
// the ends. Nothing is left between this and the simulation but how far the turn has settled after 1 s, far below 0.1
// %.
TEST_CASE("The turning rate is that of the contacts' own loads") {
  for (const int pieces : {1, 2, 6}) {
    RobotDescription robot = plain_tracks(1);
    robot.track.front().pieces = pieces;
    robot.body.p_BBcm_m.x() = 0;
    robot.drive.max_force_n = 1000;
    const double speed_mps = 0.2, length = robot.track.front().length_m - 2 * robot.track.front().end_radius_m;
    const auto moment = [&](double w) {
      double sum = 0;
      for (const double side : {-0.5, 0.5}) {
        for (int i = 0; i <= pieces; ++i) {
          const double x = length * (static_cast<double>(i) / pieces - 0.5);
          const double y = robot.track.front().p_BT_m.y() + side * robot.track.front().width_m;
          const double share = i == 0 || i == pieces ? 0.5 : 1;
          sum += share * (y * (speed_mps - w * y) - w * x * x) / (std::hypot(speed_mps - w * y, w * x) + 1e-9);
        }
      }
      return sum;
    };
    double low = 0, high = 5;
    for (int i = 0; i < 60; ++i) (moment((low + high) / 2) > 0 ? low : high) = (low + high) / 2;
    World world(ground(), {}, 1);
    const RobotId id = world.add_robot(robot, "a", {});
    world.set_command(id, drive(-speed_mps, speed_mps));
    run(world, 1);
    const double before = yaw_of(world.truth(id).X_WB);
    run(world, 1);
    CHECK(std::remainder(yaw_of(world.truth(id).X_WB) - before, 2 * std::numbers::pi) == Approx(low).epsilon(1e-3));
  }
}

TEST_CASE("A slow turn is a turn") {
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(load_robot("kenaf"), "a", {});
  world.set_command(id, drive(-0.006, 0.006));
  run(world, 2);
  CHECK(world.truth(id).track_mps[robot::kRight] == Approx(0.006).epsilon(0.01));
  CHECK(world.truth(id).w_WB_radps.z() > 0.015);  // 0.06 rad/s if nothing slipped
}

TEST_CASE("A world turned by any angle gives the same run", "[long]") {
  const auto run_turned = [](double yaw) {
    WorldDescription description = ground();
    const Eigen::Quaterniond q = rotation_from({0, 0, yaw});
    description.boxes.push_back({"step", {1, 2, 0.05}, {q * Eigen::Vector3d(1, 0, 0.025), q}, 1, 0});
    World world(description, {}, 1);
    const RobotId id = world.add_robot(load_robot("kenaf"), "a", {Eigen::Vector3d::Zero(), q});
    std::vector<Eigen::Vector3d> path;
    for (const auto& [left, right] : {std::pair{0.3, 0.1}, {-0.2, 0.3}, {0.3, -0.1}, {0.25, 0.25}}) {
      world.set_command(id, drive(left, right));
      for (int i = 0; i < 10; ++i) {
        run(world, 0.1);
        path.push_back(q.conjugate() * world.truth(id).X_WB.p);
      }
    }
    return path;
  };
  const auto reference = run_turned(0);
  for (const double yaw : {0.3, 0.7853981, 2.0, -2.6}) {
    const auto turned = run_turned(yaw);
    for (std::size_t i = 0; i < reference.size(); ++i) CHECK((turned[i] - reference[i]).norm() < 1e-3);
  }
}

// Climbing multiplies what rounding makes different: 1 mm is far above that, and far below what axes that mattered
// would do.
TEST_CASE("A world turned by any angle gives the same climb over a step, and over a ridge of triangles", "[long]") {
  const bool mesh = GENERATE(false, true);
  const auto climb = [mesh](double yaw) {
    const Eigen::Quaterniond q = rotation_from({0, 0, yaw});
    WorldDescription description = ground();
    if (mesh) {
      TriangleMesh ridge = roof(0.3);
      for (Eigen::Vector3d& p_W : ridge.vertices_W) p_W = q * Eigen::Vector3d(p_W + Eigen::Vector3d(2.6, 0.07, 0));
      description.meshes.push_back(ridge);
    } else {
      description.boxes.push_back({"step", {1, 2, 0.15}, {q * Eigen::Vector3d(1, 0.07, 0.075), q}, 1, 0});
    }
    World world(description, {}, 1);
    const RobotId id = world.add_robot(load_robot("kenaf"), "a", {Eigen::Vector3d::Zero(), q});
    std::vector<Eigen::Vector3d> path;
    world.set_command(id, drive(0.3, 0.28, 0.8, 0));
    for (int i = 0; i < 60; ++i) {
      run(world, 0.1);
      path.push_back(q.conjugate() * world.truth(id).X_WB.p);
    }
    CHECK(path.back().z() > 0.18);  // 0.09 when it began
    return path;
  };
  const auto reference = climb(0);
  for (const double yaw : {0.3, 0.7853981, -2.6}) {
    const auto turned = climb(yaw);
    for (std::size_t i = 0; i < reference.size(); ++i) {
      INFO("yaw " << yaw << ", " << 0.1 * static_cast<double>(i + 1) << " s");
      CHECK((turned[i] - reference[i]).norm() < 1e-3);
    }
  }
}

TEST_CASE("Tracks have no more traction than the motor or the ground can give") {
  // against a wall: the belts slip on the ground, or stall
  const auto wall_force = [](double max_force_n, double friction) {
    WorldDescription description = ground();
    description.boxes.push_back(fixed_box({0.1, 2, 1}, {0.5, 0, 0.5}));
    RobotDescription robot = plain_tracks(friction);
    robot.drive.max_force_n = max_force_n;
    robot.track.front().friction_across = 0;  // else the belts climb the wall
    World world(description, {}, 1);
    const RobotId id = world.add_robot(robot, "a", {});
    world.set_command(id, drive(0.1, 0.1));
    run(world, 5);
    return world.truth(id);
  };
  const RobotTruth stalled = wall_force(10, 0.5);
  CHECK(stalled.track_force_n[robot::kLeft] == Approx(10).epsilon(0.01));
  CHECK(stalled.track_mps[robot::kLeft] == Approx(0).margin(1e-3));
}

TEST_CASE("An incline that needs more than the motors have is not climbed") {
  // m g sin a of 15 kg on 20 degrees: 50.3 N, 25.2 N for each track
  const double slope = -20 * std::numbers::pi / 180;
  const auto climbed_m = [slope](double max_force_n) {
    World world(ground(1, slope), {}, 1);
    RobotDescription robot = plain_tracks(1.3);
    robot.drive.max_force_n = max_force_n;
    const Pose X_WP{Eigen::Vector3d::Zero(), rotation_from({0, slope, 0})};
    const RobotId id = world.add_robot(robot, "a", compose(X_WP, {{0, 0, 0.09}, Eigen::Quaterniond::Identity()}));
    world.set_command(id, drive(0.1, 0.1));
    run(world, 2);
    return (X_WP.q.conjugate() * world.truth(id).X_WB.p).x();
  };
  CHECK(climbed_m(20) < 0);
  // 40 N at standstill fall to 32 N at 0.1 of 0.5 m/s: enough
  CHECK(climbed_m(40) == Approx(0.195).margin(0.01));
}

TEST_CASE("With its front flippers up Kenaf climbs steps of 100 and 200 mm, at half the time step alike", "[long]") {
  for (const int height_mm : {100, 200}) {
    std::vector<std::string> unsupported;
    const WorldDescription step = load_world("step-" + std::to_string(height_mm), unsupported);
    std::array<double, 2> x{};
    for (std::size_t half = 0; half < 2; ++half) {
      World world(step, {.time_step_s = half ? 0.0005 : 0.001}, 1);
      const RobotId id = world.add_robot(load_robot("kenaf"), "a", {});
      world.set_command(id, drive(0, 0, 0.8, 0));
      run(world, 1);
      world.set_command(id, drive(0.2, 0.2, 0.8, 0));
      run(world, 10);
      const Eigen::Vector3d p = world.truth(id).X_WB.p;
      CHECK(p.z() == Approx(0.09 + height_mm * 1e-3).margin(1e-3));
      CHECK(std::abs(p.y()) < 0.03);
      x[half] = p.x();
    }
    CHECK(x[0] > 1.5);
    CHECK(x[1] == Approx(x[0]).margin(0.01));
  }
}

TEST_CASE("Without flippers and with little friction Kenaf climbs no step") {
  // To raise the nose the front needs mu N1 > W / 2 on the step's face, and N1 <= mu (W - mu N1) is all that the
  // ground gives: mu^2 / (1 + mu^2) > 1 / 2, mu > 1. A friction of 0.6 is far below.
  std::vector<std::string> unsupported;
  World world(load_world("step-100", unsupported), {}, 1);
  const RobotId id = world.add_robot(plain_tracks(0.6), "a", {});
  world.set_command(id, drive(0.2, 0.2));
  run(world, 10);
  // the front stands at the face: 1 m less the track's 0.29 m
  CHECK(world.truth(id).X_WB.p.x() == Approx(0.71).margin(0.01));
  CHECK(world.truth(id).X_WB.p.z() == Approx(0.09).margin(0.005));
}

namespace {

// A pole of 8 mm radius and 1 m height with twelve sides, on the ground.
TriangleMesh pole(double x_m, double y_m) {
  constexpr std::uint32_t kSides = 12;
  TriangleMesh mesh;
  for (const double z_m : {0.0, 1.0})
    for (std::uint32_t i = 0; i < kSides; ++i) {
      const double angle = 2 * std::numbers::pi * i / kSides;
      mesh.vertices_W.emplace_back(x_m + 0.008 * std::cos(angle), y_m + 0.008 * std::sin(angle), z_m);
    }
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const std::uint32_t j = (i + 1) % kSides;
    mesh.triangles.push_back({i, j, kSides + j});
    mesh.triangles.push_back({i, kSides + j, kSides + i});
  }
  return mesh;
}

}  // namespace

TEST_CASE("Poles that are narrower than the distance of a belt's slices stop the robot") {
  // before each track, from 3 to 19 mm beside its middle; the slices are at 0 and 22.5 mm
  const RobotDescription kenaf = load_robot("kenaf");
  const TrackDescription& track = kenaf.track.front();
  REQUIRE(track.width_m == Approx(0.09));
  REQUIRE(track.p_BT_m.x() + track.length_m / 2 == Approx(0.29));
  const double y_m = track.p_BT_m.y() + 0.011, x_m = 0.6;
  WorldDescription world = ground();
  const auto end_m = [&] {
    World driven(world, {}, 1);
    const RobotId id = driven.add_robot(kenaf, "robot", {});
    driven.set_command(id, drive(0.2, 0.2));
    run(driven, 4);
    return driven.truth(id).X_WB.p.x();
  };
  CHECK(end_m() > 0.7);
  world.meshes = {pole(x_m, y_m), pole(x_m, -y_m)};
  // Level, its belts' ends reach the poles at x_m - 0.008 - 0.29 = 0.302 m; there it rears up by its belts' friction,
  // by 0.55 rad, which lets its middle come nearer by 0.29 (1 - cos 0.55) = 0.043 m at most.
  CHECK(end_m() > 0.29);
  CHECK(end_m() < 0.302 + 0.05);
}
