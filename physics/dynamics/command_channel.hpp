// A command's way from World::set_command to the drives: the effects of the command stage.
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

// In the order in which they act:
// 1. loss: a whole message is lost on the link; the one before remains valid.
// 2. gain: the scale of one side's speed unit against the other's. Before or after the delay it has the same effect,
//    since delay is linear. Then the gain of the turn rate, and the limits of forward speed and turn rate: those of a
//    controller that takes these two in place of two tracks.
// 3. dead band: after gains and limits, a track's speed that is too small counts as zero. Before the delay, so that no
//    interpolated speed, which nobody sent, falls into it.
// 4. delay: joints' modes and values included. A delay that is no whole number of steps interpolates linearly between
//    the two adjacent steps, so that the robot's motion changes smoothly with the delay.
// 5. slew limits: the drives' own ramp, on commands that have arrived: it limits the rate of the belts' mean and
//    difference, which are forward speed and turn rate, then that of each belt.
// No allocation after construction.
class CommandChannel {
 public:
  // Draws its losses from a generator of its own, seeded by world seed and robot name. `track_gauge_m`, the distance of
  // the tracks, converts turn rates.
  CommandChannel(const Effects& effects, std::uint64_t world_seed, std::string_view robot, double track_gauge_m,
                 double time_step_s);

  // As if `command` had always been sent; the ramp is at rest.
  void restart(const robot::Command& command);
  // For a robot that is already moving: as if `command` had been sent so long ago that nothing else is under way, with
  // the ramp at `track_mps`.
  void begin(const robot::Command& command, const std::array<double, robot::kTrackCount>& track_mps);
  // The tracks stand, whatever was commanded: the ramp restarts at 0. Commands under way still arrive.
  void stop_ramp() { ramp_mps_ = {}; }
  // A command from the commander. Values that are not finite, and JointMode::keep, leave the ones sent before. The
  // command for the drives has no JointMode::keep.
  void send(const robot::Command& command);
  // Returns the command for the drives; call once before each time step.
  const robot::Command& step();

 private:
  void take(const robot::Command& command);
  void receive();
  void move_ramp(const std::array<double, robot::kTrackCount>& target_mps);

  NoiseSource noise_;
  double loss_, gain_, gain_turn_, dead_band_mps_;
  // Limits of the mean of both tracks, and of half their difference. Infinite: no limit.
  double most_forward_mps_, most_turn_mps_;
  // The ramp's largest change in a step: of each track's speed, of the mean of both, and of half their difference.
  // Infinite: no limit.
  double side_step_mps_, forward_step_mps_, turn_step_mps_;
  bool ramps_;
  std::size_t delay_steps_;
  double delay_rest_ = 0;  // of a step, below 1
  robot::Command sent_, received_, output_;
  std::vector<robot::Command> line_;  // ring of the commands received in the last steps
  std::size_t newest_ = 0;
  std::array<double, robot::kTrackCount> ramp_mps_{};
};

}  // namespace kenaf::physics
