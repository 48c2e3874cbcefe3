// A placed or teleported robot is lifted until it is free and then comes to rest, on boxes, meshes and shipped worlds,
// and many robots share one world. Rays, boxes and mission packages are checked against positions known from the
// descriptions. Bad calls are refused, and a body that leaves takes its contacts with it.
#include <catch2/catch.hpp>
#include <limits>

#include "tests/physics/scenes.hpp"

using namespace kenaf;
using namespace kenaf::physics;

TEST_CASE("A robot in the ground is lifted until it is free") {
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(load_robot("kenaf"), "a", {{1, 2, -0.5}, rotation_from({0, 0, 0.5})});
  const RobotTruth truth = world.truth(id);
  // the belly is 0.09 m below its centre
  CHECK(truth.X_WB.p.z() == Approx(0.09).margin(1e-3));
  CHECK(truth.X_WB.p.x() == 1);
  CHECK(truth.X_WB.p.y() == 2);
  CHECK(yaw_of(truth.X_WB) == Approx(0.5));
}

TEST_CASE("A robot in a box is lifted onto it, one in the air stays there") {
  WorldDescription description = ground();
  description.boxes.push_back(fixed_box({2, 2, 0.4}, {0, 0, 0.2}));
  World world(description, {}, 1);
  const RobotId inside = world.add_robot(load_robot("kenaf"), "a", {{0, 0, 0.2}, Eigen::Quaterniond::Identity()});
  CHECK(world.truth(inside).X_WB.p.z() == Approx(0.49).margin(0.03));
  const RobotId above = world.add_robot(load_robot("kenaf"), "b", {{5, 0, 3}, Eigen::Quaterniond::Identity()});
  CHECK(world.truth(above).X_WB.p.z() == 3);
  run(world, 1);
  CHECK(world.truth(inside).X_WB.p.z() == Approx(0.49).margin(1e-3));
}

TEST_CASE("A robot in a box as high as a house is lifted onto it too") {
  WorldDescription description = ground();
  description.boxes.push_back(fixed_box({4, 4, 30}, {0, 0, 15}));
  World world(description, {}, 1);
  const RobotId id = world.add_robot(load_robot("kenaf"), "a", {});
  // its belly is 0.09 m below its centre; the steps of its search there are 0.16 m: 100 of 0.02, 0.04, 0.08 m are 14 m
  CHECK(world.truth(id).X_WB.p.z() > 30.09 - 1e-3);
  CHECK(world.truth(id).X_WB.p.z() < 30.09 + 0.17);
  run(world, 2);
  CHECK(world.truth(id).X_WB.p.z() == Approx(30.09).margin(1e-3));
}

TEST_CASE("A robot dropped from 50 mm comes to rest") {
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(load_robot("kenaf"), "a", {{0, 0, 0.14}, Eigen::Quaterniond::Identity()});
  run(world, 2);
  CHECK(world.truth(id).X_WB.p.z() == Approx(0.09).margin(1e-3));
  CHECK(world.truth(id).v_WB_mps.norm() < 1e-4);
}

TEST_CASE("A robot placed in or deep below a mesh is lifted onto it and stands there") {
  // a floor of triangles at 0.3 m, solid below
  WorldDescription description = ground();
  description.meshes.push_back(
      {"floor", {{-3, -3, 0.3}, {3, -3, 0.3}, {3, 3, 0.3}, {-3, 3, 0.3}}, {{0, 1, 2}, {0, 2, 3}}, 1});
  World world(description, {}, 1);
  const RobotId in = world.add_robot(load_robot("kenaf"), "in", {{0, 1.5, 0.3}, Eigen::Quaterniond::Identity()});
  const RobotId below = world.add_robot(load_robot("kenaf"), "below", {});
  run(world, 1);
  for (const RobotId id : {in, below}) {
    CHECK(world.truth(id).X_WB.p.z() == Approx(0.39).margin(1e-3));
    CHECK(world.truth(id).v_WB_mps.norm() < 1e-3);
    CHECK(std::abs(roll_pitch_yaw(world.truth(id).X_WB.q).y()) < 1e-3);
  }
}

