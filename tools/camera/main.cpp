// camera_picture: writes the picture of a robot's camera as a PNG file.
//
//   camera_picture --world step-200 --at 0.3 0 0 --out front.png
//   camera_picture --world step-field --camera BirdsEye --flippers 0.5 --out above.png
#include <png.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

#include "camera/renderer.hpp"
#include "camera/robot_cameras.hpp"
#include "command_line/checks.hpp"
#include "command_line/parse.hpp"
#include "formats/runs/whole_file.hpp"

namespace {

using namespace kenaf;

struct Options {
  std::string robot = "kenaf", world = "flat", camera = "Camera", out;
  std::vector<double> at{0, 0, 0}, eye;
  double pan_rad = 0, tilt_rad = 0, field_of_view_rad = 0, flippers_rad = 0.5, seconds = 1, track_mps = 0;
  bool every_pixel = false;
};

std::string png_of(const camera::Picture& picture) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(picture.width);
  image.height = static_cast<png_uint_32>(picture.height);
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string file(size, '\0');
  if (!png_image_write_to_memory(&image, file.data(), &size, 0, picture.rgb.data(), 0, nullptr))
    throw std::runtime_error(image.message);
  file.resize(size);
  return file;
}

// A world with the robot at its place, after it has stood or driven for a while.
physics::World driven_world(const Options& options) {
  std::vector<std::string> unsupported;
  physics::World world(physics::load_world(options.world, unsupported), {}, 1);
  const physics::Pose X_WB{{options.at[0], options.at[1], 0.1}, physics::rotation_from({0, 0, options.at[2]})};
  const physics::RobotId robot = world.add_robot(physics::load_robot(options.robot), "R1", X_WB);
  robot::Command command;
  command.track_speed_mps.fill(options.track_mps);
  command.flipper.fill({robot::JointMode::angle, options.flippers_rad});
  world.set_command(robot, command);
  const auto& packages = world.robot_description(robot).mission_packages;
  const std::size_t links = packages.empty() ? 0 : packages.front().links.size();
  if (links > 0) world.set_mission_link(robot, 0, 0, options.pan_rad);
  if (links > 1) world.set_mission_link(robot, 0, 1, options.tilt_rad);
  while (world.time_s() < options.seconds) world.step();
  return world;
}

camera::View view_of(const Options& options, const camera::RobotSnapshot& robot) {
  const physics::CameraDescription* found = camera::find_camera(*robot.description, options.camera);
  if (!found) throw std::runtime_error("the robot has no camera \"" + options.camera + "\"");
  const double angle_rad = options.field_of_view_rad > 0 ? options.field_of_view_rad : found->field_of_view_rad;
  camera::View view = camera_view(robot, *found, angle_rad);
  if (!options.eye.empty())
    view.X_WC = {{options.eye[0], options.eye[1], options.eye[2]},
                 physics::rotation_from({0, options.eye[3], options.eye[4]})};
  return view;
}

void make_picture(const Options& options) {
  const physics::World world = driven_world(options);
  camera::WorldSnapshot snapshot;
  camera::SnapshotTaker().take(world, snapshot);
  camera::Scene scene(world.description());
  scene.update(snapshot);
  camera::Renderer renderer({.every_pixel = options.every_pixel});
  camera::Picture picture;
  renderer.render(scene, view_of(options, snapshot.robots.front()), picture);
  runs::write_whole_file(options.out, png_of(picture));
  std::printf("%s: %d x %d, %zu rays\n", options.out.c_str(), picture.width, picture.height, renderer.ray_count());
}

}  // namespace

int main(int argc, char** argv) {
  // Options, then the picture; status 2 if it cannot be made.
  Options options;
  CLI::App app{"Writes the picture of a robot's camera.", "camera_picture"};
  const CLI::Validator coordinate = command_line::number_in(-1e4, 1e4), angle = command_line::number_in(-10, 10);
  app.add_option("--robot", options.robot, "robot description")->capture_default_str();
  app.add_option("--world", options.world, "world")->capture_default_str();
  app.add_option("--camera", options.camera, "the camera's name")->capture_default_str();
  app.add_option("--out", options.out, "the picture, a PNG file")->required();
  app.add_option("--at", options.at, "the robot's x, y in m and yaw in rad")->expected(3)->check(coordinate);
  app.add_option("--eye", options.eye, "look from x, y, z in m with pitch and yaw in rad instead")
      ->expected(5)
      ->check(coordinate);
  app.add_option("--pan", options.pan_rad, "link 1 of the first mission package, rad")->check(angle);
  app.add_option("--tilt", options.tilt_rad, "its link 2, rad")->check(angle);
  app.add_option("--field-of-view", options.field_of_view_rad, "rad [the camera's]")
      ->check(command_line::number_in(0.01, 3.1));
  app.add_option("--flippers", options.flippers_rad, "all four, rad")->check(angle)->capture_default_str();
  app.add_option("--speed", options.track_mps, "of both tracks, m/s")->check(command_line::number_in(-10, 10));
  app.add_option("--seconds", options.seconds, "duration of the drive, or of the rest")
      ->check(command_line::number_in(0, 3600))
      ->capture_default_str();
  app.add_flag("--every-pixel", options.every_pixel, "a ray through each pixel");
  if (const auto status = command_line::parse(app, argc, argv)) return *status;
  try {
    make_picture(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "camera_picture: %s\n", error.what());
    return 2;
  }
  return 0;
}
