#include "hrt/presentation.hpp"
#include "robot/state.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace kenaf::hrt {
namespace {

static_assert(static_cast<int>(HRT_HAS_POSTURE) == static_cast<int>(robot::kHasPosture) &&
              static_cast<int>(HRT_HAS_ENCODERS) == static_cast<int>(robot::kHasEncoders) &&
              static_cast<int>(HRT_HAS_FLIPPERS) == static_cast<int>(robot::kHasFlippers) &&
              static_cast<int>(HRT_HAS_CURRENTS) == static_cast<int>(robot::kHasCurrents) &&
              static_cast<int>(HRT_HAS_BATTERY) == static_cast<int>(robot::kHasBattery) &&
              static_cast<int>(HRT_HAS_INERTIAL) == static_cast<int>(robot::kHasInertial) &&
              static_cast<int>(HRT_HAS_POSE) == static_cast<int>(robot::kHasGroundTruth));
constexpr std::uint32_t kValidBits = 0x7f;

template <typename From, typename To>
void scale(const From& from, double factor, To& to) {
  for (std::size_t i = 0; i < from.size(); ++i) to[i] = from[i] * factor;
}

}  // namespace

hrt_state state_from(const Snapshot& snapshot) {
  // Every quantity is copied, measured or not; `valid` tells which ones are.
  const robot::State& measured = snapshot.measured;
  hrt_state state{};
  state.size = sizeof state;
  state.valid = measured.fields & kValidBits;

  // Activity, as seen by the library and by the robot.
  const auto flag = [](bool on, std::uint32_t bit) { return on ? bit : 0u; };
  state.activity = flag(snapshot.motion_active, HRT_MOTION_ACTIVE) | flag(snapshot.paused, HRT_PAUSED) |
                   flag(snapshot.stopped_by_silence || measured.stopped_by_silence, HRT_STOPPED_BY_SILENCE) |
                   flag(snapshot.recording, HRT_RECORDING) | flag(snapshot.lockstep, HRT_IN_LOCKSTEP) |
                   flag(!snapshot.warning.empty(), HRT_DEGRADED);
  // A flipper that the robot has not ignores its commands.
  for (std::size_t i = 0; i < robot::kFlipperCount; ++i) {
    const bool is_there = !std::isnan(measured.flipper_rad[i]);  // robot::kNoFlipper
    state.flippers_commanded |=
        flag(is_there && snapshot.commanded.flipper[i].mode == robot::JointMode::angle, 1u << i);
  }
  state.cycle = measured.frame;
  state.time_s = measured.robot_time_s;

  // Measured: posture and inertial, then drives and battery.
  state.roll_deg = measured.posture_rad[0] * kDegrees;
  state.pitch_deg = measured.posture_rad[1] * kDegrees;
  state.yaw_deg = measured.posture_rad[2] * kDegrees;
  scale(measured.gyro_radps, kDegrees, state.gyro_degps);
  scale(measured.acceleration_mps2, kMillimetres, state.acceleration_mmps2);

  scale(measured.track_m, kMillimetres, state.track_mm);
  scale(measured.track_mps, kMillimetres, state.track_mmps);
  scale(measured.track_a, 1, state.track_a);
  for (std::size_t i = 0; i < robot::kFlipperCount; ++i) {
    const double angle_rad = measured.flipper_rad[i];
    state.flipper_deg[i] = std::isnan(angle_rad) ? 0 : angle_rad * kDegrees;  // robot::kNoFlipper
  }
  scale(measured.flipper_a, 1, state.flipper_a);
  state.battery_v = measured.battery_v;

  // Odometry is the estimate's; the pose is the simulator's ground truth.
  state.odometry_x_mm = snapshot.estimate.odometry_x_m * kMillimetres;
  state.odometry_y_mm = snapshot.estimate.odometry_y_m * kMillimetres;
  state.odometry_yaw_deg = snapshot.estimate.odometry_yaw_rad * kDegrees;

  state.pose_x_mm = measured.p_WB_m[0] * kMillimetres;
  state.pose_y_mm = measured.p_WB_m[1] * kMillimetres;
  state.pose_z_mm = measured.p_WB_m[2] * kMillimetres;
  state.pose_roll_deg = measured.orientation_rad[0] * kDegrees;
  state.pose_pitch_deg = measured.orientation_rad[1] * kDegrees;
  state.pose_yaw_deg = measured.orientation_rad[2] * kDegrees;

  // The command in force and the health of the link.
  scale(snapshot.commanded.track_speed_mps, kMillimetres, state.commanded_track_mmps);
  for (std::size_t i = 0; i < robot::kFlipperCount; ++i)
    state.commanded_flipper_deg[i] = snapshot.commanded.flipper[i].value * kDegrees;

  state.round_trip_ms = snapshot.round_trip_s * 1e3;
  state.late_cycles = measured.late_commands;
  state.lost_cycles = snapshot.lost_cycles;
  return state;
}

