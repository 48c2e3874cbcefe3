#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/draw/views.hpp"

namespace kenaf::draw {

namespace {

using Eigen::Vector3d;

constexpr double kTimeLabelRoom = 34;  // pixels above the robots
constexpr double kTimeLabelSize = 11.5;

// The horizontal direction from the start to the farthest point of the run; forward if the robot stayed.
Vector3d main_direction(const DrivenPath& path) {
  const Posture& start = path.postures.front();
  Vector3d farthest = Vector3d::Zero();
  for (const Posture& posture : path.postures) {
    Vector3d away = posture.X_WB.p - start.X_WB.p;
    away.z() = 0;
    if (away.norm() > farthest.norm()) farthest = away;
  }
  if (farthest.norm() < 0.05) farthest = start.X_WB.q * Vector3d::UnitX();
  farthest.z() = 0;
  if (farthest.norm() < 1e-6) return Vector3d::UnitX();
  farthest.normalize();
  // Within a few degrees of x the picture uses x itself.
  return farthest.x() > 0.99 ? Vector3d::UnitX() : farthest;
}

// Boxes within the robot's path, in the viewing direction, the farthest first.
std::vector<physics::Box> boxes_along(const Scene& scene, const Projection& projection) {
  const Vector3d toward_W = projection.toward_viewer_W();
  double low = 1e300, high = -1e300;
  for (const Posture& posture : scene.paths.front().postures) {
    low = std::min(low, toward_W.dot(posture.X_WB.p));
    high = std::max(high, toward_W.dot(posture.X_WB.p));
  }
  const double half_robot_m = scene.robot.track_gauge_m();
  std::vector<physics::Box> boxes;
  for (const physics::Box& box : scene.world.boxes) {
    const Vector3d toward_Box = box.X_WBox.q.conjugate() * toward_W;
    const double reach_m = toward_Box.cwiseAbs().dot(box.size_m) / 2;
    const double at_m = toward_W.dot(box.X_WBox.p);
    if (at_m + reach_m >= low - half_robot_m && at_m - reach_m <= high + half_robot_m) boxes.push_back(box);
  }
  std::ranges::stable_sort(boxes, {}, [&](const physics::Box& box) { return toward_W.dot(box.X_WBox.p); });
  return boxes;
}

// The planes, cut along the path's main direction, as solid ground.
void draw_ground(const Canvas& canvas, const Mapping& map, const Scene& scene, const Projection& projection) {
  const Vector3d& start_W = scene.paths.front().postures.front().X_WB.p;
  for (const physics::GroundPlane& plane : scene.world.planes) {
    const Vector3d normal_W = plane.X_WP.q * Vector3d::UnitZ();
    if (std::abs(normal_W.z()) < 1e-6) continue;
    // Along the cut at right coordinate u: the z where n . (p - p_plane) = 0.
    const auto height_at = [&](double u) {
      const Vector3d p_W = start_W + (u - projection.right_W.dot(start_W)) * projection.right_W;
      return p_W.z() - normal_W.dot(p_W - plane.X_WP.p) / normal_W.z();
    };
    const Point left(map.low.x(), height_at(map.low.x())), right(map.high.x(), height_at(map.high.x()));
    const Point corners[] = {
        map(left), map(right), {map.area.right(), map.area.bottom() + 10}, {map.area.left, map.area.bottom() + 10}};
    canvas.polygon(corners);
    canvas.fill(palette::kGround);
    const Point surface[] = {corners[0], corners[1]};
    canvas.polyline(surface);
    canvas.stroke(palette::kGroundEdge, 1.4);
  }
}

void draw_side_boxes(const Canvas& canvas, const Mapping& map, const std::vector<physics::Box>& boxes,
                     const Projection& projection) {
  for (const physics::Box& box : boxes) {
    const std::vector<Point> outline = map(box_outline(box, projection));
    canvas.polygon(outline);
    canvas.fill(palette::kBox);
    canvas.stroke(palette::kBoxEdge, 1.4);
    const std::string label = fmt::format("{:.0f} mm", (box.X_WBox.p.z() + box.size_m.z() / 2) * 1000);
    const Rectangle seen = seen_part(outline, map.area);
    if (seen.width > canvas.text_width(label, kTimeLabelSize) + 8 && seen.height > 22) {
      canvas.text({seen.left + seen.width / 2, seen.top + seen.height / 2 + 4}, label, kTimeLabelSize,
                  palette::kGreyInk, Align::centre);
    }
  }
}

// The time of each instant in a row above the robots, at `row`, with a thin line down to the body's centre; labels that
// would overlap are left out.
void draw_times(const Canvas& canvas, const Mapping& map, const DrivenPath& path,
                const std::vector<std::size_t>& instants, const Projection& projection, double row) {
  double free_from = map.area.left;
  for (const std::size_t i : instants) {
    const std::string label = fmt::format("{:.1f} s", path.postures[i].time_s);
    const Point centre = map(projection(path.postures[i].X_WB.p));
    const double width = canvas.text_width(label, kTimeLabelSize);
    if (centre.x() - width / 2 < free_from) continue;
    free_from = centre.x() + width / 2 + 8;
    const Point hair[] = {{centre.x(), row + 6}, {centre.x(), centre.y()}};
    canvas.polyline(hair);
    canvas.stroke(palette::kFrame, 0.8);
    canvas.text_with_halo({centre.x(), row}, label, kTimeLabelSize, palette::kInk, Align::centre);
  }
}

}  // namespace

std::optional<Mapping> draw_side_view(const Canvas& canvas, const Rectangle& area, const Scene& scene) {
  const DrivenPath& first = scene.paths.front();
  const Projection projection{main_direction(first), Vector3d::UnitZ()};
  const double robot_m = scene.robot.track_length_m();
  const std::vector<std::size_t> instants = spaced_postures(first, 1.05 * robot_m, robot_m / 2);

  // The area: all paths and the drawn robots, with room for the times above them.
  Bounds bounds;
  for (const DrivenPath& path : scene.paths) bounds.add(centre_line(path, projection));
  for (const std::size_t i : instants) {
    for (const Part& part : robot_parts(scene.robot, first.postures[i], projection)) bounds.add(part.outline);
  }
  bounds.grow(0.1 * robot_m);
  const Rectangle inner = inside_labels(area);
  Mapping map = fit({inner.left, inner.top + kTimeLabelRoom, inner.width, inner.height - kTimeLabelRoom}, bounds.low,
                    bounds.high);
  // The same scale over the whole area; the rest of its height is above the robots, not below the ground.
  map.area = inner;
  map.low.y() = bounds.low.y();
  map.high.y() = map.low.y() + inner.height / map.pixels_per_metre();

  const std::vector<physics::Box> boxes = boxes_along(scene, projection);
  const bool along_x = projection.right_W == Vector3d::UnitX();
  draw_grid(canvas, map);
  {
    const Clip clip(canvas, inner);
    draw_ground(canvas, map, scene, projection);
    draw_side_boxes(canvas, map, boxes, projection);
    draw_times(canvas, map, first, instants, projection, map(bounds.high).y() - 12);
    for (const std::size_t i : instants) {
      draw_robot(canvas, map, robot_parts(scene.robot, first.postures[i], projection), i == instants.back() ? 0 : 0.5);
    }
    for (std::size_t i = scene.paths.size(); i-- > 0;) {
      draw_centre_line(canvas, map, scene.paths[i], projection, run_colour(i), 2.4);
    }
    for (std::size_t i = scene.paths.size(); i-- > 0;) {
      draw_path_end(canvas, map, scene.paths[i], projection, PathEnd::start, run_colour(i), 5.5);
      draw_path_end(canvas, map, scene.paths[i], projection, PathEnd::end, run_colour(i), 4.5);
    }
  }
  draw_labels(canvas, map, "From the side", along_x ? "x" : "along the way", "z");
  return along_x ? std::optional(map) : std::nullopt;
}

}  // namespace kenaf::draw
