// A range scanner: a fan of rays, cast together by the same ray caster as the pictures.
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
  // Sets `out` to the distance along each ray to the first surface, infinity if it is beyond max_range_m. Agrees with
  // the physics' own geometry to 0.1 mm and 1e-6 of the distance, except for round parts of robots, which are polygons
  // here.
  void scan(const Scene& scene, const RangeScan& request, std::vector<double>& out);

 private:
  RayBatch rays_;
};

}  // namespace kenaf::camera
