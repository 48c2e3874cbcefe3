// A pinhole camera: projection of points into the picture, and rays through pixels.
//
// Camera frame C (REP 103, the body's convention, not the optical one): origin at the pinhole, x along the optical
// axis, y left, z up. Picture: u to the right, v down, in pixels, from the upper left corner of the upper left pixel;
// so the centre of the pixel in column i and row j is (i + 0.5, j + 0.5), and the optical axis goes through (width / 2,
// height / 2). Pixels are square. No distortion. Thread safety: pure functions.
#pragma once

#include <optional>

#include "physics/pose.hpp"

namespace kenaf::camera {

struct Lens {
  int width, height;         // pixels, 1 to 16384
  double field_of_view_rad;  // between the picture's left and right border: above 0, below pi
};

struct View {
  Lens lens;
  physics::Pose X_WC;
};

struct Pixel {
  double u, v;
};

// The focal length f in pixels: a point at (1, y, z) in C is at u = width / 2 - f y, v = height / 2 - f z.
double focal_length_px(const Lens& lens);

// The lens that shows the same with half of the pixels across and down, rounded up. An odd number of them across widens
// the picture by up to half a pixel on each side, and one down by as much above and below.
Lens half_size(const Lens& lens);

// Projects a point into the picture, continued beyond its border. Empty if the point is behind the camera or in the
// pinhole's plane.
std::optional<Pixel> project(const View& view, const Eigen::Vector3d& p_W);

// The ray through a pixel, in W. Not of unit length: its component along the optical axis is 1, so that view.X_WC.p
// plus `z` times the ray is at depth `z`. project() maps every such point with z > 0 back to the pixel.
Eigen::Vector3d ray(const View& view, Pixel pixel);

// Whether a pixel lies in the picture.
bool in_picture(const Lens& lens, Pixel pixel);

}  // namespace kenaf::camera
