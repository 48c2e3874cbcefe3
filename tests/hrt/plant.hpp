// A tracked robot that can be computed by hand: drives with a lag, tracks that slip when they turn, noisy posture.
// Test-only. SI, REP 103.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <utility>

#include "hrt/transport.hpp"
#include "robot/angles.hpp"
#include "robot/state.hpp"

namespace kenaf::hrt::test {

struct PlantSettings {
  double period_s = 0.01;
  double gauge_m = 0.2;
  double drive_lag_s = 0.05;
  double turn_efficiency = 1;                   // turn of the body for a turn of 1 by the tracks
  std::array<double, 2> ground_per_belt{1, 1};  // how much ground a metre of belt makes
  double turn_centre_m = 0;                     // x of the point of the body that stays put in a turn
  double yaw_noise_rad = 0;                     // 1 sigma, white
  double max_track_mps = 1;                     // the drives go no faster
  double dead_band_mps = 0;                     // a slower command does nothing
  double flipper_radps = 1.5;
  bool tracks_blocked = false;
  bool has_posture = true;
  double yaw_start_rad = 0;
  double idle_a = 0.3, blocked_a = 6;
};

class Plant {
 public:
  explicit Plant(const PlantSettings& its_settings = {}) : settings(its_settings), yaw_rad(its_settings.yaw_start_rad) {
    observe();
  }

  // The state of the first cycle is there at once; each call computes the next one. The answer to a cycle takes effect
  // when the next one begins, as docs/world-server-protocol.md has it.
  const robot::State& advance(const robot::Command& answer) {
    const robot::Command command = std::exchange(in_force_, answer);
    const double dt = settings.period_s;
    std::array<double, 2> ground_mps{};
    for (std::size_t i = 0; i < 2; ++i) {
      const double command_mps = command.track_speed_mps[i];
      const bool is_at_rest = settings.tracks_blocked || std::abs(command_mps) < settings.dead_band_mps;
      const double wanted = is_at_rest ? 0 : std::clamp(command_mps, -settings.max_track_mps, settings.max_track_mps);
      track_mps[i] += (wanted - track_mps[i]) * -std::expm1(-dt / settings.drive_lag_s);
      track_m[i] += track_mps[i] * dt;
      ground_mps[i] = track_mps[i] * settings.ground_per_belt[i];
      pushing = pushing || (settings.tracks_blocked && command.track_speed_mps[i] != 0);
    }
    const double forward_mps = 0.5 * (ground_mps[0] + ground_mps[1]);
    const double turn_radps = settings.turn_efficiency * (ground_mps[1] - ground_mps[0]) / settings.gauge_m;
    const double left_mps = -settings.turn_centre_m * turn_radps;  // of the body's centre, sideways
    const double mean_rad = yaw_rad + 0.5 * turn_radps * dt;
    x_m += (forward_mps * std::cos(mean_rad) - left_mps * std::sin(mean_rad)) * dt;
    y_m += (forward_mps * std::sin(mean_rad) + left_mps * std::cos(mean_rad)) * dt;
    yaw_rad += turn_radps * dt;
    for (std::size_t i = 0; i < 4; ++i) {
      if (command.flipper[i].mode != robot::JointMode::angle) continue;
      const double step = settings.flipper_radps * dt;
      flipper_rad[i] += std::clamp(command.flipper[i].value - flipper_rad[i], -step, step);
    }
    ++state.frame;
    t_s = state.frame * dt;
    observe();
    return state;
  }

  // Its world is reset: it is at rest where it began, and its encoders begin at 0. Frames count on.
  void restart() {
    x_m = y_m = 0;
    yaw_rad = settings.yaw_start_rad;
    track_m = track_mps = {};
    flipper_rad = {};
    observe();
  }

  PlantSettings settings;
  double x_m = 0, y_m = 0, yaw_rad = 0, t_s = 0;
  std::array<double, 2> track_m{}, track_mps{};
  std::array<double, 4> flipper_rad{};
  bool pushing = false;
  robot::State state{};

 private:
  void observe() {
    state.fields = robot::kHasEncoders | robot::kHasFlippers | robot::kHasCurrents | robot::kHasBattery |
                   robot::kHasInertial | robot::kHasGroundTruth | (settings.has_posture ? robot::kHasPosture : 0u);
    state.frame = std::max(state.frame, 1u);
    state.robot_time_s = state.frame * settings.period_s;
    state.posture_rad = {};
    if (settings.has_posture) {
      state.posture_rad[2] = robot::wrap_angle(yaw_rad + noise_(generator_) * settings.yaw_noise_rad);
    }
    state.acceleration_mps2 = {0, 0, 9.80665};
    state.track_m = track_m;
    state.track_mps = track_mps;
    state.track_a.fill(pushing ? settings.blocked_a : settings.idle_a);
    state.flipper_rad = flipper_rad;
    state.battery_v = 25.9;
    state.p_WB_m = {x_m, y_m, 0.09};
    state.orientation_rad = {0, 0, robot::wrap_angle(yaw_rad)};
    pushing = false;
  }

  robot::Command in_force_;
  std::mt19937 generator_{1};
  std::normal_distribution<double> noise_{0, 1};
};

}  // namespace kenaf::hrt::test
