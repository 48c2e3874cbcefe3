#include "camera/surface.hpp"

#include <cmath>
#include <numbers>

#include "physics/robot_shapes.hpp"

namespace kenaf::camera {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using std::numbers::pi;

constexpr double kLugSpacing_m = 0.03;
constexpr double kWheelShare = 0.7;  // of its drum's radius
constexpr double kWheelOut_m = 0.002;
constexpr int kWheelCorners = 20;

std::uint32_t add_vertex(Surface& surface, const Vector3d& p) {
  surface.vertices.push_back(p.cast<float>());
  return static_cast<std::uint32_t>(surface.vertices.size() - 1);
}

// Adds a convex face as a fan of triangles; corners are counter-clockwise as seen from outside.
void add_polygon(Surface& surface, const std::vector<Vector3d>& corners, Face face) {
  face.distance = face.normal.dot(corners[0]);
  surface.faces.push_back(face);
  const auto index = static_cast<std::uint32_t>(surface.faces.size() - 1);
  const std::uint32_t first = add_vertex(surface, corners[0]);
  std::uint32_t last = add_vertex(surface, corners[1]);
  for (std::size_t i = 2; i < corners.size(); ++i) {
    const std::uint32_t next = add_vertex(surface, corners[i]);
    surface.triangles.push_back({first, last, next});
    surface.face_of_triangle.push_back(index);
    last = next;
  }
}

struct Wheel {
  Vector2d centre;  // x, z
  double radius_m;
};

// A belt around an outline (counter-clockwise where x is to the right and z up) in the plane y = p_LBelt.y().
struct BeltLoop {
  physics::Outline outline;
  Vector3d p_LBelt;
  double width_m;
  Material side;
  robot::Track track;
  double s_sign;  // driving forward moves the belt -1: along the outline's order, +1: against it, 0: not at all
  std::vector<Wheel> wheels;
};

void add_side(Surface& surface, const BeltLoop& belt, double left) {
  const auto corner = [&](const Vector2d& p, double y) { return Vector3d(belt.p_LBelt + Vector3d(p.x(), y, p.y())); };
  const auto add = [&](std::vector<Vector3d> corners, Material material) {
    if (left > 0) std::reverse(corners.begin(), corners.end());
    Face face{.normal = {0, left, 0}, .distance = 0, .s = {}, .t = {}, .material = material};
    add_polygon(surface, corners, face);
  };
  std::vector<Vector3d> corners;
  for (const Vector2d& p : belt.outline) corners.push_back(corner(p, left * belt.width_m / 2));
  add(corners, belt.side);
  for (const Wheel& wheel : belt.wheels) {
    corners.clear();
    for (int i = 0; i < kWheelCorners; ++i) {
      const double angle = 2 * pi * i / kWheelCorners;
      corners.push_back(corner(wheel.centre + wheel.radius_m * Vector2d(std::cos(angle), std::sin(angle)),
                               left * (belt.width_m / 2 + kWheelOut_m)));
    }
    add(corners, Material::drum);
  }
}

void add_belt(Surface& surface, const BeltLoop& belt) {
  // A whole number of lugs around the loop, about kLugSpacing_m apart.
  const physics::Outline& outline = belt.outline;
  const auto next = [&](std::size_t i) { return outline[(i + 1) % outline.size()]; };
  double length_m = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) length_m += (next(i) - outline[i]).norm();
  const double per_m = std::max(1.0, std::round(length_m / kLugSpacing_m)) / length_m;

  // A face for each piece of the outline; s goes on from piece to piece, 1 for each lug.
  double before_m = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vector2d along = next(i) - outline[i];
    const double piece_m = along.norm();
    if (piece_m < 1e-9) continue;
    const Vector3d direction(along.x() / piece_m, 0, along.y() / piece_m);
    const Vector3d a = belt.p_LBelt + Vector3d(outline[i].x(), 0, outline[i].y()), b = a + piece_m * direction;
    const Vector3d half(0, belt.width_m / 2, 0);
    Face face{
        .normal = {direction.z(), 0, -direction.x()}, .distance = 0, .s = {}, .t = {}, .material = Material::belt};
    face.s = {per_m * direction, per_m * (before_m - direction.dot(a))};
    face.s_per_track_m = belt.s_sign * per_m;
    face.track = belt.track;
    add_polygon(surface, {a + half, a - half, b - half, b + half}, face);
    before_m += piece_m;
  }
  for (const double left : {1.0, -1.0}) add_side(surface, belt, left);
}

