#include <fmt/format.h>

#include <algorithm>

#include "tools/draw/views.hpp"

namespace kenaf::draw {

namespace {

Bounds path_bounds(const Scene& scene) {
  Bounds bounds;
  for (const DrivenPath& path : scene.paths) bounds.add(centre_line(path, kFromAbove));
  return bounds;
}

void draw_paths(const Canvas& canvas, const Mapping& map, const Scene& scene, double width, double mark) {
  for (std::size_t i = scene.paths.size(); i-- > 0;) {
    draw_centre_line(canvas, map, scene.paths[i], kFromAbove, run_colour(i), width);
  }
  for (std::size_t i = scene.paths.size(); i-- > 0;) {
    draw_path_end(canvas, map, scene.paths[i], kFromAbove, PathEnd::start, run_colour(i), mark);
    draw_path_end(canvas, map, scene.paths[i], kFromAbove, PathEnd::end, run_colour(i), 0.8 * mark);
  }
}

// Lower boxes first, so that a box on another one covers it.
void draw_boxes(const Canvas& canvas, const Mapping& map, const Scene& scene) {
  const auto top_m = [](const physics::Box& box) { return box.X_WBox.p.z() + box.size_m.z() / 2; };
  std::vector<physics::Box> boxes = scene.world.boxes;
  std::ranges::stable_sort(boxes, {}, top_m);
  for (const physics::Box& box : boxes) {
    const std::vector<Point> outline = map(box_outline(box, kFromAbove));
    canvas.polygon(outline);
    canvas.fill(palette::kBox);
    canvas.stroke(palette::kBoxEdge, 1.2);
    const std::string label = fmt::format("{:.0f} mm high", top_m(box) * 1000);
    const Rectangle seen = seen_part(outline, map.area);
    if (canvas.text_width(label, 10.5) + 8 < std::min(seen.width, seen.height)) {
      canvas.text({seen.left + seen.width / 2, seen.top + seen.height / 2 + 4}, label, 10.5, palette::kGreyInk,
                  Align::centre);
    }
  }
}

// A mapping with the horizontal axis of `like`, if `bounds` fit into it.
std::optional<Mapping> same_horizontal(const Rectangle& area, const Bounds& bounds, const Mapping& like) {
  const double half_height_m = area.height / like.pixels_per_metre() / 2;
  const double middle_m = (bounds.low.y() + bounds.high.y()) / 2;
  const Mapping map{area, {like.low.x(), middle_m - half_height_m}, {like.high.x(), middle_m + half_height_m}};
  const bool fits = bounds.low.x() >= map.low.x() && bounds.high.x() <= map.high.x() && bounds.low.y() >= map.low.y() &&
                    bounds.high.y() <= map.high.y();
  return fits ? std::optional(map) : std::nullopt;
}

}  // namespace

bool needs_close_up(const Scene& scene) {
  return path_bounds(scene).extent() < 1.2 * scene.robot.track_length_m();
}

void draw_top_view(const Canvas& canvas, const Rectangle& area, const Scene& scene,
                   const std::optional<Mapping>& like) {
  const double robot_m = scene.robot.track_length_m();
  const bool crowded = needs_close_up(scene);  // then only the start and the end are drawn
  const DrivenPath& first = scene.paths.front();
  std::vector<std::size_t> instants = spaced_postures(first, 1.35 * robot_m, robot_m / 2);
  if (crowded) instants = {0, first.postures.size() - 1};

  // The area: all paths and the drawn robots, if possible aligned with the side view.
  Bounds bounds = path_bounds(scene);
  for (const std::size_t i : instants) {
    for (const Part& part : robot_parts(scene.robot, first.postures[i], kFromAbove)) bounds.add(part.outline);
  }
  bounds.grow(0.02 * robot_m);
  const Rectangle inner = inside_labels(area);
  std::optional<Mapping> map = like ? same_horizontal(inner, bounds, *like) : std::nullopt;
  bounds.grow(0.12 * robot_m);
  if (!map) map = fit(inner, bounds.low, bounds.high);

  // Grid, boxes, robots from the first on, and paths on top.
  draw_grid(canvas, *map);
  {
    const Clip clip(canvas, inner);
    draw_boxes(canvas, *map, scene);
    for (const std::size_t i : instants) {
      draw_robot(canvas, *map, robot_parts(scene.robot, first.postures[i], kFromAbove),
                 i == instants.back() ? 0 : 0.68);
    }
    draw_paths(canvas, *map, scene, crowded ? 1.8 : 2.6, crowded ? 3.6 : 6);
  }
  draw_labels(canvas, *map, "From above", "x", "y");
}

void draw_close_up(const Canvas& canvas, const Rectangle& area, const Scene& scene) {
  Bounds bounds = path_bounds(scene);
  bounds.grow(std::max(0.22 * bounds.extent(), 0.002));
  const Rectangle inner = inside_labels(area);
  const Mapping map = fit(inner, bounds.low, bounds.high);
  draw_grid(canvas, map);
  {
    const Clip clip(canvas, inner);
    draw_paths(canvas, map, scene, 3, 7);
  }
  draw_labels(canvas, map, "Path of the body's centre, enlarged", "x", "y");
}

}  // namespace kenaf::draw
