// Signs and angles are converted between REP 103 (x forward, y left, z up) and USARSim (x forward, y right, z down).
// Left and up become negative, and so do nose down and counter-clockwise; the angle map must agree with the vector map
// for every rotation, not only about one axis. Angles come back in (-pi, pi], also from UT2004's 0..2pi. Tip up is
// negative for USARSim's front flippers and positive for its rear ones, and spin times radius is surface speed.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "formats/protocol/frames.hpp"
#include "robot/parts.hpp"

using namespace kenaf;
using namespace kenaf::protocol::frames;
using std::numbers::pi;

namespace {

// R = Rz(yaw) Ry(pitch) Rx(roll), the intrinsic z-y-x angles, applied to v. Written out here from the textbook.
Vector3 rotate(const Vector3& angles, const Vector3& v) {
  const double cr = std::cos(angles[0]), sr = std::sin(angles[0]);
  const double cp = std::cos(angles[1]), sp = std::sin(angles[1]);
  const double cy = std::cos(angles[2]), sy = std::sin(angles[2]);
  const Vector3 rolled{v[0], cr * v[1] - sr * v[2], sr * v[1] + cr * v[2]};
  const Vector3 pitched{cp * rolled[0] + sp * rolled[2], rolled[1], -sp * rolled[0] + cp * rolled[2]};
  return {cy * pitched[0] - sy * pitched[1], sy * pitched[0] + cy * pitched[1], pitched[2]};
}

}  // namespace

TEST_CASE("A point ahead, left and above has y and z negative in USARSim") {
  CHECK(usarsim_vector_from_rep103({1, 2, 3}) == Vector3{1, -2, -3});
  CHECK(rep103_vector_from_usarsim({1, -2, -3}) == Vector3{1, 2, 3});
}

TEST_CASE("Right side down keeps its sign, nose down and counter-clockwise change theirs") {
  CHECK(usarsim_angles_from_rep103({0.1, 0.2, 0.3}) == Vector3{0.1, -0.2, -0.3});
  CHECK(rep103_angles_from_usarsim({0.1, -0.2, -0.3}) == Vector3{0.1, 0.2, 0.3});
}

TEST_CASE("Rotating and then changing frames is changing frames and then rotating") {
  for (const Vector3& angles : {Vector3{0.3, 0, 0}, Vector3{0, 0.3, 0}, Vector3{0, 0, 0.3}, Vector3{0.4, -1.1, 2.5},
                                Vector3{-3.0, 0.7, -0.2}}) {
    for (const Vector3& v : {Vector3{1, 0, 0}, Vector3{0, 1, 0}, Vector3{0, 0, 1}}) {
      const Vector3 there = usarsim_vector_from_rep103(rotate(angles, v));
      const Vector3 other = rotate(usarsim_angles_from_rep103(angles), usarsim_vector_from_rep103(v));
      for (std::size_t i = 0; i < 3; ++i) CHECK(other[i] == Approx(there[i]).margin(1e-12));
    }
  }
}

TEST_CASE("A USARSim robot that looks down a slope to its right") {
  // Nose up is positive in USARSim: a nose that points down reports a negative pitch, +0.5 of ours.
  // Clockwise from above is positive in USARSim: a robot that turned right reports a positive yaw, -1 of ours.
  const Vector3 ours = rep103_angles_from_usarsim({0, -0.5, 1});
  CHECK(ours == Vector3{0, 0.5, -1});
  const Vector3 nose = rotate(ours, {1, 0, 0});
  CHECK(nose[2] < 0);  // below the horizon
  CHECK(nose[1] < 0);  // to the right
}

TEST_CASE("Angles come back wrapped to more than -pi and at most pi") {
  // A recorded UT2004 line has {Orientation 0.00,6.28,6.28}: level, 0.0032 short of the whole turn.
  const Vector3 level = rep103_angles_from_usarsim({0, 6.28, 6.28});
  CHECK(level[1] == Approx(2 * pi - 6.28));
  CHECK(level[2] == Approx(2 * pi - 6.28));
  CHECK(usarsim_angles_from_rep103({0, 0, pi})[2] == pi);
}

TEST_CASE("Raising all four flippers is front negative, rear positive") {
  // UsarCommander's "front up": MULTIDRIVE {FRFlipper -0.5*h} {FLFlipper -0.5*h} {RRFlipper +0.5*h} {RLFlipper +0.5*h}.
  struct Case {
    robot::Flipper flipper;
    const char* name;
    double joint_rad;
  };
  for (const Case& c : {Case{robot::kFrontLeft, "FLFlipper", -0.5},
                        {robot::kFrontRight, "FRFlipper", -0.5},
                        {robot::kRearLeft, "RLFlipper", 0.5},
                        {robot::kRearRight, "RRFlipper", 0.5}}) {
    CHECK(std::string(usarsim_flipper_name(c.flipper)) == c.name);
    CHECK(usarsim_flipper_from_tip_up(c.flipper, 0.5) == c.joint_rad);
    CHECK(tip_up_from_usarsim_flipper(c.flipper, c.joint_rad) == 0.5);
  }
}

TEST_CASE("A sprocket of 0.05 m that spins with 2 rad/s moves its belt with 0.1 m/s") {
  CHECK(surface_speed_from_spin(2, 0.05) == Approx(0.1));
  CHECK(spin_from_surface_speed(0.1, 0.05) == Approx(2));
  CHECK(spin_from_surface_speed(-0.1, 0.05) == Approx(-2));
}
