// Effects of the contact stage, and the two of the ground that act in the same contacts: its give and its damping.
#include <catch2/catch.hpp>

#include "physics/terrain_effects.hpp"
#include "tests/physics/scenes.hpp"

using namespace kenaf;
using namespace kenaf::physics;

namespace {

constexpr double kFriction = 0.8;

RobotDescription tracks_with(const Effects& effects) {
  RobotDescription robot = plain_tracks(kFriction);
  robot.effects = effects;
  return robot;
}

// Where a robot without commands has got to after `time_s` on ground that gravity is turned against.
Eigen::Vector3d slid_m(const RobotDescription& robot, const WorldDescription& flat, double slope_rad, double bank_rad,
                       double time_s) {
  World world(with_terrain_effects(flat, {.ground_slope_rad = slope_rad, .ground_bank_rad = bank_rad}), {}, 1);
  const RobotId id = world.add_robot(robot, "a", {});
  const Eigen::Vector3d start = world.truth(id).X_WB.p;
  run(world, time_s);
  return world.truth(id).X_WB.p - start;
}

// From the body's centre straight down to what the tracks stand on.
double belly_below_m() {
  const TrackDescription track = load_robot("kenaf").track.front();
  return track.end_radius_m - track.p_BT_m.z();
}

// s = a t^2 / 2 of a block on a slope; belts that stand still are one.
double block_m(double slope_rad, double friction, double time_s) {
  return kGravity * (std::sin(slope_rad) - friction * std::cos(slope_rad)) * time_s * time_s / 2;
}

RobotTruth driven(const RobotDescription& robot, double mps) {
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(robot, "a", {});
  world.set_command(id, drive(mps, mps));
  run(world, 1);
  return world.truth(id);
}

}  // namespace

// 3 %: the robot first tips onto its lower contacts, and the time step is 1/500 of the time.
TEST_CASE("Friction along and across: each scales its own direction, and the other keeps what it had") {
  const double slope = 0.5, t = 0.5;  // tan 0.5 = 0.55: less than 0.8, more than half of it
  const Effects half_along{.friction_along_scale = 0.5}, half_across{.friction_across_scale = 0.5};
  const double half_m = block_m(slope, kFriction / 2, t);
  CHECK(slid_m(tracks_with(half_along), ground(), slope, 0, t).x() == Approx(half_m).epsilon(0.03));
  CHECK(slid_m(tracks_with(half_across), ground(), 0, slope, t).y() == Approx(-half_m).epsilon(0.03));
  CHECK(slid_m(tracks_with(half_across), ground(), slope, 0, t).norm() < 1e-3);
  CHECK(slid_m(tracks_with(half_along), ground(), 0, slope, t).norm() < 1e-3);
  // more friction holds where nominal friction does not: tan 0.75 = 0.93 lies between 0.8 and 1.2
  CHECK(slid_m(tracks_with({}), ground(), 0.75, 0, t).x() > 0.5 * block_m(0.75, kFriction, t));
  CHECK(slid_m(tracks_with({.friction_along_scale = 1.5}), ground(), 0.75, 0, t).norm() < 1e-3);
}

TEST_CASE("Friction asymmetry, along: belts that spin push with what their own side holds") {
  // From rest the belts are at 0.4 m/s after some milliseconds, the robot at 0.1 m/s² times the time: they spin. Each
  // bears half of the robot.
  RobotDescription robot = tracks_with({.friction_asymmetry = 0.6});
  robot.track.front().friction_along = robot.track.front().friction_across = 0.1;
  robot.drive.time_constant_s = 0;
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(robot, "a", {});
  run(world, 0.5);
  world.set_command(id, drive(0.4, 0.4));
  run(world, 0.1);
  const double each_n = 0.1 * 15 * kGravity / 2;
  CHECK(world.truth(id).track_force_n[robot::kLeft] == Approx(1.3 * each_n).epsilon(0.02));
  CHECK(world.truth(id).track_force_n[robot::kRight] == Approx(0.7 * each_n).epsilon(0.02));
  CHECK(world.truth(id).w_WB_radps.z() < 0);  // the left side pushes more
}

