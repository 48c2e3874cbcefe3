#include "tools/draw/robot_shape.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kenaf::draw {

namespace {

using Eigen::Vector3d;

constexpr int kCircleCorners = 36;
constexpr double kLugSpacing_m = 0.03;
// Details for a readable picture; no description has them.
constexpr double kBeltThickness = 0.24;  // of the smaller drum's radius
constexpr double kWheelShare = 0.6;      // of its drum's radius
constexpr double kHubShare = 0.3;        // of its wheel's radius
constexpr int kRoadWheels = 3;

std::vector<Vector3d> circle(const Vector3d& centre_B, double radius_m) {
  std::vector<Vector3d> points;
  for (int i = 0; i < kCircleCorners; ++i) {
    const double angle_rad = 2 * std::numbers::pi * i / kCircleCorners;
    points.push_back(centre_B + radius_m * Vector3d(std::cos(angle_rad), 0, std::sin(angle_rad)));
  }
  return points;
}

// A belt around two drums whose axes run along y: a main track or a flipper; or a wheel, where both are one.
struct Belt {
  PartKind kind;
  Vector3d first_B, second_B;  // centres of the drums, in the belt's middle plane
  double first_radius_m, second_radius_m, width_m;
};

std::vector<Belt> belts_of(const physics::RobotDescription& robot, const Posture& posture) {
  std::vector<Belt> belts;
  const auto mirrored = [](Vector3d p, double front, double left) {
    return Vector3d(p.x() * front, p.y() * left, p.z());
  };

  // Main tracks and wheels: the drums' centres are one end radius from the ends, those of a wheel the same.
  for (const double left : {1.0, -1.0}) {
    for (const physics::TrackDescription& track : robot.track) {
      const Vector3d centre_B = mirrored(track.p_BT_m, 1, left), half(track.straight_m() / 2, 0, 0);
      belts.push_back({track.straight_m() > 0 ? PartKind::track : PartKind::wheel, centre_B + half, centre_B - half,
                       track.end_radius_m, track.end_radius_m, track.width_m});
    }
  }
  for (const physics::CasterDescription& caster : robot.caster)
    belts.push_back({PartKind::wheel, caster.p_BC_m, caster.p_BC_m, caster.radius_m, caster.radius_m, caster.width_m});

  // Flippers: from the pivot along (cos, 0, sin) of the angle, forward in front and backward behind.
  if (!robot.has_flippers()) return belts;
  const physics::FlipperDescription& flipper = robot.flipper.front();
  for (std::size_t i = 0; i < robot::kFlipperCount; ++i) {
    const auto which = static_cast<robot::Flipper>(i);
    if (!robot.has(which)) continue;
    const double front = robot::is_front(which) ? 1 : -1;
    const double left = robot::side_of(which) == robot::kLeft ? 1 : -1;
    const Vector3d pivot_B = mirrored(flipper.p_BPivot_m, front, left);
    const double angle_rad = posture.flipper_rad[i];
    const Vector3d along_B(front * std::cos(angle_rad), 0, std::sin(angle_rad));
    belts.push_back({PartKind::flipper, pivot_B, pivot_B + flipper.length_m * along_B, flipper.pivot_radius_m,
                     flipper.tip_radius_m, flipper.width_m});
  }
  return belts;
}

std::vector<Point> projected(const std::vector<Vector3d>& points_B, const physics::Pose& X_WB,
                             const Projection& projection) {
  std::vector<Point> points;
  for (const Vector3d& p_B : points_B) points.push_back(projection(X_WB.p + X_WB.q * p_B));
  return points;
}

// Lines across the straight run of the belt that lies higher in the body.
std::vector<std::vector<Vector3d>> lugs_of(const Belt& belt) {
  std::vector<std::vector<Vector3d>> lugs;
  const Vector3d along = belt.second_B - belt.first_B;
  if (along.isZero()) return lugs;
  Vector3d normal = Vector3d(-along.z(), 0, along.x()).normalized();
  if (normal.z() < 0) normal = -normal;
  const Vector3d half_width(0, belt.width_m / 2, 0);
  const int count = std::max(1, static_cast<int>(along.norm() / kLugSpacing_m));
  for (int i = 0; i <= count; ++i) {
    const double part = static_cast<double>(i) / count;
    const double radius_m = belt.first_radius_m + part * (belt.second_radius_m - belt.first_radius_m);
    const Vector3d middle = belt.first_B + part * along + radius_m * normal;
    lugs.push_back({middle - half_width, middle + half_width});
  }
  return lugs;
}

// The wheels inside of the loop: one in each drum, under a main track also between them; the hub of a wheel.
std::vector<std::vector<Vector3d>> wheels_of(const Belt& belt, const Vector3d& sideways) {
  if (belt.kind == PartKind::wheel) return {circle(belt.first_B + sideways, kHubShare * belt.first_radius_m)};
  std::vector<std::vector<Vector3d>> wheels{circle(belt.first_B + sideways, kWheelShare * belt.first_radius_m),
                                            circle(belt.second_B + sideways, kWheelShare * belt.second_radius_m)};
  if (belt.kind != PartKind::track) return wheels;
  const double radius_m = 0.4 * belt.first_radius_m;
  for (int i = 1; i <= kRoadWheels; ++i) {
    const double part = static_cast<double>(i) / (kRoadWheels + 1);
    const Vector3d low(0, 0, -(1 - kBeltThickness) * belt.first_radius_m + radius_m);
    wheels.push_back(circle(belt.first_B + part * (belt.second_B - belt.first_B) + low + sideways, radius_m));
  }
  return wheels;
}

Part belt_part(const Belt& belt, const physics::Pose& X_WB, const Projection& projection) {
  // The outline: the hull of both rims.
  const Vector3d toward_W = projection.toward_viewer_W();
  const double facing = toward_W.dot(X_WB.q * Vector3d::UnitY());
  std::vector<Vector3d> surface_B;
  for (const double side : {0.5, -0.5}) {
    const Vector3d sideways(0, side * belt.width_m, 0);
    for (const Vector3d& p : circle(belt.first_B + sideways, belt.first_radius_m)) surface_B.push_back(p);
    for (const Vector3d& p : circle(belt.second_B + sideways, belt.second_radius_m)) surface_B.push_back(p);
  }
  Part part{belt.kind, 0, convex_hull(projected(surface_B, X_WB, projection)), std::abs(facing) > 0.3, {}, {}, {}};
  part.nearness = toward_W.dot(X_WB.p + X_WB.q * ((belt.first_B + belt.second_B) / 2));

  // The face towards the viewer: the belt's inner outline and the wheels; and the lugs of its upper run.
  const Vector3d sideways(0, (facing > 0 ? 0.5 : -0.5) * belt.width_m, 0);
  const double thickness_m = kBeltThickness * std::min(belt.first_radius_m, belt.second_radius_m);
  std::vector<Vector3d> inside_B = circle(belt.first_B + sideways, belt.first_radius_m - thickness_m);
  for (const Vector3d& p : circle(belt.second_B + sideways, belt.second_radius_m - thickness_m)) inside_B.push_back(p);
  part.inside = convex_hull(projected(inside_B, X_WB, projection));
  for (const auto& wheel : wheels_of(belt, sideways)) part.wheels.push_back(projected(wheel, X_WB, projection));
  for (const auto& lug : lugs_of(belt)) part.lugs.push_back(projected(lug, X_WB, projection));
  return part;
}

std::vector<Vector3d> box_corners(const Vector3d& size_m) {
  std::vector<Vector3d> corners;
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.5, 0.5}) {
      for (const double z : {-0.5, 0.5}) corners.emplace_back(x * size_m.x(), y * size_m.y(), z * size_m.z());
    }
  }
  return corners;
}

