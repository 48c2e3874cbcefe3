// The cameras of the shipped robots stand and turn with their robot as the mounts in its description say, and pan, tilt
// and zoom move the picture the way geometry demands. Every fault in a description of a camera is reported with its
// place.
#include <catch2/catch.hpp>
#include <fstream>
#include <numbers>
#include <sstream>

#include "tests/camera/scenes.hpp"

using namespace kenaf::camera;
using Catch::Contains;
namespace physics = kenaf::physics;
using std::numbers::pi;

TEST_CASE("Kenaf has a camera that pans, tilts and zooms, and a bird's eye, other robots may have none") {
  const physics::RobotDescription kenaf = physics::load_robot("kenaf");
  const physics::CameraDescription* front = find_camera(kenaf, "Camera");
  const physics::CameraDescription* above = find_camera(kenaf, "BirdsEye");
  REQUIRE(front);
  REQUIRE(above);
  CHECK(kenaf.mission_packages.at(front->mission_package.value()).name == "CameraPanTilt");
  CHECK(front->min_field_of_view_rad < front->max_field_of_view_rad);
  CHECK_FALSE(above->mission_package);
  CHECK(above->min_field_of_view_rad == above->field_of_view_rad);
  CHECK(front->width == 640);
  CHECK(front->height == 480);
  CHECK(find_camera(kenaf, "Rear") == nullptr);
  CHECK(physics::load_robot("p2dx").cameras.empty());
}

TEST_CASE("A camera goes where its robot goes") {
  // at (2, 1, 0.09), turned to the left: the package, 0.20 ahead and 0.09 up in B, is at y + 0.20
  const RobotSnapshot robot = kenaf_at(pose(2, 1, 0.09, 0, 0, pi / 2));
  const physics::Pose front = camera_pose(robot, *find_camera(*robot.description, "Camera"));
  CHECK((front.p - Eigen::Vector3d(2, 1.2, 0.18)).norm() < 1e-12);
  CHECK((front.q * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm() < 1e-12);
  // the bird's eye is behind and above and looks forward and down: it sees the robot's nose below the middle
  const physics::CameraDescription& above = *find_camera(*robot.description, "BirdsEye");
  const View view = camera_view(robot, above, above.field_of_view_rad);
  CHECK(view.X_WC.p.y() < 1);
  const auto nose = project(view, {2, 1.22, 0.17});
  REQUIRE(nose);
  CHECK(in_picture(view.lens, *nose));
  CHECK(nose->u == Approx(320));
  CHECK(nose->v > 240);
}

TEST_CASE("Panned to the left, what was ahead is on the right, tilted down, above, zoomed in, larger") {
  RobotSnapshot robot = kenaf_at(pose(0, 0, 0.09));
  const physics::CameraDescription& camera = *find_camera(*robot.description, "Camera");
  const Eigen::Vector3d ahead(3, 0, 0.18), sideways(3, 0.3, 0.18);
  robot.mission_link_rad[0] = {0.2, 0};
  const double f = 320 / std::tan(1.05 / 2);
  CHECK(project(camera_view(robot, camera, 1.05), ahead)->u == Approx(320 + f * std::tan(0.2)));
  robot.mission_link_rad[0] = {0, 0.2};
  CHECK(project(camera_view(robot, camera, 1.05), ahead)->v == Approx(240 - f * std::tan(0.2)));
  // pan turns the axis that tilt turns about: whatever the pan, what tilt is ahead of stays in the middle column
  robot.mission_link_rad[0] = {pi / 2, 0.3};
  CHECK(project(camera_view(robot, camera, 1.05), {0.20, 3, 0.18})->u == Approx(320));
  robot.mission_link_rad[0] = {0, 0};
  const auto off = [&](double angle_rad) { return 320 - project(camera_view(robot, camera, angle_rad), sideways)->u; };
  CHECK(off(0.525) > 2 * off(1.05));
  CHECK(off(0.01) == off(camera.min_field_of_view_rad));
  CHECK(off(3) == off(camera.max_field_of_view_rad));
}

namespace {

// The error of kenaf.toml with `from` replaced.
std::string error_with(const std::string& from, const std::string& to) {
  std::ifstream in(std::string(KENAF_SOURCE_DIR) + "/share/robots/kenaf.toml");
  std::ostringstream all;
  all << in.rdbuf();
  std::string text = all.str();
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  text.replace(at, from.size(), to);
  try {
    physics::parse_robot(text, "test.toml");
  } catch (const kenaf::description::DescriptionError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("What is wrong with a camera is said with its place") {
  CHECK_THAT(error_with("mount = \"CameraPanTilt\"", "mount = \"Arm\""),
             Contains("no [[mission_package]] of that name"));
  CHECK_THAT(error_with("mount = \"CameraPanTilt\"", "mount = \"CameraPanTilt\"\nmount_m = [0, 0, 0]"),
             Contains("cameras without it"));
  CHECK_THAT(error_with("field_of_view_rad = 1.05", "field_of_view_rad = 1.5"), Contains("max_field_of_view_rad"));
  CHECK_THAT(error_with("name = \"BirdsEye\"", "name = \"Camera\""), Contains("another camera"));
  CHECK_THAT(error_with("field_of_view_rad = 1.4", "field_of_view_rad = 3.2"), Contains("field_of_view_rad"));
  CHECK_THAT(error_with("jpeg_quality = 80", "jpeg_quality = 101"), Contains("jpeg_quality"));
}
