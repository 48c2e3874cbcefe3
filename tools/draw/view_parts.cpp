#include "tools/draw/view_parts.hpp"

namespace kenaf::draw {

void Bounds::add(const std::vector<Point>& points) {
  for (const Point& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
}

void Bounds::grow(double margin_m) {
  low.array() -= margin_m;
  high.array() += margin_m;
}

Clip::Clip(const Canvas& canvas, const Rectangle& area) : cairo_(canvas.cairo()) {
  cairo_save(cairo_);
  canvas.rectangle(area);
  cairo_clip(cairo_);
}

Clip::~Clip() {
  cairo_restore(cairo_);
}

std::vector<Point> centre_line(const DrivenPath& path, const Projection& projection) {
  std::vector<Point> points;
  for (const Posture& posture : path.postures) points.push_back(projection(posture.X_WB.p));
  return points;
}

void draw_centre_line(const Canvas& canvas, const Mapping& map, const DrivenPath& path, const Projection& projection,
                      Colour colour, double width) {
  const std::vector<Point> line = map(centre_line(path, projection));
  canvas.polyline(line);
  canvas.stroke(palette::kPaper, width + 2.4, 0.85);
  canvas.polyline(line);
  canvas.stroke(colour, width);
}

void draw_end_mark(const Canvas& canvas, const Point& at, const Point& ahead, PathEnd which, Colour colour,
                   double size) {
  const Point sideways(-ahead.y(), ahead.x());
  const Point nose[] = {at + 2.6 * size * ahead, at + 1.35 * size * ahead + 0.75 * size * sideways,
                        at + 1.35 * size * ahead - 0.75 * size * sideways};
  canvas.polygon(nose);
  canvas.fill(colour);
  canvas.stroke(palette::kPaper, 1);
  canvas.circle(at, size);
  canvas.fill(which == PathEnd::start ? palette::kPaper : colour);
  canvas.stroke(which == PathEnd::start ? colour : palette::kPaper, which == PathEnd::start ? 0.45 * size : 0.3 * size);
}

void draw_path_end(const Canvas& canvas, const Mapping& map, const DrivenPath& path, const Projection& projection,
                   PathEnd which, Colour colour, double size) {
  const Posture& posture = which == PathEnd::start ? path.postures.front() : path.postures.back();
  const Eigen::Vector3d p_W = posture.X_WB.p;
  const Point at = map(projection(p_W));
  const Point ahead = map(projection(p_W + posture.X_WB.q * Eigen::Vector3d::UnitX())) - at;
  draw_end_mark(canvas, at, ahead.norm() > 1e-6 ? ahead.normalized() : Point(1, 0), which, colour, size);
}

}  // namespace kenaf::draw
