// Where rays meet boxes, hulls, planes and meshes, in numbers that can be read off the shapes; and that in a world
// whose robots drive no ray meets what it passes beside.
#include "physics/dynamics/rays.hpp"

#include <catch2/catch.hpp>

#include "physics/robot_shapes.hpp"
#include "tests/physics/scenes.hpp"

using namespace kenaf::physics;

namespace {

// Rays against a block of 0.2 by 0.4 by 0.6 m, whatever it is made of.
void check_block(const btCollisionShape& shape) {
  const btTransform at(btQuaternion::getIdentity(), btVector3(1, 2, 3));
  const auto meeting = [&](const btVector3& from, const btVector3& to) { return meeting_of({from, to}, shape, at); };
  // from above: its top is at 3.3 m
  const auto top = meeting({1, 2, 5}, {1, 2, -5});
  REQUIRE(top);
  CHECK(top->fraction == Approx(0.17));
  CHECK(top->normal.z() == Approx(1));
  // a micrometre within and beside each of the four sides
  for (const double x : {0.9, 1.1}) {
    const double inward = x < 1 ? 1e-6 : -1e-6;
    CHECK(meeting({x + inward, 2, 5}, {x + inward, 2, -5}));
    CHECK_FALSE(meeting({x - inward, 2, 5}, {x - inward, 2, -5}));
  }
  for (const double y : {1.8, 2.2}) {
    const double inward = y < 2 ? 1e-6 : -1e-6;
    CHECK(meeting({1, y + inward, 5}, {1, y + inward, -5}));
    CHECK_FALSE(meeting({1, y - inward, 5}, {1, y - inward, -5}));
  }
  // aslant, from (2, 2, 3.2) to (0, 2, 3): at x = 1.1 after 0.45 of the way
  const auto side = meeting({2, 2, 3.2}, {0, 2, 3});
  REQUIRE(side);
  CHECK(side->fraction == Approx(0.45));
  CHECK(side->normal.x() == Approx(1));
  // not far enough, away from it, and from inside
  CHECK_FALSE(meeting({1, 2, 5}, {1, 2, 3.31}));
  CHECK_FALSE(meeting({1, 2, 5}, {1, 2, 8}));
  CHECK_FALSE(meeting({1, 2, 3}, {1, 2, -5}));
}

}  // namespace

TEST_CASE("A ray meets a box, a hull and a piece of a compound where their faces are, and passes beside them") {
  check_block(*make_box({0.2, 0.4, 0.6}));
  const auto prism = make_prism({{0.1, -0.3}, {0.1, 0.3}, {-0.1, 0.3}, {-0.1, -0.3}}, 0.4, {0, 0, 0});
  check_block(*prism);
  btCompoundShape compound(false);
  compound.addChildShape(btTransform::getIdentity(), prism.get());
  check_block(compound);
}

TEST_CASE("A ray meets a plane from either side, with the normal towards where it comes from") {
  const btStaticPlaneShape plane({0, 0, 1}, 0.5);
  const auto above = meeting_of({{0, 0, 2}, {0, 0, 0}}, plane, btTransform::getIdentity());
  REQUIRE(above);
  CHECK(above->fraction == Approx(0.75));
  CHECK(above->normal.z() == 1);
  const auto below = meeting_of({{0, 0, 0}, {0, 0, 2}}, plane, btTransform::getIdentity());
  REQUIRE(below);
  CHECK(below->fraction == Approx(0.25));
  CHECK(below->normal.z() == -1);
  CHECK_FALSE(meeting_of({{0, 0, 2}, {1, 0, 2}}, plane, btTransform::getIdentity()));
  CHECK_FALSE(meeting_of({{0, 0, 2}, {0, 0, 0.51}}, plane, btTransform::getIdentity()));
}

TEST_CASE("In a world that steps, rays between posts meet the ground, and those on a post its top") {
  WorldDescription posts = ground();
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      if ((i + j) % 2 == 0) posts.boxes.push_back(fixed_box({0.1, 0.1, 0.1}, {1.05 + 0.1 * i, -0.55 + 0.1 * j, 0.05}));
  World world(posts, {}, 1);
  for (int step = 0; step < 5; ++step) world.step();
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      const auto hit = world.cast_ray({1.05 + 0.1 * i, -0.55 + 0.1 * j, 5}, {0, 0, -1}, 10);
      REQUIRE(hit);
      CHECK(5 - hit->distance_m == Approx((i + j) % 2 == 0 ? 0.1 : 0).margin(1e-12));
    }
  }
}
