// Cost of a picture: processor time of each camera's picture, drawing and JPEG apart, in worlds of few and of many
// faces, and whether two cameras at 30 pictures a second leave half a core free. Measures thread CPU time, so that
// other load on the machine does not change the result.
//
// Usage: camera_cost [pictures per camera and world, default 60] [world]... Status 1: a world's mean misses the limit.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "bench/thread_time.hpp"
#include "camera/jpeg.hpp"
#include "camera/renderer.hpp"
#include "camera/robot_cameras.hpp"
#include "command_line/checks.hpp"
#include "command_line/parse.hpp"

using namespace kenaf;

namespace {

constexpr double kLimit = 0.5;  // of a core
constexpr double kRate_hz = 30;

struct Cost {
  double snapshot_s = 0, update_s = 0, draw_s = 0, jpeg_s = 0, bytes = 0, rays = 0;
};

// Mean cost of each camera's pictures while the robot drives from the world's start, at the cameras' rate.
std::vector<Cost> measure(const std::string& world_name, int pictures) {
  // A robot that drives forward, flippers up.
  std::vector<std::string> unsupported;
  physics::World world(physics::load_world(world_name, unsupported), {}, 1);
  const physics::RobotDescription robot = physics::load_robot("kenaf");
  physics::Pose X_WB = world.description().start_poses.front().X_WB;
  const physics::RobotId id = world.add_robot(robot, "R1", X_WB);
  robot::Command command;
  command.track_speed_mps = {0.4, 0.4};
  command.flipper.fill({robot::JointMode::angle, 0.6});
  world.set_command(id, command);

  // Each stage of each picture is timed by itself; the first round, which allocates, is not counted.
  camera::SnapshotTaker taker;
  camera::WorldSnapshot snapshot;
  camera::Scene scene(world.description());
  camera::JpegEncoder jpeg;
  std::vector<Cost> costs(robot.cameras.size());
  std::vector<camera::Renderer> renderers(robot.cameras.size());
  camera::Picture picture;
  for (int i = -1; i < pictures; ++i) {  // the first allocates
    while (world.time_s() < i / kRate_hz) world.step();
    double t[5];
    for (std::size_t c = 0; c < robot.cameras.size(); ++c) {
      t[0] = bench::thread_time_s();
      taker.take(world, snapshot);
      t[1] = bench::thread_time_s();
      scene.update(snapshot);
      t[2] = bench::thread_time_s();
      const physics::CameraDescription& camera = robot.cameras[c];
      renderers[c].render(scene, camera_view(snapshot.robots.front(), camera, camera.field_of_view_rad), picture);
      t[3] = bench::thread_time_s();
      const auto file = jpeg.encode(picture, camera.jpeg_quality);
      t[4] = bench::thread_time_s();
      if (i < 0) continue;
      Cost& cost = costs[c];
      cost.snapshot_s += (t[1] - t[0]) / pictures;
      cost.update_s += (t[2] - t[1]) / pictures;
      cost.draw_s += (t[3] - t[2]) / pictures;
      cost.jpeg_s += (t[4] - t[3]) / pictures;
      cost.bytes += static_cast<double>(file.size()) / pictures;
      cost.rays += static_cast<double>(renderers[c].ray_count()) / pictures;
    }
  }
  return costs;
}

}  // namespace

int main(int argc, char** argv) {
  int pictures = 60;
  std::vector<std::string> worlds;
  CLI::App app{"Cost of the cameras' pictures, world by world", "camera_cost"};
  app.add_option("pictures", pictures, "per camera and world")->check(kenaf::command_line::whole_number(1, 1'000'000));
  app.add_option("worlds", worlds, "shipped names or SDF files");
  if (const auto status = kenaf::command_line::parse(app, argc, argv)) return *status;

  // A line for each camera, and their sum at the cameras' rate against the limit.
  if (worlds.empty()) worlds = {"flat", "step-200", "stairs", "step-field", "hills", "rubble-mesh"};
  const physics::RobotDescription robot = physics::load_robot("kenaf");
  bool met = true;
  fmt::print("{:<12} {:<10} {:>11} {:>9} {:>8} {:>8} {:>9} {:>8} {:>7}\n", "world", "camera", "snapshot us", "scene us",
             "draw ms", "JPEG ms", "sum ms", "rays k", "kB");
  for (const std::string& world : worlds) {
    double share = 0;
    const std::vector<Cost> costs = measure(world, pictures);
    for (std::size_t c = 0; c < costs.size(); ++c) {
      const Cost& cost = costs[c];
      const double sum_s = cost.snapshot_s + cost.update_s + cost.draw_s + cost.jpeg_s;
      share += kRate_hz * sum_s;
      fmt::print("{:<12} {:<10} {:>11.1f} {:>9.1f} {:>8.2f} {:>8.2f} {:>9.2f} {:>8.1f} {:>7.1f}\n", world,
                 robot.cameras[c].name, 1e6 * cost.snapshot_s, 1e6 * cost.update_s, 1e3 * cost.draw_s,
                 1e3 * cost.jpeg_s, 1e3 * sum_s, cost.rays / 1e3, cost.bytes / 1e3);
    }
    fmt::print("{:<12} all cameras at {:.0f} Hz: {:.2f} of a core, limit {:.1f}\n", world, kRate_hz, share, kLimit);
    met = met && share <= kLimit;
  }
  return met ? 0 : 1;
}
