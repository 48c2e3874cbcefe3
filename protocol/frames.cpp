#include "protocol/frames.hpp"

#include <cmath>
#include <numbers>

namespace kenaf::frames {

namespace {

bool is_front(relay::Flipper flipper) {
  return flipper == relay::kFrontLeft || flipper == relay::kFrontRight;
}

// Half a turn about x, the map between the two frames. It is its own inverse.
Vector3 half_turn_about_x(const Vector3& v) {
  return {v[0], -v[1], -v[2]};
}

Vector3 wrapped(const Vector3& angles) {
  return {wrap_angle(angles[0]), wrap_angle(angles[1]), wrap_angle(angles[2])};
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

double usarsim_flipper_from_tip_up(relay::Flipper flipper, double tip_up_rad) {
  return is_front(flipper) ? -tip_up_rad : tip_up_rad;
}

double tip_up_from_usarsim_flipper(relay::Flipper flipper, double joint_rad) {
  return is_front(flipper) ? -joint_rad : joint_rad;
}

double usarsim_link_from_rep103(double angle_rad) {
  return -angle_rad;
}

double rep103_link_from_usarsim(double angle_rad) {
  return -angle_rad;
}

const char* usarsim_flipper_name(relay::Flipper flipper) {
  switch (flipper) {
    case relay::kFrontLeft:
      return "FLFlipper";
    case relay::kFrontRight:
      return "FRFlipper";
    case relay::kRearLeft:
      return "RLFlipper";
    case relay::kRearRight:
      return "RRFlipper";
    case relay::kFlipperCount:
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

double wrap_angle(double angle_rad) {
  const double wrapped_rad = std::remainder(angle_rad, 2 * std::numbers::pi);  // in [-pi, pi]
  return wrapped_rad <= -std::numbers::pi ? std::numbers::pi : wrapped_rad;
}

}  // namespace kenaf::frames