TEST_CASE("Friction asymmetry, across: a robot that lies on one side more slides as that side's belt lets it") {
  // The centre of mass at the ground and off to the left by c: loads do not change as it slides. On four lines of
  // springs at y = (+-b +-w) / 2 the load is linear in y, so that the left two bear 1/2 + b c / (b² + w²) of it.
  RobotDescription robot = tracks_with({});
  robot.body.p_BBcm_m = Eigen::Vector3d(0, 0.05, -belly_below_m());
  const double b = robot.track_gauge_m(), w = robot.track.front().width_m, left = 0.5 + b * 0.05 / (b * b + w * w);
  const double slope = 0.9, t = 0.4;
  for (const double ratio : {0.0, 0.8, -0.8}) {
    robot.effects.friction_asymmetry = ratio;
    const double friction = kFriction * ((1 + ratio / 2) * left + (1 - ratio / 2) * (1 - left));
    CHECK(slid_m(robot, ground(), 0, slope, t).y() == Approx(-block_m(slope, friction, t)).epsilon(0.03));
  }
}

TEST_CASE("Slip with speed: a belt at u carries the robot with u (1 - slip |u|), either way, and reports u") {
  for (const double u : {0.1, 0.2, 0.4, -0.4}) {
    const RobotTruth truth = driven(tracks_with({.slip_with_speed_spm = 0.5}), u);
    CHECK(truth.track_mps[robot::kLeft] == Approx(u).epsilon(1e-3));
    CHECK(truth.v_WB_mps.x() == Approx(u * (1 - 0.5 * std::abs(u))).epsilon(2e-3));
  }
}

TEST_CASE("Rolling resistance: a motor gives that share of the weight, and none for a belt in the air") {
  RobotDescription robot = tracks_with({.rolling_resistance = 0.1});
  // 15 kg on two tracks
  CHECK(driven(robot, 0.2).track_force_n[robot::kLeft] + driven(robot, 0.2).track_force_n[robot::kRight] ==
        Approx(0.1 * 15 * kGravity).epsilon(0.01));
  WorldDescription empty;
  empty.gravity_W_mps2.setZero();
  World world(empty, {}, 1);
  const RobotId id = world.add_robot(robot, "a", {});
  world.set_command(id, drive(0.2, 0.2));
  run(world, 1);
  CHECK(std::abs(world.truth(id).track_force_n[robot::kLeft]) < 0.01);
}

TEST_CASE("Rolling resistance: with motors without force a robot rolls where the slope is steeper than it") {
  const auto rolled_m = [](double coefficient, double slope_rad) {
    RobotDescription robot = tracks_with({.rolling_resistance = coefficient});
    robot.drive.max_force_n = 1e-6;
    return slid_m(robot, ground(), slope_rad, 0, 1).x();
  };
  CHECK(rolled_m(0.12, 0.1) < 1e-3);
  // both belts of 1.5 kg go with the robot of 15 kg
  CHECK(rolled_m(0.05, 0.1) == Approx(block_m(0.1, 0.05, 1) * 15 / 18).epsilon(0.03));
  CHECK(rolled_m(0, 0.1) == Approx(block_m(0.1, 0, 1) * 15 / 18).epsilon(0.03));
}

// The belly lies across two ridges, so that all it touches are edges. A lug of height h behind an edge rounded by 10 mm
// holds up to the friction angle plus acos(1 - h / 10 mm).
TEST_CASE("Lug height: on edges a belt holds up to the friction angle and the lug's own, on faces lugs do nothing") {
  WorldDescription ridges;
  ridges.start_poses.push_back({"start", {}});
  for (const double x : {-0.15, 0.15})
    ridges.boxes.push_back(
        {"ridge",
         {0.1, 2, 0.1},
         {{x, 0, -belly_below_m() - 0.1 / std::numbers::sqrt2}, rotation_from({0, std::numbers::pi / 4, 0})},
         1,
         0});
  const auto moved_m = [&](double lug_scale, double slope_rad, const WorldDescription& on) {
    RobotDescription robot = tracks_with({.lug_height_scale = lug_scale});
    robot.track.front().friction_along = 0.3;
    robot.track.front().lug_height_m = 0.0005;
    return slid_m(robot, on, slope_rad, 0, 0.2).x();
  };
  const double friction_angle = std::atan(0.3);
  for (const double scale : {0.0, 1.0, 3.0}) {
    const double holds_rad = friction_angle + std::acos(1 - scale * 0.0005 / 0.01);
    INFO("scale " << scale << ": holds to " << holds_rad);
    CHECK(moved_m(scale, holds_rad - 0.02, ridges) < 5e-4);
    CHECK(moved_m(scale, holds_rad + 0.1, ridges) > 0.5 * block_m(holds_rad + 0.1, std::tan(holds_rad), 0.2));
  }
  CHECK(moved_m(3, friction_angle - 0.02, ground()) < 5e-4);
  CHECK(moved_m(3, friction_angle + 0.1, ground()) == Approx(moved_m(1, friction_angle + 0.1, ground())).epsilon(1e-9));
}

