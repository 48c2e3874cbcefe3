// Speed of the physics: steps per second, real-time factor and contacts per step, on one core. Measures thread CPU
// time, so that other load on the machine does not change the result.
//
// Usage: physics_speed [robot-seconds per scene, default 20] [--only NAME]
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "bench/thread_time.hpp"
#include "command_line/checks.hpp"
#include "command_line/parse.hpp"
#include "physics/world.hpp"

using namespace kenaf;
using namespace kenaf::physics;

namespace {

struct Case {
  const char* name;
  const char* world;
  double left_mps, right_mps, front_rad, rear_rad;
  int robots = 1;
  double start_x_m = 0;  // beyond the world's own start pose
};

constexpr double kRound_s = 7;  // then the scene restarts; about the duration of a climb

void measure(const Case& scene, double time_s) {
  // The scene's world and robots, all with the same command.
  std::vector<std::string> unsupported;
  const WorldDescription description = load_world(scene.world, unsupported);
  World world(description, {}, 1);
  const RobotDescription robot = load_robot("kenaf");
  robot::Command command;
  command.track_speed_mps = {scene.left_mps, scene.right_mps};
  for (const robot::Flipper f : {robot::kFrontLeft, robot::kFrontRight})
    command.flipper[f] = {robot::JointMode::angle, scene.front_rad};
  for (const robot::Flipper f : {robot::kRearLeft, robot::kRearRight})
    command.flipper[f] = {robot::JointMode::angle, scene.rear_rad};
  for (int i = 0; i < scene.robots; ++i) {
    const StartPose& start = description.start_poses[static_cast<std::size_t>(i) % description.start_poses.size()];
    Pose X_WB = start.X_WB;
    X_WB.p.x() += scene.start_x_m;
    world.add_robot(robot, start.name, X_WB);
  }

  // In rounds, so that the robots stay in the part of the world that is of interest; only the steps are timed.
  const double dt = world.settings().time_step_s;
  const auto steps = static_cast<long>(time_s / dt), round = static_cast<long>(kRound_s / dt);
  double contacts = 0, taken_s = 0;
  for (long done = 0; done < steps; done += round) {
    world.reset();
    for (const RobotId id : world.robots()) world.set_command(id, command);
    const double start_s = bench::thread_time_s();
    for (long i = 0; i < std::min(round, steps - done); ++i) {
      world.step();
      contacts += static_cast<double>(world.contact_count());
    }
    taken_s += bench::thread_time_s() - start_s;
  }
  const auto n = static_cast<double>(steps);
  fmt::print("{:<28} {:>10.0f} {:>12.1f} {:>14.1f}\n", scene.name, n / taken_s, n * dt / taken_s, contacts / n);
}

}  // namespace

int main(int argc, char** argv) {
  double time_s = 20;
  std::string only;
  CLI::App app{"Speed of the physics, a scene a line", "physics_speed"};
  app.add_option("seconds", time_s, "robot-seconds per scene")->check(kenaf::command_line::number_in(0.001, 1e6));
  app.add_option("--only", only, "scenes whose name has this");
  if (const auto status = kenaf::command_line::parse(app, argc, argv)) return *status;
  fmt::print("{:<28} {:>10} {:>12} {:>14}\n", "scene", "steps/s", "real time x", "contacts/step");
  for (const Case& scene : {Case{"standing", "flat", 0, 0, 1, 1}, Case{"straight", "flat", 0.2, 0.2, 1, 1},
                            Case{"turning in place", "flat", -0.2, 0.2, 1, 1},
                            Case{"climbing a 100 mm step", "step-100", 0.2, 0.2, 0.8, 0, 1, 0.3},
                            Case{"climbing a 200 mm step", "step-200", 0.2, 0.2, 0.8, 0, 1, 0.3},
                            Case{"crossing a 300 mm trench", "trench-300", 0.2, 0.2, 0, 0, 1, 0.4},
                            Case{"16 robots, turning", "flat", -0.1, 0.2, 1, 1, 16}})
    if (std::string_view(scene.name).find(only) != std::string_view::npos) measure(scene, time_s);
  return 0;
}