std::string status_text(const hrt_state& state, const std::string& library) {
  // Head line: time, cycle, and one word in brackets for each activity.
  const auto has = [&](std::uint32_t bit) { return (state.valid & bit) != 0; };
  std::string text = fmt::format("Kenaf ({})  t = {:.3f} s  cycle {}", library, state.time_s, state.cycle);
  for (const auto& [bit, words] :
       {std::pair{HRT_MOTION_ACTIVE, "in motion"}, std::pair{HRT_PAUSED, "paused"},
        std::pair{HRT_STOPPED_BY_SILENCE, "stopped by silence"}, std::pair{HRT_RECORDING, "recording"},
        std::pair{HRT_IN_LOCKSTEP, "lock step"}, std::pair{HRT_DEGRADED, "degraded"}}) {
    if ((state.activity & static_cast<std::uint32_t>(bit)) != 0) text += fmt::format("  [{}]", words);
  }
  text += '\n';

  // One line for each group of quantities that the robot measures.
  if (has(HRT_HAS_POSTURE)) {
    text += fmt::format("  posture   roll {:.2f}  pitch {:.2f}  yaw {:.2f} deg\n", state.roll_deg, state.pitch_deg,
                        state.yaw_deg);
  }
  if (has(HRT_HAS_ENCODERS)) {
    text += fmt::format("  tracks    left {:.1f} mm at {:.1f} mm/s  right {:.1f} mm at {:.1f} mm/s\n",
                        state.track_mm[HRT_LEFT], state.track_mmps[HRT_LEFT], state.track_mm[HRT_RIGHT],
                        state.track_mmps[HRT_RIGHT]);
    text += fmt::format("  odometry  x {:.1f}  y {:.1f} mm  yaw {:.2f} deg\n", state.odometry_x_mm, state.odometry_y_mm,
                        state.odometry_yaw_deg);
  }
  if (has(HRT_HAS_FLIPPERS)) {
    text += fmt::format("  flippers  front {:.1f} {:.1f}  rear {:.1f} {:.1f} deg (left right)\n",
                        state.flipper_deg[HRT_FRONT_LEFT], state.flipper_deg[HRT_FRONT_RIGHT],
                        state.flipper_deg[HRT_REAR_LEFT], state.flipper_deg[HRT_REAR_RIGHT]);
  }
  if (has(HRT_HAS_CURRENTS)) {
    text += fmt::format("  currents  tracks {:.2f} {:.2f}  flippers {:.2f} {:.2f} {:.2f} {:.2f} A\n",
                        state.track_a[HRT_LEFT], state.track_a[HRT_RIGHT], state.flipper_a[0], state.flipper_a[1],
                        state.flipper_a[2], state.flipper_a[3]);
  }
  if (has(HRT_HAS_BATTERY)) text += fmt::format("  battery   {:.2f} V\n", state.battery_v);
  if (has(HRT_HAS_POSE)) {
    text += fmt::format("  pose      x {:.1f}  y {:.1f}  z {:.1f} mm  roll {:.2f}  pitch {:.2f}  yaw {:.2f} deg\n",
                        state.pose_x_mm, state.pose_y_mm, state.pose_z_mm, state.pose_roll_deg, state.pose_pitch_deg,
                        state.pose_yaw_deg);
  }

  // The link is always reported.
  text += fmt::format("  link      round trip {:.3f} ms  late {}  lost {}\n", state.round_trip_ms, state.late_cycles,
                      state.lost_cycles);
  return text;
}

}  // namespace kenaf::hrt
