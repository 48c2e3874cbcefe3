// The contact points of a belt, their normals and their shares of the belt's length follow from the geometry of two
// discs and their tangents. They are checked on planes, boxes, edges, walls and triangles, where each can be worked out
// by hand.
#include "physics/dynamics/belt_contacts.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

using namespace kenaf::physics;

namespace {

// 400 mm between the discs, radius 50 mm, 80 mm wide.
BeltShape belt(int pieces = 4) {
  return {
      .radius = {0.05, 0.05}, .length = 0.4, .half_width = 0.04, .p_BodyT = {0, 0, 0}, .pieces = pieces, .surface = {}};
}

std::vector<BeltTouch> on_box(const BeltShape& shape, const btVector3& size, const btVector3& center, double yaw = 0) {
  std::vector<BeltTouch> out;
  touch_box(shape, {btMatrix3x3(btQuaternion(btVector3(0, 0, 1), yaw)), center, size / 2}, out);
  return out;
}

double weight_of(const std::vector<BeltTouch>& touches) {
  double sum = 0;
  for (const BeltTouch& touch : touches) sum += touch.weight;
  return sum;
}

}  // namespace

TEST_CASE("On level ground a belt touches along its run, with equal parts of its length behind each point") {
  std::vector<BeltTouch> out;
  touch_plane(belt(), {0, 0, 1}, -0.0499, out);  // pressed in by 0.1 mm
  REQUIRE(out.size() == 10);
  for (const BeltTouch& touch : out) {
    CHECK(touch.gap_m == Approx(-1e-4));
    CHECK(touch.normal_T.z() == 1);
    CHECK(std::abs(touch.p_T.y()) == Approx(0.04));
    // both ends stand for half a piece
    const bool end = touch.p_T.x() < 1e-9 || touch.p_T.x() > 0.4 - 1e-9;
    CHECK(touch.weight == (end ? 0.5 : 1.0));
  }
  CHECK(weight_of(out) == Approx(8));
  // 2 mm above ground, and on the other side of it
  out.clear();
  touch_plane(belt(), {0, 0, 1}, -0.052, out);
  CHECK(out.empty());
}

TEST_CASE("An edge presses into an arc along the arc's own normal") {
  // the edge 45 degrees below the front disc's centre, 0.2 mm inside
  const double r = 0.05 - 2e-4, c = std::sqrt(0.5);
  const auto out = on_box(belt(), {1, 1, 1}, {0.4 + r * c + 0.5, 0, -r * c - 0.5});
  REQUIRE(out.size() == 3);  // one in each slice
  for (const BeltTouch& touch : out) {
    CHECK(touch.holds_lugs);
    CHECK(touch.gap_m == Approx(-2e-4).margin(1e-9));
    CHECK(touch.normal_T.x() == Approx(-c));
    CHECK(touch.normal_T.z() == Approx(c));
  }
  CHECK(weight_of(out) == Approx(2));
}

TEST_CASE("A belt half on a box is carried by that half, up to the box's edge") {
  // the box ends at x = 0.25, its top is 0.1 mm inside the belt
  const auto out = on_box(belt(), {1, 1, 1}, {-0.25, 0, -0.0499 - 0.5});
  double front = -1;
  for (const BeltTouch& touch : out) {
    CHECK(touch.normal_T.z() == Approx(1));
    CHECK(touch.gap_m == Approx(-1e-4).margin(1e-9));
    front = std::max(front, touch.p_T.x());
  }
  CHECK(front == Approx(0.25));
}

TEST_CASE("A wall beside pushes sideways, and a wall ahead back") {
  // 0.3 mm of the belt's side are in a wall that stands along it
  for (const double side : {-1.0, 1.0}) {
    const auto out = on_box(belt(), {4, 1, 1}, {0, side * (0.04 + 0.5 - 3e-4), 0});
    REQUIRE(out.size() >= 4);
    for (const BeltTouch& touch : out) {
      CHECK(touch.normal_T.y() == Approx(-side));
      CHECK(touch.gap_m == Approx(-3e-4).margin(1e-9));
    }
  }
  const auto ahead = on_box(belt(), {1, 1, 1}, {0.45 + 0.5 - 3e-4, 0, 0});
  REQUIRE(ahead.size() == 2);  // at both edges of the belt: the wall goes on between
  for (const BeltTouch& touch : ahead) {
    CHECK(touch.normal_T.x() == Approx(-1));
    CHECK_FALSE(touch.holds_lugs);
  }
}

