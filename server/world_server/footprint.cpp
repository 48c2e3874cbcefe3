#include "server/world_server/footprint.hpp"

#include <array>
#include <cmath>

#include "physics/robot_dimensions.hpp"

namespace kenaf::world_server {
namespace {

struct Rectangle {
  Eigen::Vector2d centre, ahead, left;  // from the centre to the middle of its front and of its left side
};

Rectangle rectangle_of(const physics::Pose& X_WB, const Eigen::Vector3d& half_m) {
  const double yaw = physics::roll_pitch_yaw(X_WB.q).z();
  const Eigen::Vector2d ahead(std::cos(yaw), std::sin(yaw));
  return {X_WB.p.head<2>(), half_m.x() * ahead, half_m.y() * Eigen::Vector2d(-ahead.y(), ahead.x())};
}

}  // namespace

Eigen::Vector3d half_footprint_m(const physics::RobotDescription& robot) {
  const physics::RobotDimensions dimensions = physics::dimensions_of(robot);
  Eigen::Vector3d half = dimensions.body_size_m / 2;
  for (const auto* belts : {&dimensions.tracks, &dimensions.casters})
    for (const physics::BeltDimensions& belt : *belts)
      half = half.cwiseMax(belt.p_B_m.cwiseAbs() + Eigen::Vector3d(belt.length_m / 2, belt.width_m / 2, belt.radius_m));
  return half;
}

bool footprints_overlap(const physics::Pose& X_WA, const Eigen::Vector3d& half_a_m, const physics::Pose& X_WB,
                        const Eigen::Vector3d& half_b_m) {
  if (std::abs(X_WA.p.z() - X_WB.p.z()) >= half_a_m.z() + half_b_m.z()) return false;
  // convex shapes are apart if they are along a normal of some side (separating axis theorem)
  const Rectangle a = rectangle_of(X_WA, half_a_m), b = rectangle_of(X_WB, half_b_m);
  for (const Eigen::Vector2d& along : std::array{a.ahead, a.left, b.ahead, b.left}) {
    const auto reach = [&](const Rectangle& of) {
      return std::abs(of.ahead.dot(along)) + std::abs(of.left.dot(along));
    };
    if (std::abs((b.centre - a.centre).dot(along)) >= reach(a) + reach(b)) return false;
  }
  return true;
}

}  // namespace kenaf::world_server