void draw_belt(const Canvas& canvas, const Mapping& map, const Part& part, double paleness) {
  const double pixels_per_metre = map.pixels_per_metre();
  const Colour belt = paler(palette::kBelt, paleness);
  const Colour body = paler(part.kind == PartKind::flipper ? palette::kFlipper : palette::kTrack, paleness);
  const double line = std::clamp(0.004 * pixels_per_metre, 0.7, 1.6);
  canvas.polygon(map(part.outline));
  canvas.fill(part.shows_face ? belt : body);
  canvas.stroke(belt, line);
  if (part.shows_face) {
    canvas.polygon(map(part.inside));
    canvas.fill(body);
    for (const auto& wheel : part.wheels) {
      canvas.polygon(map(wheel));
      canvas.fill(paler(palette::kWheel, paleness));
      canvas.stroke(belt, 0.6 * line);
    }
  } else if (kLugSpacing_m * pixels_per_metre >= 3) {
    for (const auto& lug : part.lugs) {
      canvas.polyline(map(lug));
      canvas.stroke(belt, 0.7 * line);
    }
  }
}

}  // namespace

std::vector<Point> convex_hull(std::vector<Point> points) {
  // Andrew's monotone chain: the lower hull in order of x, then the upper one in reverse; a point that makes no left
  // turn is dropped.
  std::ranges::sort(points,
                    [](const Point& a, const Point& b) { return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y()); });
  const auto turns_left = [](const Point& a, const Point& b, const Point& c) {
    return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x() > 0;
  };
  std::vector<Point> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t base = hull.size();
    for (const Point& p : points) {
      while (hull.size() >= base + 2 && !turns_left(hull[hull.size() - 2], hull.back(), p)) hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::ranges::reverse(points);
  }
  return hull;
}

