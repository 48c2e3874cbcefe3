#include "gap/challenge/foreign.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace kenaf::gap::challenge {
namespace {

std::vector<double>* column_of(runs::Run& run, std::string_view name) {
  for (std::size_t c = 0; c < run.columns.size(); ++c)
    if (run.columns[c] == name) return &run.values[c];
  return nullptr;
}

// Applies a first-order lag to the value that `value_of` picks of each command, from `at_start` on:
// y += (u - y) (1 - exp(-dt / lag)).
template <class ValueOf>
void follow_late(rollout::Manoeuvre& replay, double lag_s, double at_start, ValueOf&& value_of) {
  double followed = at_start, last_s = 0;
  for (rollout::TimedCommand& timed : replay.timed) {
    double& value = value_of(timed.command);
    // Without lag the command stays the same to the last bit.
    followed = lag_s > 0 ? followed + (value - followed) * -std::expm1(-(timed.t_s - last_s) / lag_s) : value;
    last_s = timed.t_s;
    value = followed;
  }
}

// The right track cuts out for 0.2 s in every 1.3 s, which is no multiple of any period of a manoeuvre.
constexpr double kCutOutEvery_s = 1.3, kCutOut_s = 0.2;

void cut_out(rollout::Manoeuvre& replay, double share) {
  for (rollout::TimedCommand& timed : replay.timed)
    if (std::fmod(timed.t_s, kCutOutEvery_s) >= kCutOutEvery_s - kCutOut_s)
      timed.command.track_speed_mps[robot::kRight] *= 1 - share;
}

constexpr double kHunt_s = 1.1;      // period, no multiple of any period of a manoeuvre
constexpr double kFade_s = 10;       // time after which the drives fade no more
constexpr double kOfRate_sprad = 1;  // the gyro reports half of 1 rad/s, with amount 1

template <class FactorAt>
void multiply_speeds(rollout::Manoeuvre& replay, FactorAt&& factor_at) {
  for (rollout::TimedCommand& timed : replay.timed)
    for (double& speed_mps : timed.command.track_speed_mps) speed_mps *= factor_at(timed.t_s);
}

}  // namespace

bool is_of_commands(std::string_view foreign) {
  return foreign == "left_drive_lag" || foreign == "right_flipper_lag" || foreign == "right_drive_cuts_out" ||
         foreign == "command_shortfall" || foreign == "speed_hunts" || foreign == "drives_fade";
}

void obey_foreign(rollout::Manoeuvre& replay, std::string_view foreign, double amount) {
  if (foreign == "left_drive_lag")
    follow_late(replay, 0.3 * amount, 0,
                [](robot::Command& command) -> double& { return command.track_speed_mps[robot::kLeft]; });
  if (foreign == "right_flipper_lag" && !replay.timed.empty()) {
    const auto angle_of = [](robot::Command& command) -> double& { return command.flipper[robot::kFrontRight].value; };
    const std::optional<double> known = replay.start ? replay.start->flipper_rad[robot::kFrontRight] : std::nullopt;
    follow_late(replay, 0.5 * amount, known.value_or(angle_of(replay.timed.front().command)), angle_of);
  }
  if (foreign == "right_drive_cuts_out") cut_out(replay, amount);
  if (foreign == "command_shortfall")
    for (rollout::TimedCommand& timed : replay.timed)
      for (double& speed_mps : timed.command.track_speed_mps)
        speed_mps = std::copysign(std::max(0.0, std::abs(speed_mps) - 0.08 * amount), speed_mps);
  if (foreign == "speed_hunts")
    multiply_speeds(replay,
                    [&](double t_s) { return 1 + 0.2 * amount * std::sin(2 * std::numbers::pi * t_s / kHunt_s); });
  if (foreign == "drives_fade")
    multiply_speeds(replay, [&](double t_s) { return 1 - 0.3 * amount * std::min(1.0, t_s / kFade_s); });
}

void record_foreign(runs::Run& run, std::string_view foreign, double amount) {
  if (foreign == "gyro_saturates")
    for (const char* name : {"gyro_x_radps", "gyro_y_radps", "gyro_z_radps"})
      if (std::vector<double>* column = column_of(run, name))
        for (double& rate_radps : *column) rate_radps /= 1 + kOfRate_sprad * amount * std::abs(rate_radps);
}

}  // namespace kenaf::gap::challenge
