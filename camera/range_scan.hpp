// A range scanner: rays in a fan, by the same ray caster as the pictures, many at once.
//
// Thread safety: none; one for each thread.
#pragma once

#include <optional>
#include <vector>

#include "camera/scene.hpp"

namespace kenaf::camera {

struct RangeScan {
  physics::Pose X_WS;        // the fan lies in the x-y plane of S, symmetric about x
  double field_of_view_rad;  // between the first ray and the last
  std::size_t ray_count;     // evenly spaced, the left end first; one: along x
  double max_range_m;
  std::optional<physics::RobotId> ignored;  // a robot that the rays pass through, as a rule the scanner's own
};

class RangeScanner {
 public:
  // The distance along each ray to the first surface; more than max_range_m (infinity): there is none so near. Within
  // 0.1 mm and 1e-6 of the distance of the physics' own geometry, but for round parts of robots, which are polygons
  // here.
  void scan(const Scene& scene, const RangeScan& request, std::vector<double>& out);

 private:
  RayBatch rays_;
};

}  // namespace kenaf::camera