// The same ridges along the robot, one under each belt (not under its middle, where a slice would be in the edge and
// see the ridge's two faces): nothing for a lug to catch behind, so that the belts hold up to the friction angle alone,
// and beyond it slide as a block does.
TEST_CASE("Lug height: on edges along the belt lugs do nothing") {
  RobotDescription robot = tracks_with({.lug_height_scale = 3});
  robot.track.front().friction_along = 0.3;
  robot.track.front().lug_height_m = 0.0005;
  WorldDescription ridges;
  ridges.start_poses.push_back({"start", {}});
  for (const double y : {-0.45 * robot.track_gauge_m(), 0.45 * robot.track_gauge_m()})
    ridges.boxes.push_back(
        {"ridge",
         {2, 0.1, 0.1},
         {{0, y, -belly_below_m() - 0.1 / std::numbers::sqrt2}, rotation_from({std::numbers::pi / 4, 0, 0})},
         1,
         0});
  const double friction_angle = std::atan(0.3);
  CHECK(slid_m(robot, ridges, friction_angle - 0.02, 0, 0.2).x() < 1e-3);
  CHECK(slid_m(robot, ridges, friction_angle + 0.1, 0, 0.4).x() ==
        Approx(block_m(friction_angle + 0.1, 0.3, 0.4)).epsilon(0.03));
}

// All contacts are springs k with dampers d beside them: whatever bears whatever, what is left of the way down shrinks
// as exp(-t k / d). Mass does not matter: 15 kg / (24 contacts x 20 kN s/m) is 30 microseconds.
TEST_CASE("Ground compliance and damping: how deep a robot sinks, and how fast") {
  const auto depths_m = [](const Effects& effects, double a_s, double b_s) {
    World world(ground(), {}, 1);
    const RobotId id = world.add_robot(tracks_with(effects), "a", {{0, 0, 0}, Eigen::Quaterniond::Identity()});
    const auto depth_after = [&](double time_s) {
      run(world, time_s);
      return belly_below_m() - world.truth(id).X_WB.p.z();
    };
    const double at_a = depth_after(a_s), at_b = depth_after(b_s - a_s);
    return std::array{at_a, at_b, depth_after(1.5)};
  };
  const double nominal = depths_m({}, 0.1, 0.2)[2];
  CHECK(nominal > 0);
  for (const double scale : {0.2, 5.0, 50.0})
    CHECK(depths_m({.ground_compliance_scale = scale}, 0.1, 0.2)[2] / nominal == Approx(scale).epsilon(0.03));
  CHECK(depths_m({.ground_damping_scale = 20}, 0.1, 0.2)[2] == Approx(nominal).epsilon(1e-3));
  // k = 200 kN/m, d = 1 kN s/m: 5 ms, multiplied by both scales; implicit steps of 1 ms lag by half a step
  for (const auto& [compliance, damping] : {std::pair{1.0, 20.0}, {5.0, 4.0}, {2.0, 20.0}}) {
    const double tau_s = 0.005 * compliance * damping;
    const auto [a, b, end] =
        depths_m({.ground_compliance_scale = compliance, .ground_damping_scale = damping}, 0.1, 0.1 + tau_s);
    CHECK((end - b) / (end - a) == Approx(std::exp(-1)).epsilon(0.03));
  }
}
