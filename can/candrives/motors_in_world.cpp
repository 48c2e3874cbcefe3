// In a build with the simulator.
#include "can/candrives/motors.hpp"
#include "can/candrives/path_log.hpp"
#include "can/candrives/robot_plant.hpp"
#include "command_line/checks.hpp"
#include "formats/description/description_file.hpp"

namespace kenaf::candrives {

void add_motor_options(CLI::App& app, MotorOptions& options) {
  // Ideal motors exclude the options of the physics.
  options.time_step_s = physics::PhysicsSettings{}.time_step_s;
  auto* world = app.add_option("--world", options.world, "World: a shipped name or an SDF file")
                    ->capture_default_str()
                    ->check(command_line::readable_by(
                        [](const std::string& text) { description::require_description("world", text, ".sdf"); }));
  auto* ideal = app.add_flag("--ideal", options.ideal,
                             "No physics: motors that follow exactly, tracks that never slip, level ground")
                    ->excludes(world);
  app.add_option("--time-step", options.time_step_s,
                 "Physics time step in seconds; larger ones need less processor time")
      ->capture_default_str()
      ->check(command_line::number_in(0.0001, 0.01))
      ->excludes(ideal);
  app.add_option("--log", options.log, "Write the true position of the robot to this CSV file, a line every 10 ms")
      ->excludes(ideal);
}

Motors make_motors(const MotorOptions& options, const canbus::RobotBus& bus) {
  if (options.ideal) return make_ideal_motors(options, bus);
  auto robot = std::make_unique<RobotPlant>(options.robot, options.world, bus.speed_loop_s, options.time_step_s);
  if (!options.log.empty())
    robot->on_step = [log = std::make_shared<PathLog>(options.log), robot = robot.get()] {
      log->write(robot->time_s(), [robot] { return robot->truth(); });
    };
  return {std::move(robot), "robot " + options.robot + " in world " + options.world};
}

}  // namespace kenaf::candrives