TEST_CASE("A robot stands on shipped hills and rubble") {
  for (const char* name : {"hills", "rubble-mesh"}) {
    std::vector<std::string> unsupported;
    World world(load_world(name, unsupported), {}, 1);
    const double ground_m = 5 - world.cast_ray({3, 0, 5}, {0, 0, -1}, 10)->distance_m;
    const RobotId id = world.add_robot(load_robot("kenaf"), "a", {{3, 0, 0}, Eigen::Quaterniond::Identity()});
    run(world, 3);
    const Pose X_WB = world.truth(id).X_WB;
    INFO(name);
    CHECK((X_WB.p.head<2>() - Eigen::Vector2d(3, 0)).norm() < 0.1);
    // its belly is 0.09 m below its centre, and no bump is higher than 0.2 m
    CHECK(X_WB.p.z() > ground_m + 0.07);
    CHECK(X_WB.p.z() < 0.09 + 0.21);
    CHECK(world.truth(id).v_WB_mps.norm() < 0.01);
  }
}

TEST_CASE("A teleported robot is at rest at its new place") {
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(load_robot("kenaf"), "a", {});
  world.set_command(id, drive(0.3, 0.3));
  run(world, 1);
  world.teleport(id, {{5, 5, 0}, rotation_from({0, 0, 1})});
  CHECK(world.truth(id).v_WB_mps.norm() == 0);
  CHECK(world.truth(id).track_mps[robot::kLeft] == 0);
  CHECK(world.truth(id).X_WB.p.x() == 5);
  world.set_command(id, drive(0, 0));
  run(world, 1);
  CHECK((world.truth(id).X_WB.p - Eigen::Vector3d(5, 5, 0.09)).norm() < 2e-3);
}

TEST_CASE("Sixteen robots in one world go each their own way") {
  std::vector<std::string> unsupported;
  const WorldDescription flat = load_world("flat", unsupported);
  REQUIRE(flat.start_poses.size() == 16);
  World world(flat, {}, 1);
  std::vector<RobotId> ids;
  for (const StartPose& start : flat.start_poses) {
    ids.push_back(world.add_robot(load_robot(ids.size() % 2 ? "p2dx" : "kenaf"), start.name, start.X_WB));
    world.set_command(ids.back(), drive(0.1, 0.1));
  }
  run(world, 2);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const double ahead = world.truth(ids[i]).X_WB.p.x() - flat.start_poses[i].X_WB.p.x();
    CHECK(ahead == Approx(0.19).margin(0.012));
  }
  world.remove_robot(ids[3]);
  CHECK(world.robots().size() == 15);
  CHECK_THROWS_AS(world.truth(ids[3]), std::out_of_range);
  run(world, 0.1);
}

TEST_CASE("Robots that meet do not pass through each other") {
  World world(ground(), {}, 1);
  const RobotId a = world.add_robot(load_robot("p2at"), "a", {});
  const RobotId b = world.add_robot(load_robot("p2at"), "b", {{1, 0, 0}, rotation_from({0, 0, std::numbers::pi})});
  world.set_command(a, drive(0.2, 0.2));
  world.set_command(b, drive(0.2, 0.2));
  run(world, 5);
  CHECK((world.truth(a).X_WB.p - world.truth(b).X_WB.p).norm() > 0.45);
}

TEST_CASE("Rays meet boxes and the ground within their range, and nothing else") {
  WorldDescription description = ground();
  description.boxes.push_back(fixed_box({1, 1, 1}, {3, 0, 0.5}));
  World world(description, {}, 1);
  const auto box = world.cast_ray({0, 0, 0.5}, {2, 0, 0}, 10);
  REQUIRE(box);
  CHECK(box->distance_m == Approx(2.5).margin(2e-3));
  CHECK(box->normal_W.x() == Approx(-1));
  CHECK_FALSE(world.cast_ray({0, 0, 0.5}, {1, 0, 0}, 2));
  CHECK_FALSE(world.cast_ray({0, 0, 0.5}, {0, 0, 1}, 10));
  const auto down = world.cast_ray({0, 0, 0.5}, {0, 0, -1}, 10);
  REQUIRE(down);
  CHECK(down->distance_m == Approx(0.5).margin(1e-6));
  const RobotId id = world.add_robot(load_robot("kenaf"), "a", {{1, 0, 0}, Eigen::Quaterniond::Identity()});
  CHECK(world.cast_ray({0, 0, 0.09}, {1, 0, 0}, 10)->distance_m < 1);
  CHECK(world.cast_ray({0, 0, 0.09}, {1, 0, 0}, 10, id)->distance_m == Approx(2.5).margin(2e-3));
}

