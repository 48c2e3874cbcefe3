#include "tools/studies/validation/steady_motion.hpp"

#include <cmath>

#include "physics/world.hpp"

namespace kenaf::validation {

using physics::World;

SteadyMotion steady_motion(const physics::RobotDescription& robot, double left_mps, double right_mps) {
  physics::WorldDescription ground;
  ground.planes.push_back({{}, 1});
  World world(ground, {}, 1);
  const auto id = world.add_robot(robot, "robot", {{0, 0, robot.ride_height_m()}, Eigen::Quaterniond::Identity()});
  robot::Command command;
  command.track_speed_mps = {left_mps, right_mps};
  world.set_command(id, command);

  // Half of the time to settle, half to measure; speeds are of the body's own axes, so a circle is a steady motion.
  const auto steps = std::lround(1 / world.settings().time_step_s);
  for (long i = 0; i < steps; ++i) world.step();
  SteadyMotion sum{0, 0};
  for (long i = 0; i < steps; ++i) {
    world.step();
    const physics::RobotTruth truth = world.truth(id);
    sum.forward_mps += truth.v_WB_mps.dot(truth.X_WB.q * Eigen::Vector3d::UnitX());
    sum.turn_radps += truth.w_WB_radps.z();
  }
  return {sum.forward_mps / static_cast<double>(steps), sum.turn_radps / static_cast<double>(steps)};
}

}  // namespace kenaf::validation