std::vector<Part> robot_parts(const physics::RobotDescription& robot, const Posture& posture,
                              const Projection& projection) {
  std::vector<Part> parts;
  for (const Belt& belt : belts_of(robot, posture)) parts.push_back(belt_part(belt, posture.X_WB, projection));
  Part hull{PartKind::hull, projection.toward_viewer_W().dot(posture.X_WB.p), {}, false, {}, {}, {}};
  hull.outline = convex_hull(projected(box_corners(robot.body.size_m), posture.X_WB, projection));
  parts.push_back(std::move(hull));
  std::ranges::stable_sort(parts, {}, &Part::nearness);
  return parts;
}

std::vector<Point> box_outline(const physics::Box& box, const Projection& projection) {
  return convex_hull(projected(box_corners(box.size_m), box.X_WBox, projection));
}

std::vector<Point> Mapping::operator()(const std::vector<Point>& points) const {
  std::vector<Point> mapped;
  for (const Point& p : points) mapped.push_back((*this)(p));
  return mapped;
}

Rectangle seen_part(const std::vector<Point>& outline, const Rectangle& area) {
  const auto [left, right] = std::ranges::minmax_element(outline, {}, [](const Point& p) { return p.x(); });
  const auto [top, bottom] = std::ranges::minmax_element(outline, {}, [](const Point& p) { return p.y(); });
  const double seen_left = std::max(left->x(), area.left), seen_top = std::max(top->y(), area.top);
  return {seen_left, seen_top, std::min(right->x(), area.right()) - seen_left,
          std::min(bottom->y(), area.bottom()) - seen_top};
}

Mapping fit(const Rectangle& area, Point low, Point high) {
  const double metres_per_pixel = std::max((high.x() - low.x()) / area.width, (high.y() - low.y()) / area.height);
  const Point half = 0.5 * metres_per_pixel * Point(area.width, area.height);
  const Point centre = 0.5 * (low + high);
  return {area, centre - half, centre + half};
}

void draw_robot(const Canvas& canvas, const Mapping& map, const std::vector<Part>& parts, double paleness) {
  for (const Part& part : parts) {
    if (part.kind != PartKind::hull) {
      draw_belt(canvas, map, part, paleness);
      continue;
    }
    canvas.polygon(map(part.outline));
    canvas.fill(paler(palette::kHull, paleness));
    canvas.stroke(paler(palette::kHullEdge, paleness), std::clamp(0.004 * map.pixels_per_metre(), 0.7, 1.6));
  }
}

}  // namespace kenaf::draw
