#include "rollout/engines/engine_scene.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "physics/robot_shapes.hpp"
#include "robot/angles.hpp"

namespace kenaf::engines {
namespace {

using namespace physics;

constexpr double kDrive_mps = 0.2;
// As in physics/dynamics/flipper_joint.cpp, the last two for prescribed motion.
constexpr double kServoGain_per_s = 30;
constexpr double kFastest_radps = 10;
constexpr double kAnyTorque_nm = 1e6;

EngineScene climb(const std::string& name, WorldDescription world, double x_m, double z_m, double front_rad,
                  double rear_rad, double duration_s) {
  EngineScene scene;
  scene.name = name;
  scene.world = std::move(world);
  scene.robot = load_robot("kenaf");
  scene.X_start.p = {x_m, 0, z_m};
  scene.command.track_speed_mps = {kDrive_mps, kDrive_mps};
  for (const robot::Flipper f : {robot::kFrontLeft, robot::kFrontRight})
    scene.command.flipper[f] = {robot::JointMode::angle, front_rad};
  for (const robot::Flipper f : {robot::kRearLeft, robot::kRearRight})
    scene.command.flipper[f] = {robot::JointMode::angle, rear_rad};
  scene.duration_s = duration_s;
  return scene;
}

WorldDescription shipped(const std::string& name) {
  std::vector<std::string> unsupported;
  WorldDescription world = load_world(name, unsupported);
  if (!unsupported.empty()) throw std::runtime_error(unsupported.front());
  return world;
}

std::vector<Eigen::Vector3d> hull_of(const Outline& outline, double width_m, const Eigen::Vector3d& center) {
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector2d& p : outline)
    for (const double y : {-width_m / 2, width_m / 2}) points.emplace_back(center + Eigen::Vector3d(p.x(), y, p.y()));
  return points;
}

// As many contacts as Kenaf, which on a plane has two at each end of its pieces; the other engines have four for each
// box and two for each drum: 4 boxes + 4 >= 2 (pieces + 1).
int boxes_of(const TrackDescription& track) {
  return track.straight_m() > 0 ? std::max(1, (2 * (track.pieces + 1) - 4 + 3) / 4) : 0;
}

Belted track_at(const TrackDescription& track, const Eigen::Vector3d& center, std::optional<robot::Track> side) {
  const Eigen::Vector3d to_drum(track.straight_m() / 2, 0, 0);
  return {center - to_drum,      center + to_drum,
          track.end_radius_m,    track.end_radius_m,
          track.width_m,         track.friction_along,
          track.friction_across, side,
          boxes_of(track),       hull_of(track_outline(track), track.width_m, center)};
}

}  // namespace

std::vector<EngineScene> climbs() {
  const double z_m = load_robot("kenaf").ride_height_m();
  return {climb("straight, level", shipped("flat"), 0, z_m, 1, 1, 5),
          climb("step of 100 mm", shipped("step-100"), 0.3, z_m, 0.8, 0, 7),
          climb("step of 200 mm", shipped("step-200"), 0.3, z_m, 0.8, 0, 7),
          climb("trench of 300 mm", shipped("trench-300"), 0.4, z_m, 0, 0, 7)};
}

EngineScene on_plane(const RobotDescription& robot, double slope_rad) {
  EngineScene scene;
  const Pose X_WP{Eigen::Vector3d::Zero(), rotation_from({0, slope_rad, 0})};
  scene.world.planes.push_back({X_WP, 1});
  scene.robot = robot;
  scene.X_start = compose(X_WP, {{0, 0, robot.ride_height_m()}, Eigen::Quaterniond::Identity()});
  scene.command.flipper.fill({robot::JointMode::angle, 1});
  return scene;
}

robot::Flipper flipper_of_arm(const RobotDescription& robot, std::size_t arm) {
  return static_cast<robot::Flipper>(robot.has(robot::kFrontLeft) ? arm : robot::kRearLeft + arm);
}

double flipper_at_start(const EngineScene& scene, std::size_t arm) {
  return scene.prescribed.empty() ? scene.robot->flipper.front().start_angle_rad
                                  : scene.prescribed.front().flipper_rad[flipper_of_arm(*scene.robot, arm)];
}

double servo_torque_nm(const EngineScene& scene) {
  return scene.prescribed.empty() ? scene.robot->servo.max_torque_nm : kAnyTorque_nm;
}

