// The one place where REP 103 frames (x forward, y left, z up) meet USARSim's (x forward, y right, z down).
//
// The two frames differ by half a turn about x: y and z change sign, and with them pitch and yaw. Roll keeps its sign.
//   REP 103: roll + right side down, pitch + nose down, yaw + counter-clockwise seen from above
//   USARSim: roll + right side down, pitch + nose up,   yaw + clockwise seen from above
// The map is its own inverse; the two names state the direction.
// Angles: radians, roll, pitch, yaw. Thread safety: pure functions.
#pragma once

#include <array>

#include "robot/parts.hpp"

namespace kenaf::protocol::frames {

using Vector3 = std::array<double, 3>;

Vector3 usarsim_vector_from_rep103(const Vector3& v);
Vector3 rep103_vector_from_usarsim(const Vector3& v);

Vector3 usarsim_angles_from_rep103(const Vector3& roll_pitch_yaw);
// Accepts UT2004's 0..2pi and UDK's signed angles; returns each angle in (-pi, pi].
Vector3 rep103_angles_from_usarsim(const Vector3& roll_pitch_yaw);

// USARSim turns all four flipper joints about the same body axis, positive nose down: a front flipper's tip goes up
// with a negative angle, a rear flipper's with a positive one (the UT2004 server and its clients). Kenaf counts tip
// up as positive for all four.
double usarsim_flipper_from_tip_up(robot::Flipper flipper, double tip_up_rad);
double tip_up_from_usarsim_flipper(robot::Flipper flipper, double joint_rad);

// The links of a camera mount turn about axes of the frame: pan about z, tilt about y. So USARSim's pan is positive to
// the right and its tilt positive up, and REP 103's to the left and down.
double usarsim_link_from_rep103(double angle_rad);
double rep103_link_from_usarsim(double angle_rad);

// The joint names of USARSim's Kenaf: "FLFlipper", "FRFlipper", "RLFlipper", "RRFlipper".
const char* usarsim_flipper_name(robot::Flipper flipper);

// USARSim commands a track by the spin of its driven wheel.
double spin_from_surface_speed(double speed_mps, double sprocket_radius_m);
double surface_speed_from_spin(double spin_radps, double sprocket_radius_m);

}  // namespace kenaf::protocol::frames
