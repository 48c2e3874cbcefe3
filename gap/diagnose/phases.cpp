#include "gap/diagnose/phases.hpp"
#include "robot/parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace kenaf::gap::diagnose {
namespace {

using Column = std::span<const double>;

constexpr double kStep_s = 0.05, kShortestPhase_s = 0.1;
constexpr double kBeltMoves_mps = 0.01;
constexpr double kTurns = 0.3;              // difference of the belts' speeds over the larger one
constexpr double kSettling_s = 0.3;         // after a command has changed; longer until the belts obey a stop
constexpr double kRolls = 0.1;              // of the speed before a stop: what is faster still slows down
constexpr double kFlipperMoves_rad = 0.02;  // from its command
constexpr double kInclined_rad = 0.06;      // relative to the pitch at the start
constexpr double kTips_radps = 0.6;
constexpr double kFalls_mps = 0.25;  // of height lost
constexpr double kLands_s = 0.4;     // after a tip or a fall

// A column on a regular time grid, holding the last measured value.
std::vector<double> on_grid(Column time, Column column, std::size_t count) {
  std::vector<double> result(count, std::numeric_limits<double>::quiet_NaN());
  if (column.empty()) return result;
  double value = std::numeric_limits<double>::quiet_NaN();
  std::size_t row = 0;
  for (std::size_t i = 0; i < count; ++i) {
    for (; row < time.size() && time[row] - time.front() <= static_cast<double>(i) * kStep_s + 1e-9; ++row)
      if (!std::isnan(column[row])) value = column[row];
    result[i] = value;
  }
  return result;
}

// Central difference over two steps to each side, robust against the pose's noise; 0 if unknown.
double rate(const std::vector<double>& values, std::size_t i) {
  const std::size_t a = i < 2 ? 0 : i - 2, b = std::min(i + 2, values.size() - 1);
  const double difference = values[b] - values[a];
  return std::isnan(difference) || a == b ? 0 : difference / (static_cast<double>(b - a) * kStep_s);
}

double or_zero(double value) {
  return std::isnan(value) ? 0 : value;
}

struct Signals {
  std::vector<double> left_mps, right_mps, x_m, y_m, z_m, pitch_rad;
  std::vector<bool> changed;   // a track command, within kSettling_s
  std::vector<bool> flippers;  // one is moving
};

Signals signals_of(const Observation& observation, std::size_t count) {
  const runs::Run& run = observation.run;
  const Column time = run.column("t_s");
  const auto grid = [&](std::string_view name) { return on_grid(time, run.column(name), count); };
  Signals s{grid("cmd_track_left_mps"),
            grid("cmd_track_right_mps"),
            grid("x_m"),
            grid("y_m"),
            grid("z_m"),
            grid("pitch_rad"),
            std::vector<bool>(count, false),
            std::vector<bool>(count, false)};
  // an initial command to move is a change, unless the belts already have half of its speed or more
  const auto obeyed = [&](double asked_mps, std::string_view track) {
    return !(std::abs(grid(track).front()) < std::abs(asked_mps) / 2);
  };
  // a stop lasts until both belts are measured at rest, or as good as
  const std::vector<double> left_is = grid("track_left_mps"), right_is = grid("track_right_mps");
  double speed_before_mps = 0;
  const auto rolls = [&](std::size_t i) {
    const double faster_mps = std::max(std::abs(or_zero(left_is[i])), std::abs(or_zero(right_is[i])));
    return faster_mps > std::max(kBeltMoves_mps, kRolls * speed_before_mps);
  };
  bool slows_down = false;
  std::size_t last_change =
      obeyed(s.left_mps[0], "track_left_mps") && obeyed(s.right_mps[0], "track_right_mps") ? count : 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0 &&
        std::abs(s.left_mps[i] - s.left_mps[i - 1]) + std::abs(s.right_mps[i] - s.right_mps[i - 1]) > kBeltMoves_mps)
      last_change = i;
    const bool settling = last_change < count && static_cast<double>(i - last_change) * kStep_s <= kSettling_s;
    const double asked_mps = std::max(std::abs(or_zero(s.left_mps[i])), std::abs(or_zero(s.right_mps[i])));
    if (asked_mps >= kBeltMoves_mps) speed_before_mps = asked_mps;
    slows_down = asked_mps < kBeltMoves_mps && (settling || slows_down) && rolls(i);
    s.changed[i] = settling || slows_down;
  }
  for (const std::string_view flipper : robot::kFlipperNames) {
    const auto asked = grid(fmt::format("cmd_flipper_{}_rad", flipper));
    const auto is = grid(fmt::format("flipper_{}_rad", flipper));
    for (std::size_t i = 0; i < count; ++i)
      if (std::abs(asked[i] - is[i]) > kFlipperMoves_rad) s.flippers[i] = true;
  }
  return s;
}

