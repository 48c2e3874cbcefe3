// What becomes of a command between World::set_command and the drives: the effects of the command stage.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "physics/effects.hpp"
#include "physics/robot_command.hpp"
#include "physics/sensors/noise.hpp"

namespace kenaf::physics {

// In the order in which a command meets them:
// 1. loss: a message is lost as a whole, on the link; the one before goes on to hold.
// 2. gain: what one side's metre per second is to the other. As long as it stands behind the loss and before the slew
//    limit its place changes nothing, since a delay of a multiple is a multiple of the delay.
// 3. delay: of what arrives, joints' modes and values included. One that is no whole number of steps lies on the
//    straight line between the two steps beside it, so that what a robot does changes smoothly with the delay.
// 4. slew limit: the drive's own ramp, so it acts on what has arrived, and limits the speed that the belt is to have.
// No allocation after construction.
class CommandChannel {
 public:
  // Draws its losses from a generator of its own, seeded by world seed and robot name.
  CommandChannel(const Effects& effects, std::uint64_t world_seed, std::string_view robot, double time_step_s);

  // As if `command` had been sent for ever; the ramp stands at rest.
  void restart(const RobotCommand& command);
  // As if `command` had been sent for so long that nothing else is under way, with the ramp at `track_mps`: a robot that
  // is on its way already.
  void begin(const RobotCommand& command, const std::array<double, kTrackCount>& track_mps);
  // The tracks stand, whatever was commanded: the ramp begins at 0 again. What is under way arrives.
  void stop_ramp() { ramp_mps_ = {}; }
  // From the commander. What is no number leaves what was sent before.
  void send(const RobotCommand& command);
  // What the drives are told; once before each time step.
  const RobotCommand& step();

 private:
  NoiseSource noise_;
  double loss_, gain_, step_mps_;  // step_mps_: what the ramp moves in a step; 0: no limit
  std::size_t delay_steps_;
  double delay_rest_ = 0;          // of a step, below 1
  RobotCommand sent_, received_, told_;
  std::vector<RobotCommand> line_;  // what was received in the last steps, a ring
  std::size_t newest_ = 0;
  std::array<double, kTrackCount> ramp_mps_{};
};

}  // namespace kenaf::physics
