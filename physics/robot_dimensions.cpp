#include "physics/robot_dimensions.hpp"

namespace kenaf::physics {

RobotDimensions dimensions_of(const RobotDescription& robot) {
  RobotDimensions out;
  out.body_size_m = robot.body.size_m;
  for (const TrackDescription& track : robot.track)
    out.tracks.push_back({track.length_m, track.end_radius_m, track.width_m, track.p_BT_m});
  for (const CasterDescription& caster : robot.caster)
    out.casters.push_back({2 * caster.radius_m, caster.radius_m, caster.width_m, caster.p_BC_m});
  out.ride_height_m = robot.ride_height_m();
  out.max_speed_mps = robot.drive.max_speed_mps;
  for (std::size_t i = 0; i < robot::kFlipperCount; ++i) out.has_flipper[i] = robot.has(static_cast<robot::Flipper>(i));
  if (!out.has_flippers()) return out;
  const FlipperDescription& flipper = robot.flipper.front();
  out.flipper_length_m = flipper.length_m;
  out.pivot_radius_m = flipper.pivot_radius_m;
  out.tip_radius_m = flipper.tip_radius_m;
  out.flipper_width_m = flipper.width_m;
  out.p_BPivot_m = flipper.p_BPivot_m;
  out.min_angle_rad = flipper.min_angle_rad;
  out.max_angle_rad = flipper.max_angle_rad;
  out.max_flipper_radps = robot.servo.max_speed_radps;
  return out;
}

}  // namespace kenaf::physics
