#include "physics/robot_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kenaf::physics {
namespace {

using std::numbers::pi;
constexpr int kTrackArcSegments = 16;  // of a half circle: 0.3 mm between chord and arc at a radius of 65 mm
constexpr double kFlipperArcStep = pi / 12;
// Bullet rounds shapes by a margin. Small, because the edge of a step decides whether a robot climbs it.
constexpr double kMargin_m = 0.001;

void add_arc(Outline& outline, const Eigen::Vector2d& center, double radius, double from, double to, int segments) {
  for (int i = 0; i <= segments; ++i) {
    const double a = from + (to - from) * i / segments;
    outline.emplace_back(center + radius * Eigen::Vector2d(std::cos(a), std::sin(a)));
  }
}

}  // namespace

Outline track_outline(const TrackDescription& track) {
  const double half = track.length_m / 2 - track.end_radius_m;  // of the straight run
  Outline outline;
  add_arc(outline, {half, 0}, track.end_radius_m, -pi / 2, pi / 2, kTrackArcSegments);
  add_arc(outline, {-half, 0}, track.end_radius_m, pi / 2, 3 * pi / 2, kTrackArcSegments);
  return outline;
}

Outline flipper_outline(const FlipperDescription& flipper) {
  // Angle of the straight runs' normals: cos lean = (r_pivot - r_tip) / length for a tangent of both drums.
  const double lean =
      std::acos(std::clamp((flipper.pivot_radius_m - flipper.tip_radius_m) / flipper.length_m, -1.0, 1.0));
  const int tip_segments = std::max(2, static_cast<int>(std::lround(2 * lean / kFlipperArcStep)));
  const int pivot_segments = std::max(2, static_cast<int>(std::lround((2 * pi - 2 * lean) / kFlipperArcStep)));
  Outline outline;
  add_arc(outline, {flipper.length_m, 0}, flipper.tip_radius_m, -lean, lean, tip_segments);
  add_arc(outline, {0, 0}, flipper.pivot_radius_m, lean, 2 * pi - lean, pivot_segments);
  return outline;
}

OutlineMoments moments(const Outline& outline) {
  // https://en.wikipedia.org/wiki/Second_moment_of_area#Any_polygon
  double area = 0, Ixx = 0, Izz = 0;
  Eigen::Vector2d first(0, 0);
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d& a = outline[i];
    const Eigen::Vector2d& b = outline[(i + 1) % outline.size()];
    const double cross = a.x() * b.y() - b.x() * a.y();
    area += cross / 2;
    first += (a + b) * cross / 6;
    Ixx += cross * (a.x() * a.x() + a.x() * b.x() + b.x() * b.x()) / 12;
    Izz += cross * (a.y() * a.y() + a.y() * b.y() + b.y() * b.y()) / 12;
  }
  const Eigen::Vector2d c = first / area;
  return {area, c, Ixx - area * c.x() * c.x(), Izz - area * c.y() * c.y()};
}

std::unique_ptr<btConvexHullShape> make_prism(const Outline& outline, double width_m, const Eigen::Vector3d& offset) {
  auto shape = std::make_unique<btConvexHullShape>();
  for (const Eigen::Vector2d& p : outline)
    for (const double y : {-width_m / 2, width_m / 2})
      shape->addPoint(to_bullet(offset + Eigen::Vector3d(p.x(), y, p.y())), false);
  shape->setMargin(kMargin_m);
  shape->recalcLocalAabb();
  shape->initializePolyhedralFeatures();
  return shape;
}

std::unique_ptr<btBoxShape> make_box(const Eigen::Vector3d& size_m) {
  auto shape = std::make_unique<btBoxShape>(to_bullet(Eigen::Vector3d(size_m / 2)));
  shape->setMargin(kMargin_m);
  shape->initializePolyhedralFeatures();
  return shape;
}

}  // namespace kenaf::physics
