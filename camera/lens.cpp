#include "camera/lens.hpp"

#include <cmath>

namespace kenaf::camera {

double focal_length_px(const Lens& lens) {
  return lens.width / (2 * std::tan(lens.field_of_view_rad / 2));
}

Lens half_size(const Lens& lens) {
  const int width = (lens.width + 1) / 2, height = (lens.height + 1) / 2;
  const double half_focal_length_px = focal_length_px(lens) / 2;
  return {width, height, 2 * std::atan(width / (2 * half_focal_length_px))};
}

std::optional<Pixel> project(const View& view, const Eigen::Vector3d& p_W) {
  const Eigen::Vector3d p_C = view.X_WC.q.conjugate() * (p_W - view.X_WC.p);
  if (!(p_C.x() > 0)) return std::nullopt;
  const double f = focal_length_px(view.lens) / p_C.x();
  return Pixel{view.lens.width / 2.0 - f * p_C.y(), view.lens.height / 2.0 - f * p_C.z()};
}

Eigen::Vector3d ray(const View& view, Pixel pixel) {
  const double f = focal_length_px(view.lens);
  return view.X_WC.q *
         Eigen::Vector3d(1, (view.lens.width / 2.0 - pixel.u) / f, (view.lens.height / 2.0 - pixel.v) / f);
}

bool in_picture(const Lens& lens, Pixel pixel) {
  return pixel.u >= 0 && pixel.u < lens.width && pixel.v >= 0 && pixel.v < lens.height;
}

}  // namespace kenaf::camera