RobotParts parts_of(const RobotDescription& robot) {
  RobotParts parts;
  for (const robot::Track side : {robot::kLeft, robot::kRight}) {
    for (const TrackDescription& track : robot.track)
      parts.tracks.push_back(track_at(track, track.center_m(side), side));
  }
  for (const CasterDescription& caster : robot.caster)
    parts.tracks.push_back(track_at(caster.as_wheel(), caster.p_BC_m, std::nullopt));

  // Flippers, of uniform density: moments from the outline's second moments per area.
  if (!robot.has_flippers()) return parts;
  const FlipperDescription& f = robot.flipper.front();
  const Outline outline = flipper_outline(f);
  const OutlineMoments m = moments(outline);
  const double xx = m.Ixx / m.area, zz = m.Izz / m.area, yy = f.width_m * f.width_m / 12;
  for (const robot::Flipper which : {robot::kFrontLeft, robot::kFrontRight, robot::kRearLeft, robot::kRearRight}) {
    if (!robot.has(which)) continue;
    const bool front = robot::is_front(which);
    const robot::Track side = robot::side_of(which);
    const Eigen::Vector3d pivot(front ? f.p_BPivot_m.x() : -f.p_BPivot_m.x(),
                                side == robot::kLeft ? f.p_BPivot_m.y() : -f.p_BPivot_m.y(), f.p_BPivot_m.z());
    // A rear flipper is a front one turned by 180 degrees.
    const Eigen::Quaterniond turn = front ? Eigen::Quaterniond::Identity() : Eigen::Quaterniond(0, 0, 0, 1);
    parts.arms.push_back({{Eigen::Vector3d::Zero(),
                           {f.length_m, 0, 0},
                           f.pivot_radius_m,
                           f.tip_radius_m,
                           f.width_m,
                           f.friction_along,
                           f.friction_across,
                           f.belt_driven ? std::optional(side) : std::nullopt,
                           1,
                           hull_of(outline, f.width_m, Eigen::Vector3d::Zero())},
                          f.mass_kg,
                          {m.centroid.x(), 0, m.centroid.y()},
                          f.mass_kg * Eigen::Vector3d(zz + yy, xx + zz, xx + yy),
                          {pivot, turn}});
  }
  return parts;
}

std::vector<Cuboid> straight_part(const Belted& shape, int boxes) {
  const Eigen::Vector3d size((shape.p_front_m - shape.p_rear_m).x() / boxes, shape.width_m,
                             2 * std::min(shape.rear_radius_m, shape.front_radius_m));
  std::vector<Cuboid> out;
  if (shape.boxes == 0) return out;
  for (int i = 0; i < boxes; ++i)
    out.push_back({shape.p_rear_m + (shape.p_front_m - shape.p_rear_m) * ((i + 0.5) / boxes), size});
  return out;
}

Drives::Drives(const EngineScene& scene)
    : command_(scene.command), prescribed_(scene.prescribed), time_step_s_(scene.time_step_s) {
  if (!scene.robot) return;
  first_arm_ = flipper_of_arm(*scene.robot, 0);
  const TrackDriveDescription& drive = scene.robot->drive;
  if (drive.time_constant_s > 0) share_ = -std::expm1(-scene.time_step_s / drive.time_constant_s);
  max_mps_ = drive.max_speed_mps;
  max_radps_ = prescribed_.empty() ? scene.robot->servo.max_speed_radps : kFastest_radps;
  servo_gain_per_s_ = prescribed_.empty() ? kServoGain_per_s : 1 / scene.time_step_s;
}

void Drives::advance_as_prescribed() {
  // Between the samples before and after the end of the step.
  time_s_ += time_step_s_;
  while (next_ + 1 < prescribed_.size() && prescribed_[next_].t_s < time_s_) ++next_;
  const DriveSample &before = prescribed_[next_ > 0 ? next_ - 1 : 0], &after = prescribed_[next_];
  const double span_s = after.t_s - before.t_s;
  const double share = span_s > 0 ? std::clamp((time_s_ - before.t_s) / span_s, 0.0, 1.0) : 1;
  for (std::size_t i = 0; i < robot::kTrackCount; ++i)
    belt_mps_[i] = std::lerp(before.belt_mps[i], after.belt_mps[i], share);
  for (std::size_t i = 0; i < robot::kFlipperCount; ++i)
    command_.flipper[i].value = std::lerp(before.flipper_rad[i], after.flipper_rad[i], share);
}

void Drives::advance() {
  if (!prescribed_.empty()) {
    advance_as_prescribed();
    return;
  }
  for (std::size_t i = 0; i < robot::kTrackCount; ++i)
    belt_mps_[i] += share_ * (std::clamp(command_.track_speed_mps[i], -max_mps_, max_mps_) - belt_mps_[i]);
}

double Drives::flipper_radps(std::size_t arm, double angle_rad) const {
  const double apart_rad = robot::wrap_angle(flipper_rad(arm) - angle_rad);
  return std::clamp(servo_gain_per_s_ * apart_rad, -max_radps_, max_radps_);
}

}  // namespace kenaf::engines
