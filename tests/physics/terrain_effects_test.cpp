// Effects of the terrain stage on a world's geometry and gravity.
#include <catch2/catch.hpp>

#include "physics/terrain_effects.hpp"
#include "tests/physics/scenes.hpp"

using namespace kenaf::physics;

namespace {

double top_of(const Box& box) {
  return box.X_WBox.p.z() + box.size_m.z() / 2;
}
double bottom_of(const Box& box) {
  return box.X_WBox.p.z() - box.size_m.z() / 2;
}
double front_of(const Box& box) {
  return box.X_WBox.p.x() - box.size_m.x() / 2;
}

}  // namespace

TEST_CASE("Obstacle height: a step's top rises, its foot stays, and never goes below the foot") {
  WorldDescription world = ground();
  world.boxes.push_back(fixed_box({1, 2, 0.03}, {1.5, 0, 0.015}));
  const Box higher = with_terrain_effects(world, {.obstacle_height_m = 0.02}).boxes[0];
  CHECK(top_of(higher) == Approx(0.05));
  CHECK(bottom_of(higher) == Approx(0).margin(1e-12));
  CHECK(front_of(higher) == 1);
  const Box gone = with_terrain_effects(world, {.obstacle_height_m = -0.05}).boxes[0];
  CHECK(top_of(gone) == Approx(0.001));
  CHECK(bottom_of(gone) == Approx(0).margin(1e-12));
}

TEST_CASE("Obstacle height: a ramp's face rises straight up, and lies as steep as before") {
  const double steep = 0.4;
  WorldDescription world = ground();
  world.boxes.push_back({"ramp", {1, 1, 0.1}, {{2, 0, 0.2}, rotation_from({0, -steep, 0})}, 1, 0});
  const auto height_at_2m = [](const Box& ramp) {
    const Eigen::Vector3d face_W = ramp.X_WBox.p + ramp.X_WBox.q * Eigen::Vector3d(0, 0, ramp.size_m.z() / 2);
    const Eigen::Vector3d normal = ramp.X_WBox.q * Eigen::Vector3d::UnitZ();
    return face_W.z() - (2 - face_W.x()) * normal.x() / normal.z();
  };
  const Box higher = with_terrain_effects(world, {.obstacle_height_m = 0.03}).boxes[0];
  CHECK(height_at_2m(higher) - height_at_2m(world.boxes[0]) == Approx(0.03));
  CHECK(higher.X_WBox.q.coeffs() == world.boxes[0].X_WBox.q.coeffs());
}

TEST_CASE("Obstacle position: of a trench the far side moves, not the one with the start") {
  WorldDescription world = ground();
  world.start_poses[0].X_WB.p = {0, 0, 0.5};
  world.boxes.push_back(fixed_box({2, 2, 0.5}, {-0.2, 0, 0.25}));
  world.boxes.push_back(fixed_box({2, 2, 0.5}, {2.1, 0, 0.25}));
  const WorldDescription wider = with_terrain_effects(world, {.obstacle_height_m = 0.01, .obstacle_position_m = 0.05});
  CHECK(wider.boxes[0].X_WBox.p == world.boxes[0].X_WBox.p);
  CHECK(wider.boxes[0].size_m == world.boxes[0].size_m);
  CHECK(front_of(wider.boxes[1]) == Approx(1.15));
  CHECK(top_of(wider.boxes[1]) == Approx(0.51));
  CHECK(wider.planes[0].X_WP.p == world.planes[0].X_WP.p);
  // turned about z, the start is outside of the same box's outline
  world.boxes[0] = fixed_box({2, 0.2, 0.5}, {0.5, 0.6, 0.25}, 0);
  CHECK(front_of(with_terrain_effects(world, {.obstacle_position_m = 0.05}).boxes[0]) == Approx(-0.45));
  world.boxes[0] = fixed_box({2, 0.2, 0.5}, {0.5, 0.6, 0.25}, std::atan2(0.6, 0.5));
  CHECK(front_of(with_terrain_effects(world, {.obstacle_position_m = 0.05}).boxes[0]) == Approx(-0.5));
}

