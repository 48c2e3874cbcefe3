// A snapshot holds the world as it is at that moment. Poses of robots and boxes are compared with the world's own, also
// after some came, went or moved. A robot with a fault stays where it last was whole.
#include <catch2/catch.hpp>

#include <functional>

#include "tests/camera/scenes.hpp"

using namespace kenaf;
using namespace kenaf::camera;
namespace physics = kenaf::physics;

TEST_CASE("Robots, belts, arms, camera mounts and boxes are where the world has them") {
  physics::WorldDescription description = level_ground();
  description.boxes.push_back({"wall", {0.2, 2, 1}, pose(3, 0, 0.5), 1, 0});
  description.boxes.push_back({"parcel", {0.2, 0.2, 0.2}, pose(2, 1, 0.1), 1, 1});
  physics::World world(description, {}, 1);
  const physics::RobotId id = world.add_robot(physics::load_robot("kenaf"), "R1", pose(0, 0, 0.1));
  robot::Command command;
  command.track_speed_mps = {0.2, 0.2};
  world.set_command(id, command);
  world.set_mission_link(id, 0, 0, 0.5);
  for (int i = 0; i < 500; ++i) world.step();

  SnapshotTaker taker;
  WorldSnapshot snapshot;
  taker.take(world, snapshot);
  const physics::RobotTruth truth = world.truth(id);
  CHECK(snapshot.time_s == world.time_s());
  REQUIRE(snapshot.robots.size() == 1);
  const RobotSnapshot& robot = snapshot.robots[0];
  CHECK(robot.name == "R1");
  CHECK(robot.X_WB.p == truth.X_WB.p);
  CHECK(robot.flipper_rad == truth.flipper_rad);
  CHECK(robot.track_m == truth.track_m);
  CHECK(robot.track_m[0] > 0.05);
  CHECK(robot.mission_link_rad[0][0] == Approx(0.5));
  REQUIRE(snapshot.boxes.size() == 2);
  CHECK(snapshot.boxes[0].fixed);
  CHECK_FALSE(snapshot.boxes[1].fixed);
  CHECK(snapshot.boxes[1].size_m == Eigen::Vector3d(0.2, 0.2, 0.2));
  CHECK((snapshot.boxes[1].X_WBox.p - Eigen::Vector3d(2, 1, 0.1)).norm() < 1e-3);  // it has settled
}

TEST_CASE("The next snapshot has what came and what moved, and not what went, descriptions are shared") {
  physics::World world(level_ground(), {}, 1);
  const physics::RobotDescription kenaf = physics::load_robot("kenaf");
  const physics::RobotId first = world.add_robot(kenaf, "first", pose(0, 0, 0.1));
  const physics::BoxId box = world.add_box({"box", {1, 1, 1}, pose(5, 0, 0.5), 1, 0});
  SnapshotTaker taker;
  WorldSnapshot before, after;
  taker.take(world, before);
  const physics::RobotId second = world.add_robot(kenaf, "second", pose(2, 0, 0.1));
  world.move_box(box, pose(6, 0, 0.5));
  taker.take(world, after);
  REQUIRE(after.robots.size() == 2);
  CHECK(after.robots[0].description == before.robots[0].description);
  CHECK(after.boxes[0].X_WBox.p.x() == Approx(6));
  world.remove_robot(first);
  world.remove_box(box);
  taker.take(world, after);
  REQUIRE(after.robots.size() == 1);
  CHECK(after.robots[0].id == second);
  CHECK(after.boxes.empty());
  CHECK(before.robots[0].description->name == "kenaf");  // a snapshot outlives the robot
}

TEST_CASE("A robot with a fault is shown where it last was whole") {
  physics::WorldDescription pit;
  pit.boxes.push_back({"floor", {4, 4, 1}, pose(0, 0, -0.5), 1, 0});
  physics::World world(pit, {}, 1);
  const physics::RobotId lost = world.add_robot(physics::load_robot("kenaf"), "lost", pose(10, 0, 0));
  for (int i = 0; i < 4600; ++i) world.step();  // 100 m of falling take 4.516 s
  REQUIRE_FALSE(world.fault(lost).empty());
  WorldSnapshot snapshot;
  SnapshotTaker().take(world, snapshot);
  CHECK(snapshot.robots[0].X_WB.p.z() == Approx(-100).margin(0.1));
  Scene scene(world.description());
  scene.update(snapshot);
  const RobotSnapshot& robot = snapshot.robots[0];
  const Picture above = picture_of(scene, camera_view(robot, *find_camera(*robot.description, "BirdsEye"), 1.4));
  // its hull, yellow, below the middle
  const std::uint8_t* rgb = above.at(320, 400);
  CHECK(rgb[0] > 2 * rgb[2]);
}

TEST_CASE("Two snapshots look alike unless something came, went, or moved by more than 10 um or 10 urad") {
  physics::World world(level_ground(), {}, 1);
  world.add_robot(physics::load_robot("kenaf"), "R1", pose(0, 0, 0.1));
  const physics::BoxId box = world.add_box({"box", {1, 1, 1}, pose(5, 0, 0.5), 1, 0});
  SnapshotTaker taker;
  WorldSnapshot before;
  taker.take(world, before);
  WorldSnapshot after = before;
  after.time_s += 1;
  CHECK(look_alike(before, after));

  // each part by less than the limit, and by more
  const std::vector<std::function<void(double)>> moves{
      [&](double by) { after.robots[0].X_WB.p.z() += by; },
      [&](double by) {
        after.robots[0].X_WB.q = after.robots[0].X_WB.q * Eigen::AngleAxisd(by, Eigen::Vector3d::UnitX());
      },
      [&](double by) { after.robots[0].flipper_rad[3] += by; },
      [&](double by) { after.robots[0].track_m[1] -= by; },
      [&](double by) { after.robots[0].mission_link_rad[0][1] += by; },
      [&](double by) { after.boxes[0].X_WBox.p.x() -= by; },
  };
  for (const auto& move : moves) {
    after = before;
    move(0.9e-5);
    CHECK(look_alike(before, after));
    after = before;
    move(1.1e-5);
    CHECK_FALSE(look_alike(before, after));
  }

  world.remove_box(box);
  taker.take(world, after);
  CHECK_FALSE(look_alike(before, after));
  CHECK_FALSE(look_alike(after, before));
}
