#include "formats/protocol/frames.hpp"
#include "robot/angles.hpp"

#include <cmath>
#include <numbers>

namespace kenaf::protocol::frames {

namespace {

// Half a turn about x, the map between the two frames. It is its own inverse.
Vector3 half_turn_about_x(const Vector3& v) {
  return {v[0], -v[1], -v[2]};
}

Vector3 wrapped(const Vector3& angles) {
  return {robot::wrap_angle(angles[0]), robot::wrap_angle(angles[1]), robot::wrap_angle(angles[2])};
}

}  // namespace

Vector3 usarsim_vector_from_rep103(const Vector3& v) {
  return half_turn_about_x(v);
}
Vector3 rep103_vector_from_usarsim(const Vector3& v) {
  return half_turn_about_x(v);
}

// R' = D R D with D = diag(1, -1, -1) turns Rz(yaw) Ry(pitch) Rx(roll) into Rz(-yaw) Ry(-pitch) Rx(roll).
Vector3 usarsim_angles_from_rep103(const Vector3& roll_pitch_yaw) {
  return wrapped(half_turn_about_x(roll_pitch_yaw));
}
Vector3 rep103_angles_from_usarsim(const Vector3& roll_pitch_yaw) {
  return wrapped(half_turn_about_x(roll_pitch_yaw));
}

double usarsim_flipper_from_tip_up(robot::Flipper flipper, double tip_up_rad) {
  return robot::is_front(flipper) ? -tip_up_rad : tip_up_rad;
}

double tip_up_from_usarsim_flipper(robot::Flipper flipper, double joint_rad) {
  return robot::is_front(flipper) ? -joint_rad : joint_rad;
}

double usarsim_link_from_rep103(double angle_rad) {
  return -angle_rad;
}

double rep103_link_from_usarsim(double angle_rad) {
  return -angle_rad;
}

const char* usarsim_flipper_name(robot::Flipper flipper) {
  switch (flipper) {
    case robot::kFrontLeft:
      return "FLFlipper";
    case robot::kFrontRight:
      return "FRFlipper";
    case robot::kRearLeft:
      return "RLFlipper";
    case robot::kRearRight:
      return "RRFlipper";
    case robot::kFlipperCount:
      break;
  }
  return "";
}

double spin_from_surface_speed(double speed_mps, double sprocket_radius_m) {
  return speed_mps / sprocket_radius_m;
}
double surface_speed_from_spin(double spin_radps, double sprocket_radius_m) {
  return spin_radps * sprocket_radius_m;
}

}  // namespace kenaf::protocol::frames