TEST_CASE("Rays meet meshes, from either side") {
  WorldDescription description;
  description.meshes.push_back(roof(0.5));
  World world(description, {}, 1);
  // at x = 1 the roof is halfway down from its ridge
  const auto above = world.cast_ray({1, 0.5, 3}, {0, 0, -1}, 10);
  REQUIRE(above);
  CHECK(above->distance_m == Approx(2.75).margin(1e-9));
  CHECK((above->normal_W - Eigen::Vector3d(0.25, 0, 1).normalized()).norm() < 1e-9);
  CHECK(world.cast_ray({1, 0.5, 0}, {0, 0, 1}, 10)->distance_m == Approx(0.25).margin(1e-9));
  CHECK_FALSE(world.cast_ray({3, 0.5, 3}, {0, 0, -1}, 10));
}

TEST_CASE("Boxes come, move and go") {
  World world(ground(), {}, 1);
  const BoxId id = world.add_box(fixed_box({1, 1, 1}, {3, 0, 0.5}));
  CHECK(world.cast_ray({0, 0, 0.5}, {1, 0, 0}, 10));
  world.move_box(id, {{0, 3, 0.5}, Eigen::Quaterniond::Identity()});
  CHECK_FALSE(world.cast_ray({0, 0, 0.5}, {1, 0, 0}, 10));
  CHECK(world.cast_ray({0, 0, 0.5}, {0, 1, 0}, 10)->distance_m == Approx(2.5).margin(2e-3));
  world.remove_box(id);
  CHECK_FALSE(world.cast_ray({0, 0, 0.5}, {0, 1, 0}, 10));
  CHECK_THROWS_AS(world.remove_box(id), std::out_of_range);
}

TEST_CASE("A mission package's links turn at their speed, within their limits") {
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(load_robot("kenaf"), "a", {});
  world.set_mission_link(id, 0, 0, 1.5);
  run(world, 0.5);
  CHECK(world.mission_link_rad(id, 0, 0) == Approx(1.0).margin(1e-6));  // 2 rad/s
  world.set_mission_link(id, 0, 1, -9);
  run(world, 1);
  CHECK(world.mission_link_rad(id, 0, 0) == Approx(1.5));
  CHECK(world.mission_link_rad(id, 0, 1) == Approx(-0.7853981));
}

TEST_CASE("What is no pose, no number or no robot is refused") {
  World world(ground(), {}, 1);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(world.add_robot(load_robot("kenaf"), "a", {{nan, 0, 0}, Eigen::Quaterniond::Identity()}),
                  std::invalid_argument);
  CHECK(world.robots().empty());
  const RobotId id = world.add_robot(load_robot("kenaf"), "a", {});
  world.set_command(id, drive(nan, 0.1));
  run(world, 0.1);
  CHECK(world.truth(id).X_WB.p.allFinite());
  CHECK_THROWS_AS(world.set_command(RobotId{99}, {}), std::out_of_range);
  CHECK_THROWS_AS(World(ground(), {.time_step_s = 0}, 1), std::invalid_argument);
}

TEST_CASE("What leaves takes its contacts with it, before the next step too") {
  World world(ground(), {}, 1);
  const RobotId first = world.add_robot(load_robot("kenaf"), "a", {});
  const BoxId crate = world.add_box(loose_box({0.2, 0.2, 0.2}, {{2, 0, 0.1}, Eigen::Quaterniond::Identity()}, 1, 1));
  run(world, 0.5);
  CHECK(world.contact_count() > 0);
  world.remove_robot(first);
  world.remove_box(crate);
  CHECK(world.contact_count() == 0);
  const RobotId second = world.add_robot(load_robot("kenaf"), "a", {});  // its touch sensor looks at the contacts
  run(world, 0.5);
  CHECK(world.truth(second).X_WB.p.z() == Approx(0.09).margin(1e-3));
}
