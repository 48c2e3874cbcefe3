#include "tools/draw/picture.hpp"

#include <fmt/format.h>

#include <numbers>

namespace kenaf::draw {

namespace {

constexpr double kMargin = 34;

std::string distance_text(double metres) {
  return metres < 1 ? fmt::format("{:.1f} mm", metres * 1000) : fmt::format("{:.3f} m", metres);
}

// "turned 359.8° left", "turned 90.0° left, 89.7° right", or nothing where the robot did not turn.
std::string turns_text(const Turns& turns) {
  const auto degrees = [](double radians) { return radians * 180 / std::numbers::pi; };
  std::string words;
  if (turns.left_rad > 0) words += fmt::format("{:.1f}° left", degrees(turns.left_rad));
  if (turns.right_rad > 0) words += fmt::format("{}{:.1f}° right", words.empty() ? "" : ", ", degrees(turns.right_rad));
  return words.empty() ? words : ", turned " + words;
}

// Title, robot and world, then a line for each run. Returns the y of its lower end.
double draw_header(const Canvas& canvas, const Scene& scene, const std::string& title) {
  double y = kMargin + 20;
  canvas.text({kMargin, y}, title, 25, palette::kInk, Align::left, true);
  canvas.text({kLogicalWidth - kMargin, y}, "robot " + scene.robot.name + "  ·  world " + scene.world.name, 13,
              palette::kGreyInk, Align::right);
  y += 10;
  for (std::size_t i = 0; i < scene.paths.size(); ++i) {
    y += 21;
    const Point sample[] = {{kMargin + 2, y - 4.5}, {kMargin + 26, y - 4.5}};
    canvas.polyline(sample);
    canvas.stroke(run_colour(i), 3.4);
    double x = kMargin + 38;
    if (scene.paths.size() > 1) {
      x += canvas.text({x, y}, scene.paths[i].name, 13, palette::kInk, Align::left, true) + 12;
    }
    canvas.text({x, y}, summary(scene, i), 13, palette::kGreyInk);
  }
  return y + 18;
}

// The meaning of the marks, in one line at the bottom.
void draw_legend(const Canvas& canvas, const Scene& scene) {
  // An entry is a symbol with its word; the next one begins where it ends.
  const double y = canvas.logical_height() - kMargin + 8;
  double x = kMargin + 6;
  const auto entry = [&](double symbol_width, const std::string& words, auto draw_symbol) {
    draw_symbol(Point(x, y - 4));
    x += symbol_width + canvas.text({x + symbol_width, y}, words, 12, palette::kGreyInk) + 26;
  };
  const auto swatch = [&](const Point& at, Colour colour, Colour edge) {
    canvas.rectangle({at.x() - 4, at.y() - 5.5, 17, 11});
    canvas.fill(colour);
    canvas.stroke(edge, 1);
  };

  // Marks of a path, parts of the robot, and what only some pictures show.
  const Colour colour = run_colour(0);
  entry(22, "start", [&](const Point& at) { draw_end_mark(canvas, at, {1, 0}, PathEnd::start, colour, 5); });
  entry(20, "end", [&](const Point& at) { draw_end_mark(canvas, at, {1, 0}, PathEnd::end, colour, 4.5); });
  entry(30, "body's centre", [&](const Point& at) {
    const Point sample[] = {at - Point(3, 0), at + Point(20, 0)};
    canvas.polyline(sample);
    canvas.stroke(colour, 3);
  });
  entry(19, "hull", [&](const Point& at) { swatch(at, palette::kHull, palette::kHullEdge); });
  entry(19, scene.robot.has_wheels() ? "wheel" : "track",
        [&](const Point& at) { swatch(at, palette::kTrack, palette::kBelt); });
  if (scene.robot.has_flippers()) {
    entry(19, "flipper", [&](const Point& at) { swatch(at, palette::kFlipper, palette::kBelt); });
  }
  if (!scene.world.boxes.empty()) {
    entry(19, "box", [&](const Point& at) { swatch(at, palette::kBox, palette::kBoxEdge); });
  }
  canvas.text({x, y}, "pale: earlier", 12, palette::kGreyInk);
}

}  // namespace

std::string summary(const Scene& scene, std::size_t index) {
  const DrivenPath& path = scene.paths[index];
  std::string words = fmt::format("{} in {:.1f} s{}; end {} and {:.1f}° from the start", distance_text(path.length_m()),
                                  path.duration_s(), turns_text(path.turns()), distance_text(path.start_to_end_m()),
                                  std::abs(path.turned_rad()) * 180 / std::numbers::pi);
  if (index > 0) {
    const Eigen::Vector3d away = path.postures.back().X_WB.p - scene.paths.front().postures.back().X_WB.p;
    words += fmt::format(", {} from the end of {}", distance_text(away.norm()), scene.paths.front().name);
  }
  return words;
}

void draw_picture(const Canvas& canvas, const Scene& scene, const std::string& title, ViewChoice view) {
  const double top = draw_header(canvas, scene, title);
  const Rectangle views{kMargin, top, kLogicalWidth - 2 * kMargin, canvas.logical_height() - top - kMargin - 16};
  const bool side = view == ViewChoice::side || (view == ViewChoice::automatic && scene.paths.front().climbs());
  const bool from_above = view != ViewChoice::side;

  // Both views one above the other, one of them alone, or from above with a close-up where the robot hardly moved.
  if (side && from_above) {
    const double side_height = 0.54 * views.height;
    const auto map = draw_side_view(canvas, {views.left, views.top, views.width, side_height}, scene);
    draw_top_view(canvas, {views.left, views.top + side_height + 8, views.width, views.height - side_height - 8}, scene,
                  map);
  } else if (side) {
    draw_side_view(canvas, views, scene);
  } else if (needs_close_up(scene)) {
    const double half = views.width / 2 - 12;
    draw_top_view(canvas, {views.left, views.top, half, views.height}, scene);
    draw_close_up(canvas, {views.right() - half, views.top, half, views.height}, scene);
  } else {
    draw_top_view(canvas, views, scene);
  }
  draw_legend(canvas, scene);
}

}  // namespace kenaf::draw
