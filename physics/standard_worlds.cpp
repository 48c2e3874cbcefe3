#include "physics/standard_worlds.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace kenaf::physics {
namespace {

constexpr double kObstacle_m = 1;  // x where it begins

WorldDescription world_with_ground(const char* family, double measure_m, double ground_z_m) {
  if (!(measure_m >= 1e-3 && measure_m <= 10))
    throw std::invalid_argument(fmt::format("a {} of {} m: must be from 0.001 to 10 m", family, measure_m));
  WorldDescription world;
  world.name = fmt::format("{}-{:g}", family, measure_m * 1000);
  world.planes.push_back({{{0, 0, ground_z_m}, Eigen::Quaterniond::Identity()}, 1});
  for (int i = 0; i < 4; ++i)
    world.start_poses.push_back({fmt::format("start_{:02}", i), {{-1.0 * i, 0, 0}, Eigen::Quaterniond::Identity()}});
  return world;
}

Box platform(const char* name, double from_x_m, double to_x_m, double width_m, double bottom_z_m, double top_z_m) {
  return {name,
          {to_x_m - from_x_m, width_m, top_z_m - bottom_z_m},
          {{(from_x_m + to_x_m) / 2, 0, (bottom_z_m + top_z_m) / 2}, Eigen::Quaterniond::Identity()},
          1,
          0};
}

}  // namespace

WorldDescription step_world(double height_m) {
  constexpr double kDepth_m = 3, kWidth_m = 2;
  WorldDescription world = world_with_ground("step", height_m, 0);
  world.boxes.push_back(platform("platform", kObstacle_m, kObstacle_m + kDepth_m, kWidth_m, 0, height_m));
  return world;
}

WorldDescription trench_world(double width_m) {
  constexpr double kDepth_m = 1, kPlatformWidth_m = 4, kNearLength_m = 6, kFarLength_m = 5;
  WorldDescription world = world_with_ground("trench", width_m, -kDepth_m);
  const double far_m = kObstacle_m + width_m;
  world.boxes.push_back(platform("near", kObstacle_m - kNearLength_m, kObstacle_m, kPlatformWidth_m, -kDepth_m, 0));
  world.boxes.push_back(platform("far", far_m, far_m + kFarLength_m, kPlatformWidth_m, -kDepth_m, 0));
  return world;
}

}  // namespace kenaf::physics