std::string_view phase_at(const Signals& s, std::size_t i, double level_rad, double upset_s) {
  const double left = or_zero(s.left_mps[i]), right = or_zero(s.right_mps[i]);
  const double faster = std::max(std::abs(left), std::abs(right));
  const double pitch = or_zero(s.pitch_rad[i] - level_rad), pitch_rate = rate(s.pitch_rad, i);
  if (rate(s.z_m, i) < -kFalls_mps) return "fall";
  if (std::abs(pitch_rate) > kTips_radps) return "tip";
  if (upset_s < kLands_s) return "land";
  if (std::abs(pitch) > kInclined_rad) return pitch < 0 ? "climb" : "descend";
  if (faster < kBeltMoves_mps) return s.flippers[i] ? "flippers" : s.changed[i] ? "slow down" : "stand";
  if (s.changed[i]) return "speed change";
  if (std::abs(left - right) > kTurns * faster) return "turn";
  return "cruise";
}

}  // namespace

std::vector<PhaseSpan> phases_of(const Observation& observation) {
  const Column time = observation.run.column("t_s");
  const double duration_s = time.back() - time.front();
  const auto count = static_cast<std::size_t>(duration_s / kStep_s) + 1;
  const Signals s = signals_of(observation, count);
  const double level_rad = or_zero(s.pitch_rad.front());
  std::vector<PhaseSpan> spans;
  double upset_s = kLands_s;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string_view name = phase_at(s, i, level_rad, upset_s);
    upset_s = name == "tip" || name == "fall" ? 0 : upset_s + kStep_s;
    const double from_s = static_cast<double>(i) * kStep_s;
    if (spans.empty() || spans.back().name != name) {
      // the first contact with what is climbed next
      if (name == "climb" && !spans.empty() && (spans.back().name == "cruise" || spans.back().name == "speed change")) {
        const double contact_s = std::max(spans.back().from_s, from_s - 2 * kStep_s);
        spans.back().to_s = contact_s;
        spans.push_back({"contact", contact_s, from_s + 2 * kStep_s, 0, 0});
        spans.push_back({name, from_s + 2 * kStep_s, from_s + 2 * kStep_s, 0, 0});
      } else {
        spans.push_back({name, from_s, from_s, 0, 0});
      }
    }
    spans.back().to_s = std::max(spans.back().to_s, std::min(from_s + kStep_s, duration_s));
  }
  // too short phases are merged into the previous one, or the next one at the start
  std::vector<PhaseSpan> result;
  for (const PhaseSpan& span : spans) {
    if (!result.empty() && (span.to_s - span.from_s < kShortestPhase_s || span.name == result.back().name))
      result.back().to_s = std::max(result.back().to_s, span.to_s);
    else if (result.size() == 1 && result.back().to_s - result.back().from_s < kShortestPhase_s)
      result.back() = {span.name, result.back().from_s, span.to_s, 0, 0};
    else if (span.to_s > span.from_s)
      result.push_back(span);
  }
  for (PhaseSpan& span : result) {
    const auto middle = std::min(count - 1, static_cast<std::size_t>((span.from_s + span.to_s) / 2 / kStep_s));
    span.x_m = s.x_m[middle];
    span.y_m = s.y_m[middle];
  }
  return result;
}

}  // namespace kenaf::gap::diagnose
