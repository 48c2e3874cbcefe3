// The robot's true outlines: each part is a convex solid given by points of its surface, and its outline in any view
// is the convex hull of their projections.
#pragma once

#include <vector>

#include "physics/world_description.hpp"
#include "tools/draw/canvas.hpp"
#include "tools/draw/driven_path.hpp"

namespace kenaf::draw {

// A picture plane in W, by its axes to the right and up.
struct Projection {
  Eigen::Vector3d right_W, up_W;
  Point operator()(const Eigen::Vector3d& p_W) const { return {right_W.dot(p_W), up_W.dot(p_W)}; }
  Eigen::Vector3d toward_viewer_W() const { return right_W.cross(up_W); }
};

enum class PartKind { hull, track, wheel, flipper };

struct Part {
  PartKind kind;
  double nearness;                         // of its centre: coordinate towards the viewer, m
  std::vector<Point> outline;              // convex, in the picture plane, m
  bool shows_face = false;                 // whether the viewer looks at the wheels rather than at the belt
  std::vector<Point> inside;               // of the belt's loop, on the face that the viewer sees
  std::vector<std::vector<Point>> wheels;  // likewise
  std::vector<std::vector<Point>> lugs;    // lines across the belt, on its upper run
};

// All parts, the farthest first.
std::vector<Part> robot_parts(const physics::RobotDescription& robot, const Posture& posture,
                              const Projection& projection);

std::vector<Point> box_outline(const physics::Box& box, const Projection& projection);

// The convex hull, counter-clockwise.
std::vector<Point> convex_hull(std::vector<Point> points);

// From metres in the picture plane to the canvas: equal scales, up is up.
struct Mapping {
  Rectangle area;   // on the canvas
  Point low, high;  // the shown part of the picture plane, m
  double pixels_per_metre() const { return area.width / (high.x() - low.x()); }
  Point operator()(const Point& p) const {
    return {area.left + (p.x() - low.x()) * pixels_per_metre(), area.bottom() - (p.y() - low.y()) * pixels_per_metre()};
  }
  std::vector<Point> operator()(const std::vector<Point>& points) const;
};

// The part of an outline's bounding box that lies in `area`; empty if width or height <= 0.
Rectangle seen_part(const std::vector<Point>& outline, const Rectangle& area);

// The mapping that shows low..high in `area`, grown to the area's shape about its centre.
Mapping fit(const Rectangle& area, Point low, Point high);

// Draws a robot. `paleness` from 0 to 1: how far back in time it stood there.
void draw_robot(const Canvas& canvas, const Mapping& map, const std::vector<Part>& parts, double paleness);

}  // namespace kenaf::draw
