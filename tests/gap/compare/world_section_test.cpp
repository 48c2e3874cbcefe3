// The section of a world by a vertical plane along x.
#include "gap/compare/world_section.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::compare;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

const Vector2d kLow(-3, -1), kHigh(5, 2);

bool has_corner(const std::vector<Vector2d>& outline, double x, double z) {
  return std::ranges::any_of(outline, [&](const Vector2d& p) { return (p - Vector2d(x, z)).norm() < 1e-9; });
}

}  // namespace

TEST_CASE("Level ground fills what lies below 0, the step's box stands where its file says") {
  std::vector<std::string> unsupported;
  const WorldSection section = world_section(physics::load_world("step-200", unsupported), 0, kLow, kHigh);
  REQUIRE(section.solids.size() == 2);
  for (const auto& [x, z] : {std::pair{-3, -1}, {5, -1}, {5, 0}, {-3, 0}}) CHECK(has_corner(section.solids[0], x, z));
  // share/worlds/step-200.sdf: front face at x = 1 m, 3 m deep, 200 mm high
  REQUIRE(section.solids[1].size() == 4);
  for (const auto& [x, z] : {std::pair{1.0, 0.0}, {4.0, 0.0}, {4.0, 0.2}, {1.0, 0.2}})
    CHECK(has_corner(section.solids[1], x, z));
  CHECK(section.surfaces.empty());
}

TEST_CASE("Beside a box there is no section of it, and boxes that can move are left out") {
  physics::WorldDescription world;
  world.boxes.push_back({"fixed", Vector3d(1, 1, 1), {}, 1, 0});
  world.boxes.push_back({"loose", Vector3d(1, 1, 1), {}, 1, 5});
  CHECK(world_section(world, 0, kLow, kHigh).solids.size() == 1);
  CHECK(world_section(world, 0.6, kLow, kHigh).solids.empty());
}

TEST_CASE("A box turned by 45 degrees about z is cut along its diagonal") {
  physics::WorldDescription world;
  const Eigen::Quaterniond q(Eigen::AngleAxisd(std::numbers::pi / 4, Vector3d::UnitZ()));
  world.boxes.push_back({"box", Vector3d(1, 1, 0.5), {Vector3d::Zero(), q}, 1, 0});
  const auto solids = world_section(world, 1e-12, kLow, kHigh).solids;
  REQUIRE(solids.size() == 1);
  CHECK(has_corner(solids[0], std::sqrt(0.5), 0.25));
  CHECK(has_corner(solids[0], -std::sqrt(0.5), -0.25));
}

TEST_CASE("A slope of 45 degrees through the origin rises with x") {
  physics::WorldDescription world;
  // nose down by -45 degrees: the plane's x axis points up
  const Eigen::Quaterniond q(Eigen::AngleAxisd(-std::numbers::pi / 4, Vector3d::UnitY()));
  world.planes.push_back({{Vector3d::Zero(), q}, 1});
  const auto solids = world_section(world, 0, kLow, kHigh).solids;
  REQUIRE(solids.size() == 1);
  CHECK(has_corner(solids[0], -1, -1));
  CHECK(has_corner(solids[0], 2, 2));
  CHECK(has_corner(solids[0], 5, 2));
  CHECK(has_corner(solids[0], 5, -1));
}

TEST_CASE("A mesh is cut triangle by triangle") {
  physics::WorldDescription world;
  world.meshes.push_back({"roof", {{0, -1, 0}, {0, 1, 0}, {1, 0, 1}, {9, 5, 0}, {9, 6, 0}}, {{0, 1, 2}, {2, 3, 4}}, 1});
  const auto surfaces = world_section(world, 0.0, kLow, kHigh).surfaces;
  REQUIRE(surfaces.size() >= 1);
  const std::vector<Vector2d> ends{surfaces[0].first, surfaces[0].second};
  CHECK(has_corner(ends, 0, 0));
  CHECK(has_corner(ends, 1, 1));
}
