#include "physics/dynamics/command_channel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "robot/angles.hpp"

namespace kenaf::physics {
namespace {

constexpr double kWholeStep = 1e-6;  // of a step: a delay this close to whole steps is rounded to them

// No sensor has a name with a blank, so no sensor draws from the same generator.
constexpr std::string_view kGeneratorName = "command channel";

// A slowness of 0 means no limit.
double limit_of(double amount, double slowness) {
  return slowness > 0 ? amount / slowness : std::numeric_limits<double>::infinity();
}

// Clamps forward speed (the mean) and turn (half the difference, times `turn_gain`) to their limits.
std::array<double, robot::kTrackCount> limited(const std::array<double, robot::kTrackCount>& tracks, double turn_gain,
                                               double most_forward, double most_turn) {
  const double forward = std::clamp((tracks[robot::kLeft] + tracks[robot::kRight]) / 2, -most_forward, most_forward);
  const double turn = std::clamp(turn_gain * (tracks[robot::kRight] - tracks[robot::kLeft]) / 2, -most_turn, most_turn);
  std::array<double, robot::kTrackCount> result;
  result[robot::kLeft] = forward - turn;
  result[robot::kRight] = forward + turn;
  return result;
}

robot::Command between(const robot::Command& newer, const robot::Command& older, double older_share) {
  robot::Command out = newer;
  for (std::size_t i = 0; i < robot::kTrackCount; ++i)
    out.track_speed_mps[i] += older_share * (older.track_speed_mps[i] - newer.track_speed_mps[i]);
  for (std::size_t i = 0; i < robot::kFlipperCount; ++i) {
    if (older.flipper[i].mode != newer.flipper[i].mode) {
      out.flipper[i] = older.flipper[i];  // modes cannot be interpolated; the newer one is still under way
      continue;
    }
    const double apart = older.flipper[i].value - newer.flipper[i].value;
    // Angles are directions: interpolate the short way.
    out.flipper[i].value +=
        older_share * (newer.flipper[i].mode == robot::JointMode::angle ? robot::wrap_angle(apart) : apart);
  }
  return out;
}

}  // namespace

CommandChannel::CommandChannel(const Effects& effects, std::uint64_t world_seed, std::string_view robot,
                               double track_gauge_m, double time_step_s)
    : noise_(world_seed, robot, kGeneratorName),
      loss_(effects.command_loss),
      gain_(effects.command_gain),
      gain_turn_(effects.command_gain_turn),
      dead_band_mps_(effects.command_dead_band_mps),
      most_forward_mps_(limit_of(1, effects.command_limit_forward_spm)),
      most_turn_mps_(track_gauge_m / 2 * limit_of(1, effects.command_limit_turn_sprad)),
      side_step_mps_(limit_of(time_step_s, effects.command_slew_s2pm)),
      forward_step_mps_(limit_of(time_step_s, effects.command_slew_forward_s2pm)),
      turn_step_mps_(track_gauge_m / 2 * limit_of(time_step_s, effects.command_slew_turn_s2prad)),
      ramps_(std::isfinite(side_step_mps_) || std::isfinite(forward_step_mps_) || std::isfinite(turn_step_mps_)) {
  const double steps = effects.command_delay_s / time_step_s;
  delay_steps_ = static_cast<std::size_t>(std::floor(steps + kWholeStep));
  delay_rest_ = steps - static_cast<double>(delay_steps_);
  if (delay_rest_ < kWholeStep) delay_rest_ = 0;
  line_.resize(delay_steps_ + 2);
}

void CommandChannel::restart(const robot::Command& command) {
  sent_ = received_ = command;
  std::fill(line_.begin(), line_.end(), command);
  stop_ramp();
}

void CommandChannel::begin(const robot::Command& command, const std::array<double, robot::kTrackCount>& track_mps) {
  take(command);
  receive();
  std::fill(line_.begin(), line_.end(), received_);
  ramp_mps_ = track_mps;
}

void CommandChannel::send(const robot::Command& command) {
  if (loss_ > 0 && noise_.uniform() <= loss_) return;
  take(command);
  receive();
}

void CommandChannel::take(const robot::Command& command) {
  for (std::size_t i = 0; i < robot::kTrackCount; ++i)
    if (std::isfinite(command.track_speed_mps[i])) sent_.track_speed_mps[i] = command.track_speed_mps[i];
  for (std::size_t i = 0; i < robot::kFlipperCount; ++i)
    if (std::isfinite(command.flipper[i].value) && command.flipper[i].mode != robot::JointMode::keep)
      sent_.flipper[i] = command.flipper[i];
}

void CommandChannel::receive() {
  received_ = sent_;
  std::array<double, robot::kTrackCount>& tracks = received_.track_speed_mps;
  for (double& speed : tracks) speed *= gain_;
  // Only if needed: the sum of two halves is not always exactly the number itself.
  if (gain_turn_ != 1 || std::abs(tracks[robot::kLeft] + tracks[robot::kRight]) / 2 > most_forward_mps_ ||
      std::abs(tracks[robot::kRight] - tracks[robot::kLeft]) / 2 > most_turn_mps_)
    tracks = limited(tracks, gain_turn_, most_forward_mps_, most_turn_mps_);
  for (double& speed : tracks)
    if (std::abs(speed) < dead_band_mps_) speed = 0;
}

void CommandChannel::move_ramp(const std::array<double, robot::kTrackCount>& target_mps) {
  std::array<double, robot::kTrackCount> change{target_mps[robot::kLeft] - ramp_mps_[robot::kLeft],
                                                target_mps[robot::kRight] - ramp_mps_[robot::kRight]};
  if (std::isfinite(forward_step_mps_) || std::isfinite(turn_step_mps_))
    change = limited(change, 1, forward_step_mps_, turn_step_mps_);
  for (std::size_t i = 0; i < robot::kTrackCount; ++i)
    ramp_mps_[i] += std::clamp(change[i], -side_step_mps_, side_step_mps_);
}

const robot::Command& CommandChannel::step() {
  newest_ = (newest_ + 1) % line_.size();
  line_[newest_] = received_;
  const auto late = [this](std::size_t steps) -> const robot::Command& {
    return line_[(newest_ + line_.size() - steps) % line_.size()];
  };
  output_ = delay_rest_ > 0 ? between(late(delay_steps_), late(delay_steps_ + 1), delay_rest_) : late(delay_steps_);
  if (ramps_) {
    move_ramp(output_.track_speed_mps);
    output_.track_speed_mps = ramp_mps_;
  }
  return output_;
}

}  // namespace kenaf::physics
