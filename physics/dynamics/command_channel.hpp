// What becomes of a command between World::set_command and the drives: the effects of the command stage.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "physics/effects.hpp"
#include "physics/noise.hpp"
#include "robot/command.hpp"

namespace kenaf::physics {

// In the order in which a command meets them:
// 1. loss: a message is lost as a whole, on the link; the one before goes on to hold.
// 2. gain: what one side's metre per second is to the other. As long as it stands behind the loss and before the slew
//    limit its place changes nothing, since a delay of a multiple is a multiple of the delay. Then the gain of the turn
//    rate, and the limits of forward speed and turn rate: of a controller that takes these two in place of two tracks.
// 3. dead band: of what arrives, after gains and limits, a track's speed that is too small counts as none. Before the
// delay, so
//    that no speed between two commands, which nobody sent, falls into it.
// 4. delay: of what arrives, joints' modes and values included. One that is no whole number of steps lies on the
//    straight line between the two steps beside it, so that what a robot does changes smoothly with the delay.
// 5. slew limits: the drives' own ramp, so it acts on what has arrived, and limits the speeds that the belts are to
// have:
//    first how fast their mean and their difference change, which are forward speed and turn rate, then each of them.
// No allocation after construction.
class CommandChannel {
 public:
  // Draws its losses from a generator of its own, seeded by world seed and robot name. `track_gauge_m`: between the
  // tracks, for what a turn rate is.
  CommandChannel(const Effects& effects, std::uint64_t world_seed, std::string_view robot, double track_gauge_m,
                 double time_step_s);

  // As if `command` had been sent for ever; the ramp stands at rest.
  void restart(const robot::Command& command);
  // As if `command` had been sent for so long that nothing else is under way, with the ramp at `track_mps`: a robot
  // that is on its way already.
  void begin(const robot::Command& command, const std::array<double, robot::kTrackCount>& track_mps);
  // The tracks stand, whatever was commanded: the ramp begins at 0 again. What is under way arrives.
  void stop_ramp() { ramp_mps_ = {}; }
  // From the commander. What is no number leaves what was sent before.
  void send(const robot::Command& command);
  // What the drives are told; once before each time step.
  const robot::Command& step();

 private:
  void receive();
  void move_ramp(const std::array<double, robot::kTrackCount>& target_mps);

  NoiseSource noise_;
  double loss_, gain_, gain_turn_, dead_band_mps_;
  // Of the mean of both tracks, and of half their difference. Infinite: no limit.
  double most_forward_mps_, most_turn_mps_;
  // What the ramp moves in a step at most: each track's speed, the mean of both, and half their difference. Infinite:
  // no limit.
  double side_step_mps_, forward_step_mps_, turn_step_mps_;
  bool ramps_;
  std::size_t delay_steps_;
  double delay_rest_ = 0;  // of a step, below 1
  robot::Command sent_, received_, told_;
  std::vector<robot::Command> line_;  // what was received in the last steps, a ring
  std::size_t newest_ = 0;
  std::array<double, robot::kTrackCount> ramp_mps_{};
};

}  // namespace kenaf::physics
