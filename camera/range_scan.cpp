#include "camera/range_scan.hpp"

#include <cmath>
#include <limits>

namespace kenaf::camera {

namespace {

constexpr float kBeyond_m = 1e-4f;  // a ray that passes through a surface continues this far behind it

bool passes(FaceId face, const std::pair<FaceId, FaceId>& through) {
  return face != kNothing && face >= through.first && face < through.second;
}

}  // namespace

void RangeScanner::scan(const Scene& scene, const RangeScan& request, std::vector<double>& out) {
  const std::size_t count = request.ray_count;
  const Eigen::Vector3f from = request.X_WS.p.cast<float>();
  rays_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double share = count > 1 ? static_cast<double>(i) / static_cast<double>(count - 1) : 0.5;
    const double angle_rad = request.field_of_view_rad * (0.5 - share);
    const Eigen::Vector3f along =
        (request.X_WS.q * Eigen::Vector3d(std::cos(angle_rad), std::sin(angle_rad), 0)).cast<float>();
    rays_.from_x[i] = from.x();
    rays_.from_y[i] = from.y();
    rays_.from_z[i] = from.z();
    rays_.along_x[i] = along.x();
    rays_.along_y[i] = along.y();
    rays_.along_z[i] = along.z();
    rays_.near[i] = 0;
    rays_.far[i] = static_cast<float>(request.max_range_m);
  }
  const auto through = request.ignored ? scene.faces_of(*request.ignored) : std::pair<FaceId, FaceId>{0, 0};

  // Cast until no ray ends at the robot that is passed through: those that do continue behind the hit.
  for (bool again = true; again;) {
    scene.cast(rays_);
    again = false;
    for (std::size_t i = 0; i < count; ++i) {
      if (!passes(rays_.face[i], through)) continue;
      rays_.near[i] = rays_.far[i] + kBeyond_m;
      rays_.far[i] = static_cast<float>(request.max_range_m);
      again = true;
    }
    // Rays that met something else are cast again with full range, as rounding may place their hit beyond their end.
    for (std::size_t i = 0; again && i < count; ++i)
      if (rays_.face[i] != kNothing && !passes(rays_.face[i], through))
        rays_.far[i] = static_cast<float>(request.max_range_m);
  }
  out.resize(count);
  for (std::size_t i = 0; i < count; ++i)
    out[i] = rays_.face[i] == kNothing ? std::numeric_limits<double>::infinity() : static_cast<double>(rays_.far[i]);
}

}  // namespace kenaf::camera