BeltLoop loop_of(const physics::TrackDescription& track, robot::Track side) {
  BeltLoop belt{physics::track_outline(track), track.center_m(side), track.width_m, Material::track_side, side, 1, {}};
  const double half_m = track.straight_m() / 2, radius_m = kWheelShare * track.end_radius_m;
  if (half_m > 0) belt.wheels.push_back({{half_m, 0}, radius_m});
  belt.wheels.push_back({{0, 0}, 0.7 * radius_m});  // a road wheel, or a wheel's hub
  if (half_m > 0) belt.wheels.push_back({{-half_m, 0}, radius_m});
  return belt;
}

BeltLoop loop_of(const physics::CasterDescription& caster) {
  BeltLoop belt = loop_of(caster.as_wheel(), robot::kLeft);
  belt.s_sign = 0;
  return belt;
}

}  // namespace

void add_box(Surface& surface, const Vector3d& size_m, const physics::Pose& X_LBox, Material material) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      Vector3d normal = Vector3d::Zero(), a = Vector3d::Zero();
      normal[axis] = sign;
      a[(axis + 1) % 3] = 1;
      const Vector3d b = normal.cross(a);
      const double half_a = size_m.dot(a.cwiseAbs()) / 2, half_b = size_m.dot(b.cwiseAbs()) / 2;
      std::vector<Vector3d> corners;
      for (const auto& [i, j] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
        corners.push_back(X_LBox.p + X_LBox.q * (size_m[axis] / 2 * normal + i * half_a * a + j * half_b * b).eval());
      Face face{.normal = X_LBox.q * normal, .distance = 0, .s = {}, .t = {}, .material = material};
      face.s = {X_LBox.q * a, -(X_LBox.q * a).dot(X_LBox.p)};
      face.t = {X_LBox.q * b, -(X_LBox.q * b).dot(X_LBox.p)};
      face.half = {half_a, half_b};
      add_polygon(surface, corners, face);
    }
  }
}

Surface body_surface(const physics::RobotDescription& robot) {
  Surface surface;
  add_box(surface, robot.body.size_m, {}, Material::hull);
  for (const robot::Track side : {robot::kLeft, robot::kRight})
    for (const physics::TrackDescription& track : robot.track) add_belt(surface, loop_of(track, side));
  for (const physics::CasterDescription& caster : robot.caster) add_belt(surface, loop_of(caster));
  return surface;
}

Surface flipper_surface(const physics::RobotDescription& robot, robot::Flipper which) {
  const physics::FlipperDescription& flipper = robot.flipper.front();
  Surface surface;
  // The upper run moves forward on both ends of the robot: toward the tip in front, toward the pivot behind.
  const double s_sign = !flipper.belt_driven ? 0 : robot::is_front(which) ? 1 : -1;
  add_belt(surface, {physics::flipper_outline(flipper),
                     Vector3d::Zero(),
                     flipper.width_m,
                     robot::is_front(which) ? Material::front_flipper : Material::rear_flipper,
                     robot::side_of(which),
                     s_sign,
                     {{{0, 0}, kWheelShare * flipper.pivot_radius_m},
                      {{flipper.length_m, 0}, kWheelShare * flipper.tip_radius_m}}});
  return surface;
}

physics::Pose flipper_pose(const physics::RobotDescription& robot, robot::Flipper which, double angle_rad) {
  Vector3d pivot_B = robot.flipper.front().p_BPivot_m;
  if (!robot::is_front(which)) pivot_B.x() *= -1;
  if (robot::side_of(which) == robot::kRight) pivot_B.y() *= -1;
  const Eigen::Quaterniond tip_up(Eigen::AngleAxisd(-angle_rad, Vector3d::UnitY()));
  const Eigen::Quaterniond turned(Eigen::AngleAxisd(robot::is_front(which) ? 0 : pi, Vector3d::UnitZ()));
  return {pivot_B, turned * tip_up};
}

}  // namespace kenaf::camera
