// Frames of a run: which rows are frames, what is interpolated, what makes a run unusable; moving to a common start.
#include "gap/compare/pose_frames.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::compare;
using std::numbers::pi;

namespace {

std::vector<PoseFrame> frames_of(std::string_view csv) {
  const PoseFrames result = pose_frames(runs::parse_run(csv, "run.csv"));
  CHECK(result.unusable.empty());
  return result.frames;
}

std::string why_unusable(std::string_view csv) {
  const PoseFrames result = pose_frames(runs::parse_run(csv, "run.csv"));
  CHECK(result.frames.empty());
  return result.unusable;
}

// A robot that drives 1 m along its own x axis, from (x, y) with a heading.
std::vector<PoseFrame> straight(double x_m, double y_m, double yaw_rad) {
  std::vector<PoseFrame> frames;
  for (int i = 0; i <= 10; ++i) {
    const double s = 0.1 * i;
    frames.push_back(
        {s, x_m + s * std::cos(yaw_rad), 0.1 + 0.02 * i, y_m + s * std::sin(yaw_rad), 0.01, -0.2, yaw_rad});
  }
  return frames;
}

}  // namespace

TEST_CASE("A row with both x and z is a frame, no place is made up between them") {
  const auto frames = frames_of("t_s,x_m,z_m\n0,0,0.1\n1,1,\n2,,0.3\n3,3,0.4\n");
  REQUIRE(frames.size() == 2);
  CHECK(frames[1].t_s == 3);
  CHECK(frames[1].z_m == 0.4);
  CHECK(std::isnan(frames[1].y_m));
  CHECK(std::isnan(frames[1].pitch_rad));
}

TEST_CASE("Angles of a slower sensor are interpolated between measurements, never beyond them") {
  const auto frames = frames_of("t_s,x_m,z_m,pitch_rad,y_m\n0,0,0,,\n1,0,0,0.1,1\n2,0,0,,\n4,0,0,0.4,2\n5,0,0,,\n");
  REQUIRE(frames.size() == 5);
  CHECK(std::isnan(frames[0].pitch_rad));
  CHECK(frames[1].pitch_rad == 0.1);
  CHECK(frames[2].pitch_rad == Approx(0.2));  // a third of the way from 0.1 at 1 s to 0.4 at 4 s
  CHECK(frames[2].y_m == Approx(4.0 / 3));
  CHECK(frames[3].pitch_rad == 0.4);
  CHECK(std::isnan(frames[4].pitch_rad));
}

TEST_CASE("Measurements in rows without a place count for the interpolation") {
  const auto frames = frames_of("t_s,x_m,z_m,yaw_rad\n0,,,1\n1,0,0,\n2,,,3\n3,0,0,3\n");
  REQUIRE(frames.size() == 2);
  CHECK(frames[0].yaw_rad == Approx(2));
}

TEST_CASE("Angles are interpolated the shorter way round") {
  const auto frames = frames_of("t_s,x_m,z_m,yaw_rad\n0,0,0,3.1\n1,0,0,\n2,0,0,-3.1\n");
  CHECK(wrapped(frames[1].yaw_rad - pi) == Approx(0).margin(1e-12));  // half way between, over pi
}

TEST_CASE("Why a run cannot be compared") {
  CHECK(why_unusable("t_s,x_m\n0,0\n1,0\n") == "neither z_m nor y_m was measured");
  CHECK(why_unusable("t_s,x_m,z_m,y_m\n0,0,,\n1,0,,\n") == "neither z_m nor y_m was measured");
  CHECK(why_unusable("t_s,z_m\n0,0\n1,0\n") == "x_m was not measured");
  CHECK(why_unusable("t_s\n0\n1\n") == "x_m was not measured");
  CHECK(why_unusable("t_s,x_m,z_m\n0,0,0\n1,0,\n") == "fewer than two rows have both x_m and z_m");
  CHECK(why_unusable("t_s,x_m,z_m\n0,0,0\n1,2e6,0\n") == "x_m is beyond 1000 km");
  CHECK(why_unusable("t_s,x_m,z_m,yaw_rad\n0,0,0,1e300\n1,0,0,0\n") == "yaw_rad is beyond 1000000 rad");
  CHECK(why_unusable("t_s,x_m,z_m\n-1e300,0,0\n1,0,0\n") == "t_s is beyond 1000000000 s");
}

