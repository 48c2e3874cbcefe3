// Shared parts of the views.
#pragma once

#include <vector>

#include "tools/draw/robot_shape.hpp"

namespace kenaf::draw {

inline const Projection kFromAbove{Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY()};

// A rectangle that grows around points of the picture plane.
struct Bounds {
  Point low{1e300, 1e300}, high{-1e300, -1e300};
  void add(const std::vector<Point>& points);
  void grow(double margin_m);
  double extent() const { return (high - low).maxCoeff(); }
};

// Nothing is drawn outside of `area` while this lives.
class Clip {
 public:
  Clip(const Canvas& canvas, const Rectangle& area);
  ~Clip();
  Clip(const Clip&) = delete;
  Clip& operator=(const Clip&) = delete;

 private:
  cairo_t* cairo_;
};

// The path of the body's centre.
std::vector<Point> centre_line(const DrivenPath& path, const Projection& projection);
void draw_centre_line(const Canvas& canvas, const Mapping& map, const DrivenPath& path, const Projection& projection,
                      Colour colour, double width);

// A ring at a path's start, a disc at its end, each with a nose in the robot's direction.
enum class PathEnd { start, end };
void draw_path_end(const Canvas& canvas, const Mapping& map, const DrivenPath& path, const Projection& projection,
                   PathEnd which, Colour colour, double size);
// The same mark at a place of the canvas; `ahead` is a unit vector there.
void draw_end_mark(const Canvas& canvas, const Point& at, const Point& ahead, PathEnd which, Colour colour,
                   double size);

}  // namespace kenaf::draw
