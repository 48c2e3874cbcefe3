// Where a robot touches, and with what force: Newton's second law for the sum, his third between two robots, and
// Coulomb's for one that slides.
#include <catch2/catch.hpp>

#include "tests/physics/scenes.hpp"

using namespace kenaf;
using namespace kenaf::physics;

namespace {

constexpr double kMass_kg = 20;                    // Kenaf: body 15, four flippers of 1.25
constexpr double kWeight_n = kMass_kg * kGravity;  // 196.133
constexpr double kStill_n = 1e-4 * kWeight_n;      // what is left of its settling after the waits below

Eigen::Vector3d sum_n(const std::vector<ContactPoint>& points) {
  Eigen::Vector3d sum(0, 0, 0);
  for (const ContactPoint& point : points) sum += point.force_W_n;
  return sum;
}

Eigen::Vector3d sum_n(const std::vector<ContactPoint>& points, TouchingPart part) {
  Eigen::Vector3d sum(0, 0, 0);
  for (const ContactPoint& point : points)
    if (point.part == part) sum += point.force_W_n;
  return sum;
}

std::vector<ContactPoint> contacts_of(const World& world, RobotId robot) {
  std::vector<ContactPoint> points;
  world.contacts(robot, points);
  return points;
}

Pose at(double x_m, double y_m, double z_m) {
  return {{x_m, y_m, z_m}, Eigen::Quaterniond::Identity()};
}

}  // namespace

TEST_CASE("A standing robot's contacts carry its weight, half on each track, where the tracks are") {
  World world(ground(), {}, 1);
  const RobotId robot = world.add_robot(load_robot("kenaf"), "robot", at(0, 0, 0.1));
  CHECK(contacts_of(world, robot).empty());
  run(world, 2);
  const std::vector<ContactPoint> points = contacts_of(world, robot);
  CHECK((sum_n(points) - Eigen::Vector3d(0, 0, kWeight_n)).norm() < kStill_n);
  CHECK(sum_n(points, TouchingPart::left_track).z() == Approx(kWeight_n / 2).epsilon(1e-3));
  CHECK(sum_n(points, TouchingPart::right_track).z() == Approx(kWeight_n / 2).epsilon(1e-3));
  // 0.58 m by 0.09 m at y = 0.10 m, with end wheels of 65 mm
  Eigen::Vector3d moment_nm(0, 0, 0);
  for (const ContactPoint& point : points) {
    CHECK(std::abs(point.p_W.z()) < 1e-3);
    CHECK(std::abs(point.p_W.x() - world.truth(robot).X_WB.p.x()) < 0.58 / 2 - 0.065 + 1e-6);
    CHECK(std::abs(std::abs(point.p_W.y()) - 0.10) < 0.045 + 1e-3);
    CHECK((point.p_W.y() > 0) == (point.part == TouchingPart::left_track));
    moment_nm += point.p_W.cross(point.force_W_n);
  }
  // the centre of mass, of body and raised flippers, is over the robot's middle
  CHECK(moment_nm.x() == Approx(0).margin(1e-3 * kWeight_n));
}

TEST_CASE("On a slope pressure and friction together carry the weight, straight up") {
  constexpr double kSlope_rad = 0.25;
  World world(ground(1, kSlope_rad), {}, 1);
  const RobotId robot = world.add_robot(load_robot("kenaf"), "robot", {{0, 0, 0.2}, rotation_from({0, kSlope_rad, 0})});
  run(world, 3);
  const Eigen::Vector3d sum = sum_n(contacts_of(world, robot));
  CHECK((sum - Eigen::Vector3d(0, 0, kWeight_n)).norm() < 10 * kStill_n);  // friction creeps
}

TEST_CASE("A robot on its flippers has its weight on them") {
  World world(ground(), {}, 1);
  const RobotId robot = world.add_robot(load_robot("kenaf"), "robot", at(0, 0, 0.1));
  world.set_command(robot, drive(0, 0, -1, -1));
  run(world, 6);
  const std::vector<ContactPoint> points = contacts_of(world, robot);
  for (const TouchingPart part : {TouchingPart::front_left_flipper, TouchingPart::front_right_flipper,
                                  TouchingPart::rear_left_flipper, TouchingPart::rear_right_flipper})
    CHECK(sum_n(points, part).z() == Approx(kWeight_n / 4).epsilon(0.02));
  CHECK(sum_n(points, TouchingPart::left_track).norm() == 0);
  CHECK(sum_n(points, TouchingPart::body).norm() == 0);
  CHECK((sum_n(points) - Eigen::Vector3d(0, 0, kWeight_n)).norm() < 10 * kStill_n);
}

TEST_CASE("A robot that slides is braked by mu times its weight") {
  constexpr double kMu = 0.1;
  World world(ground(), {}, 1);
  RobotDescription description = load_robot("kenaf");
  description.track.front().friction_along = description.track.front().friction_across = kMu;
  description.track.front().lug_height_m = 0;
  const RobotId robot = world.add_robot(description, "robot", at(0, 0, 0.1));
  run(world, 1);
  const robot::Command stand = drive(0, 0);
  world.set_command(robot, stand);
  world.set_in_motion(robot, {.v_WB_mps = {0.4, 0, 0}}, stand);
  run(world, 0.2);  // it stops after v / (mu g) = 0.41 s
  const Eigen::Vector3d sum = sum_n(contacts_of(world, robot));
  CHECK(sum.x() == Approx(-kMu * sum.z()).epsilon(1e-3));
  CHECK(sum.z() == Approx(kWeight_n).epsilon(0.01));  // it nods a little
}

TEST_CASE("Two robots push on each other with opposite forces, at the same points") {
  World world(ground(), {}, 1);
  const RobotDescription kenaf = load_robot("kenaf");
  const RobotId below = world.add_robot(kenaf, "below", at(0, 0, 0.1));
  const RobotId above = world.add_robot(kenaf, "above", at(0, 0, 0.4));
  run(world, 4);
  const std::vector<ContactPoint> under = contacts_of(world, below), over = contacts_of(world, above);
  REQUIRE_FALSE(over.empty());
  // the upper one touches nothing but the lower one
  CHECK((sum_n(over) - Eigen::Vector3d(0, 0, kWeight_n)).norm() < 0.01 * kWeight_n);
  std::size_t met = 0;
  for (const ContactPoint& point : over)
    for (const ContactPoint& other : under)
      if (point.p_W == other.p_W && point.force_W_n == -other.force_W_n) ++met;
  CHECK(met == over.size());
  CHECK((sum_n(under) - Eigen::Vector3d(0, 0, kWeight_n)).norm() < 0.01 * kWeight_n);
}

TEST_CASE("A robot in the air, one that was moved and a new world's have no contacts") {
  World world(ground(), {}, 1);
  const RobotId robot = world.add_robot(load_robot("kenaf"), "robot", at(0, 0, 0.1));
  run(world, 0.5);
  CHECK_FALSE(contacts_of(world, robot).empty());
  world.teleport(robot, at(0, 0, 1));
  CHECK(contacts_of(world, robot).empty());
  run(world, 0.1);  // still falling: 0.45 s to the ground
  CHECK(contacts_of(world, robot).empty());
  run(world, 2);
  CHECK_FALSE(contacts_of(world, robot).empty());
  world.reset();
  CHECK(contacts_of(world, robot).empty());
  std::vector<ContactPoint> points(3);
  CHECK_THROWS_AS(world.contacts(RobotId{99}, points), std::out_of_range);
}
