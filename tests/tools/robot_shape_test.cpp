// The drawn outlines are the described robot's, in the right place and the right way round.
#include <catch2/catch.hpp>
#include <numbers>

#include "tools/draw/robot_shape.hpp"

using namespace kenaf;
using namespace kenaf::draw;

namespace {

const Projection kSide{Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitZ()};
const Projection kTop{Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY()};

// A robot of round numbers: tracks 0.6 m long with ends of 0.06 m, belly at z = -0.06.
physics::RobotDescription round_robot() {
  physics::RobotDescription robot{};
  robot.body.size_m = {0.4, 0.1, 0.1};
  robot.track = {{.length_m = 0.6,
                  .end_radius_m = 0.06,
                  .width_m = 0.1,
                  .p_BT_m = {0, 0.1, 0},
                  .friction_along = 1,
                  .friction_across = 1,
                  .pieces = 1,
                  .lug_height_m = 0}};
  physics::FlipperDescription flipper{};
  flipper.length_m = 0.2;
  flipper.pivot_radius_m = 0.05;
  flipper.tip_radius_m = 0.03;
  flipper.width_m = 0.04;
  flipper.p_BPivot_m = {0.24, 0.18, 0};
  robot.flipper = {flipper};
  return robot;
}

struct Extent {
  double left = 1e9, right = -1e9, low = 1e9, high = -1e9;
};

template <class Wanted>
Extent extent(const std::vector<Part>& parts, Wanted wanted) {
  Extent extent;
  for (const Part& part : parts) {
    if (!wanted(part)) continue;
    for (const Point& p : part.outline) {
      extent.left = std::min(extent.left, p.x());
      extent.right = std::max(extent.right, p.x());
      extent.low = std::min(extent.low, p.y());
      extent.high = std::max(extent.high, p.y());
    }
  }
  return extent;
}

Posture at(const Eigen::Vector3d& p_W, const Eigen::Vector3d& roll_pitch_yaw, std::array<double, 4> flipper_rad) {
  return {0, {p_W, physics::rotation_from(roll_pitch_yaw)}, flipper_rad};
}

bool any(const Part&) {
  return true;
}
bool is_track(const Part& part) {
  return part.kind == PartKind::track;
}
bool is_flipper(const Part& part) {
  return part.kind == PartKind::flipper;
}

}  // namespace

TEST_CASE("A level robot stands on its tracks and is as long as they are") {
  const Extent tracks = extent(robot_parts(round_robot(), at({1, 2, 0.06}, {0, 0, 0}, {}), kSide), is_track);
  CHECK(tracks.low == Approx(0).margin(1e-9));
  CHECK(tracks.high == Approx(0.12));
  CHECK(tracks.left == Approx(0.7));
  CHECK(tracks.right == Approx(1.3));
  const Extent above = extent(robot_parts(round_robot(), at({1, 2, 0.06}, {0, 0, 0}, {}), kTop), any);
  CHECK(above.low == Approx(2 - 0.18 - 0.02));
  CHECK(above.high == Approx(2 + 0.18 + 0.02));
}

TEST_CASE("A positive flipper angle raises every tip, 0 is straight out along the body") {
  // Straight out: pivot 0.24 + arm 0.2 + tip 0.03.
  const Extent flat = extent(robot_parts(round_robot(), at({0, 0, 0}, {0, 0, 0}, {}), kSide), is_flipper);
  CHECK(flat.right == Approx(0.47));
  CHECK(flat.left == Approx(-0.47));
  CHECK(flat.high == Approx(0.05));
  // A quarter turn: straight up over the pivot, 0.2 + 0.03 high.
  constexpr double kUp = std::numbers::pi / 2;
  for (std::size_t i = 0; i < 4; ++i) {
    std::array<double, 4> angles{};
    angles[i] = kUp;
    const Extent one_up = extent(robot_parts(round_robot(), at({0, 0, 0}, {0, 0, 0}, angles), kSide), is_flipper);
    CHECK(one_up.high == Approx(0.23));
    CHECK(one_up.low == Approx(-0.05));
  }
}

TEST_CASE("A positive pitch puts the nose down, a positive yaw turns it left") {
  // Nose down by 90 degrees: the front end, 0.3 ahead, is 0.3 below.
  const Extent down =
      extent(robot_parts(round_robot(), at({0, 0, 0}, {0, std::numbers::pi / 4, 0}, {}), kSide), is_flipper);
  CHECK(down.low < -0.3);  // the front flipper's tip, 0.44 ahead, is 0.31 below the centre
  std::vector<Part> parts = robot_parts(round_robot(), at({0, 0, 0}, {0, 0.3, 0}, {}), kSide);
  for (const Part& part : parts) {
    if (part.kind != PartKind::hull) continue;
    const auto lowest = std::ranges::min_element(part.outline, {}, [](const Point& p) { return p.y(); });
    CHECK(lowest->x() > 0);  // the hull's lowest corner is its front one
  }
  const Extent left = extent(robot_parts(round_robot(), at({0, 0, 0}, {0, 0, std::numbers::pi / 2}, {}), kTop), any);
  CHECK(left.high == Approx(0.47));
  CHECK(left.right == Approx(0.2));
}

TEST_CASE("From the side the wheels are seen, from above the belts") {
  for (const Part& part : robot_parts(round_robot(), at({0, 0, 0}, {0, 0, 0}, {}), kSide)) {
    CHECK(part.shows_face == (part.kind != PartKind::hull));
  }
  for (const Part& part : robot_parts(round_robot(), at({0, 0, 0}, {0, 0, 0}, {}), kTop)) CHECK_FALSE(part.shows_face);
}

TEST_CASE("The farthest part comes first: seen from the right, the left flippers") {
  const std::vector<Part> parts = robot_parts(round_robot(), at({0, 0, 0}, {0, 0, 0}, {}), kSide);
  REQUIRE(parts.size() == 7);
  CHECK(parts.front().kind == PartKind::flipper);
  CHECK(parts[3].kind == PartKind::hull);
  CHECK(parts.back().kind == PartKind::flipper);
  CHECK(parts.back().nearness == Approx(0.18));
}

TEST_CASE("The convex hull leaves out what is inside and on its edges") {
  const std::vector<Point> hull = convex_hull({{0, 0}, {2, 0}, {1, 0}, {1, 1}, {2, 2}, {0, 2}, {0, 1}});
  CHECK(hull == std::vector<Point>{{0, 0}, {2, 0}, {2, 2}, {0, 2}});
}

TEST_CASE("Postures are spaced evenly, the first and the last among them") {
  DrivenPath path;
  for (int i = 0; i <= 100; ++i) path.postures.push_back(at({0.01 * i, 0, 0}, {0, 0, 0}, {}));
  CHECK(spaced_postures(path, 0.5, 0.3) == std::vector<std::size_t>{0, 50, 100});
  CHECK(spaced_postures(path, 0.45, 0.3).size() == 3);  // 2.2 steps become two
  CHECK(spaced_postures(path, 9, 0.3) == std::vector<std::size_t>{0, 100});
  path.postures.resize(1);
  CHECK(spaced_postures(path, 9, 0.3) == std::vector<std::size_t>{0});
}