TEST_CASE("A run without a height has frames in the ground plane") {
  const auto planar = frames_of("t_s,x_m,y_m,yaw_rad\n0,0,0,0\n1,1,,0\n2,2,0.5,0.1\n");
  REQUIRE(planar.size() == 2);  // the middle row has no place
  CHECK(std::isnan(planar[1].z_m));
  CHECK(planar[1].y_m == 0.5);
  // a column that is there and empty is no height
  CHECK(frames_of("t_s,x_m,y_m,z_m\n0,0,0,\n1,1,1,\n").size() == 2);

  // two runs are compared in the plane that both have
  const auto whole = frames_of("t_s,x_m,y_m,z_m\n0,0,,0.1\n1,1,0.2,0.1\n2,2,0.4,0.2\n");
  CHECK(plane_of(whole, whole) == Plane::vertical);
  CHECK(plane_of(whole, planar) == Plane::ground);
  CHECK(plane_of(planar, whole) == Plane::ground);
  CHECK(frames_in(Plane::vertical, whole).size() == 3);
  CHECK(frames_in(Plane::ground, whole).size() == 2);  // before its first y it has none
  CHECK(path_in(Plane::vertical, whole)[2] == Eigen::Vector2d(2, 0.2));
  CHECK(path_in(Plane::ground, whole)[2] == Eigen::Vector2d(2, 0.4));
}

TEST_CASE("The pose at a time: at a frame, between frames, and none outside") {
  const auto frames = frames_of("t_s,x_m,z_m,pitch_rad\n1,0,0,0\n2,1,0.5,0.2\n");
  CHECK(pose_at(frames, 1).x_m == 0);
  CHECK(pose_at(frames, 2).z_m == 0.5);
  CHECK(pose_at(frames, 1.25).x_m == Approx(0.25));
  CHECK(pose_at(frames, 1.25).pitch_rad == Approx(0.05));
  CHECK(std::isnan(pose_at(frames, 0.99).x_m));
  CHECK(std::isnan(pose_at(frames, 2.01).x_m));
}

TEST_CASE("Aligned to the start: turned about it, shifted in the ground plane, height and tilt as they were") {
  const auto real = straight(1, 2, pi / 2);
  auto sim = straight(5, -3, 0);
  const StartOffset offset = align_start(real, sim, 0);
  CHECK(offset.x_m == Approx(-4));
  CHECK(offset.y_m == Approx(5));
  CHECK(offset.yaw_rad == Approx(pi / 2));
  CHECK(offset.turned);
  // 1 m ahead of (1, 2) with its nose along y
  CHECK(sim.back().x_m == Approx(1));
  CHECK(sim.back().y_m == Approx(3));
  CHECK(wrapped(sim.back().yaw_rad - pi / 2) == Approx(0).margin(1e-12));
  CHECK(sim.back().z_m == Approx(0.3));
  CHECK(sim.back().pitch_rad == -0.2);
}

TEST_CASE("Without a known heading it is only shifted") {
  const auto real = straight(1, 2, 0.5);
  auto sim = straight(0, 0, 0);
  for (PoseFrame& frame : sim) frame.yaw_rad = std::nan("");
  const StartOffset offset = align_start(real, sim, 0);
  CHECK_FALSE(offset.turned);
  CHECK(offset.yaw_rad == 0);
  CHECK(sim.back().x_m == Approx(2));
  CHECK(sim.back().y_m == Approx(2));
}

TEST_CASE("A start that is a mean evens out noise") {
  auto real = straight(0, 0, 0), sim = straight(0, 0, 0);
  for (PoseFrame& frame : real) frame.x_m = 0;  // both stand
  for (PoseFrame& frame : sim) frame.x_m = 0;
  real[0].x_m = 0.003;  // noise of the first three frames: 3, -1, -2 mm
  real[1].x_m = -0.001;
  real[2].x_m = -0.002;
  auto copy = sim;
  CHECK(align_start(real, copy, 0).x_m == Approx(0.003));
  CHECK(align_start(real, sim, 0.2).x_m == Approx(0).margin(1e-12));
}