TEST_CASE("The vertical edge of a wall's corner is met between the slices") {
  // a pillar turned by 45 degrees, its edge 0.2 mm inside the front disc's foremost line, at y = 0.02
  const double half_diagonal = 0.1 * std::sqrt(2.0) / 2;
  const auto out = on_box(belt(), {0.1, 0.1, 1}, {0.45 - 2e-4 + half_diagonal, 0.02, 0}, std::numbers::pi / 4);
  REQUIRE(out.size() == 1);
  CHECK_FALSE(out[0].holds_lugs);  // lugs lie across the belt and pass along it
  CHECK(out[0].normal_T.x() == Approx(-1).margin(1e-3));
  CHECK(out[0].p_T.y() == Approx(0.02));
}

TEST_CASE("Level ground of triangles carries as a plane does, and its seams are not felt") {
  // two triangles with a seam across the belt's middle, 0.1 mm inside
  const double z = -0.0499;
  const btVector3 a(-1, -1, z), b(1, -1, z), c(1, 1, z), d(-1, 1, z);
  TriangleInT first{{a, b, c}, {0, 0, 1}, {}, {}, 0}, second{{a, c, d}, {0, 0, 1}, {}, {}, 1};
  std::vector<BeltTouch> out;
  touch_triangle(belt(), first, out);
  touch_triangle(belt(), second, out);
  // 5 slices of 5 points; the seam x = y passes no point twice but the one at the origin's slice
  CHECK(out.size() >= 25);
  CHECK(out.size() <= 26);
  for (const BeltTouch& touch : out) {
    CHECK(touch.normal_T.z() == 1);
    CHECK(touch.gap_m == Approx(-1e-4));
  }
}

TEST_CASE("A world's last triangle is not taken for its first") {
  const double z = -0.0499;
  TriangleInT first{{{-1, -2, z}, {2, 0, z}, {-1, 2, z}}, {0, 0, 1}, {}, {}, 0}, far = first;
  far.index = 1u << 20;  // a world has up to 2^21; numbers of 32 bits have 12 for the place within a triangle
  std::vector<BeltTouch> of_first, of_far;
  touch_triangle(belt(), first, of_first);
  touch_triangle(belt(), far, of_far);
  REQUIRE(!of_first.empty());
  REQUIRE(of_far.size() == of_first.size());
  for (std::size_t i = 0; i < of_far.size(); ++i)
    CHECK(of_far[i].feature == of_first[i].feature + (std::uint64_t{1} << 32));
}

TEST_CASE("A flipper's outline is two discs and their tangents") {
  // large disc of 55 mm at the pivot, small one of 40 mm at 145 mm: the tangent leans by asin(15 / 145)
  const BeltShape flipper{
      .radius = {0.055, 0.040}, .length = 0.145, .half_width = 0.02, .p_BodyT = {0, 0, 0}, .pieces = 2, .surface = {}};
  CHECK(distance_to_outline(flipper, 0, -0.06).distance == Approx(0.005).margin(1e-4));
  CHECK(distance_to_outline(flipper, -0.06, 0).distance == Approx(0.005));
  CHECK(distance_to_outline(flipper, 0.19, 0).distance == Approx(0.005));
  const OutlineDistance middle = distance_to_outline(flipper, 0.07, -0.08);
  CHECK(std::asin(middle.outward.x()) == Approx(std::asin(15.0 / 145)));
  // the tangent through both discs' lowest points in its direction: half way it is 47.5 mm from the axis, along its
  // normal
  const double lean = 15.0 / 145, rise = std::sqrt(1 - lean * lean);
  CHECK(middle.distance == Approx(lean * 0.07 + rise * 0.08 - 0.055));
}

TEST_CASE("A large wheel sinks deeper into soft ground than a small one before its face is taken for another") {
  // the upper face of a block is 50 mm inside: within 0.3 of a radius of 0.3 m, not within 30 mm or 0.3 of 50 mm
  const auto touches_above = [](double radius_m) {
    BeltShape wheel = belt();
    wheel.radius = {radius_m, radius_m};
    std::size_t above = 0;
    for (const BeltTouch& touch : on_box(wheel, {2, 2, 1}, {0, 0, -radius_m + 0.05 - 0.5}))
      above += touch.normal_T.z() > 0.99;
    return above;
  };
  CHECK(touches_above(0.3) > 0);
  CHECK(touches_above(0.05) == 0);
}