TEST_CASE("Obstacles: a mesh keeps its foot, ground under the start keeps all, a loose box moves as a whole") {
  WorldDescription world = ground();
  TriangleMesh hill = roof(0.3);
  for (Eigen::Vector3d& p : hill.vertices_W) p.x() += 4;
  world.meshes = {hill, roof(0.3)};
  world.boxes.push_back(loose_box({0.2, 0.2, 0.2}, {{1, 0, 0.1}, Eigen::Quaterniond::Identity()}, 1, 1));
  const WorldDescription other = with_terrain_effects(world, {.obstacle_height_m = 0.04, .obstacle_position_m = -0.1});
  CHECK(other.meshes[0].vertices_W[0] == Eigen::Vector3d(1.9, -2, 0));
  CHECK(other.meshes[0].vertices_W[1].isApprox(Eigen::Vector3d(3.9, -2, 0.34)));
  CHECK(other.meshes[1].vertices_W == world.meshes[1].vertices_W);
  CHECK(other.boxes[0].size_m == world.boxes[0].size_m);
  CHECK(other.boxes[0].X_WBox.p.isApprox(Eigen::Vector3d(0.9, 0, 0.14)));
  CHECK(with_terrain_effects(world, {.obstacle_height_m = -0.04}).boxes[0].X_WBox.p.z() == 0.1);
}

TEST_CASE("Obstacles: a mesh with a vertical face in line with a start is moved like any other") {
  // a wall of two triangles in the plane y = 0, in which the start at the origin lies, too: seen from above a line
  WorldDescription world = ground();
  TriangleMesh wall;
  wall.vertices_W = {{1, 0, 0}, {3, 0, 0}, {3, 0, 0.2}, {1, 0, 0.2}};
  wall.triangles = {{0, 1, 2}, {0, 2, 3}};
  world.meshes = {wall};
  REQUIRE(world.start_poses.front().X_WB.p.head<2>() == Eigen::Vector2d(0, 0));
  const TriangleMesh moved = with_terrain_effects(world, {.obstacle_position_m = 0.1}).meshes[0];
  CHECK(moved.vertices_W[1] == Eigen::Vector3d(3.1, 0, 0));
  CHECK(with_terrain_effects(world, {.obstacle_height_m = 0.05}).meshes[0].vertices_W[2].z() == Approx(0.25));
}

TEST_CASE("Obstacle position: a robot meets the wall that much later") {
  for (const double shift_m : {-0.1, 0.0, 0.1}) {
    WorldDescription nominal = ground();
    nominal.boxes.push_back(fixed_box({0.1, 2, 1}, {0.65, 0, 0.5}));
    World world(with_terrain_effects(nominal, {.obstacle_position_m = shift_m}), {}, 1);
    const RobotId id = world.add_robot(plain_tracks(0.5), "a", {});
    world.set_command(id, drive(0.2, 0.2));
    run(world, 4);
    // face at 0.6 m, the track's front 0.29 m ahead of the middle
    CHECK(world.truth(id).X_WB.p.x() == Approx(0.31 + shift_m).margin(0.005));
  }
}

TEST_CASE("Ground slope and bank: a robot slides as a block does, ahead and to the right") {
  const auto slid = [](double friction, const Effects& effects) {
    World world(with_terrain_effects(ground(), effects), {}, 1);
    const RobotId id = world.add_robot(plain_tracks(friction), "a", {});
    const Eigen::Vector3d start = world.truth(id).X_WB.p;
    run(world, 1);
    return Eigen::Vector3d(world.truth(id).X_WB.p - start);
  };
  // tan 0.2 = 0.203
  for (const double sign : {1.0, -1.0}) {
    const double s_m = kGravity * (std::sin(0.2) - 0.1 * std::cos(0.2)) / 2;
    CHECK(slid(0.1, {.ground_slope_rad = 0.2 * sign}).x() == Approx(sign * s_m).epsilon(0.03));
    CHECK(slid(0.1, {.ground_bank_rad = 0.2 * sign}).y() == Approx(-sign * s_m).epsilon(0.03));
  }
  CHECK(slid(0.25, {.ground_slope_rad = 0.2}).norm() < 1e-3);
  CHECK(slid(0.25, {.ground_bank_rad = 0.2}).norm() < 1e-3);
}

TEST_CASE("Ground slope: gravity keeps its strength, and without a slope its bits") {
  WorldDescription world = ground();
  world.gravity_W_mps2 = {0.1, 0.2, -9};
  const Eigen::Vector3d g =
      with_terrain_effects(world, {.ground_slope_rad = 0.1, .ground_bank_rad = -0.2}).gravity_W_mps2;
  CHECK(g.norm() == Approx(world.gravity_W_mps2.norm()));
  CHECK(with_terrain_effects(world, {.obstacle_height_m = 0.01}).gravity_W_mps2 == world.gravity_W_mps2);
}
