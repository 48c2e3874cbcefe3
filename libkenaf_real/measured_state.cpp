#include "libkenaf_real/measured_state.hpp"
#include "robot/state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace kenaf::real {
namespace {

using canbus::DriveUnits;
using canbus::InclinometerAxis;

constexpr double kStanding_mps = 0.002;
// A longer gap in the posture is bridged by the tracks (hrt/estimate.cpp), starting from the sensor's heading
// afterwards.
constexpr double kLongestCatchUp_s = 0.25;

double angle_from(const InclinometerAxis& axis, const SlopeInput& slope, double unit_rad) {
  const int raw = axis.lateral ? slope.lateral : slope.longitudinal;
  return axis.direction * raw * unit_rad - axis.zero_rad;
}

// Difference of counters that wrap at 32 bits.
std::int32_t difference(std::int32_t now, std::int32_t before) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(now) - static_cast<std::uint32_t>(before));
}

}  // namespace

MeasuredState::MeasuredState(const canbus::RobotBus& bus, const NodeFacts& facts, double period_s)
    : bus_(bus), facts_(facts), period_s_(period_s) {}

robot::State MeasuredState::update(const BusCycle& cycle, const Beat& beat) {
  robot::State state{};
  state.frame = beat.number;
  state.robot_time_s = beat.number * period_s_;
  state.late_commands = cycle.late_orders();
  state.fields = robot::kHasEncoders | robot::kHasFlippers;
  const bool has_currents = bus_.has_currents && facts_.has_currents;
  if (has_currents) state.fields |= robot::kHasCurrents;
  const ProcessImage& image = cycle.image();
  const double current_unit = 1e-3;  // CiA 402, 0x6078: thousandths of the rated current
  const auto current_a = [&](std::size_t i) {
    return has_currents ? std::abs(image.drive(i).current_permil) * current_unit * facts_.rated_current_a[i] : 0;
  };
  for (std::size_t t = 0; t < robot::kTrackCount; ++t) {
    const DriveInput& drive = image.drive(t);
    const DriveUnits& units = bus_.drives[t].units;
    travelled_counts_[t] += last_beat_ == 0 ? 0 : difference(drive.position, last_counts_[t]);
    last_counts_[t] = drive.position;
    state.track_m[t] = static_cast<double>(travelled_counts_[t]) / units.counts_per_unit;
    state.track_mps[t] = velocity_from_drive(units, drive.velocity);
    state.track_a[t] = current_a(t);
  }
  for (std::size_t f = 0; f < robot::kFlipperCount; ++f) {
    const std::size_t i = robot::kTrackCount + f;
    state.flipper_rad[f] = position_from_drive(bus_.drives[i].units, image.drive(i).position);
    state.flipper_a[f] = current_a(i);
  }
  if (const std::optional<double> battery_v = image.battery_v()) {
    state.battery_v = *battery_v;
    state.fields |= robot::kHasBattery;
  }
  const std::uint32_t beats = last_beat_ == 0 ? 1 : beat.number - last_beat_;
  add_posture(cycle, beats * period_s_, state);
  last_beat_ = beat.number;
  return state;
}

void MeasuredState::add_posture(const BusCycle& cycle, double elapsed_s, robot::State& state) {
  warning_.clear();
  if (!bus_.inclinometer || !bus_.gyro) return;
  if (cycle.slope_is_silent() || cycle.gyro_is_silent()) {
    const bool slope = cycle.slope_is_silent();
    const NamedNode node =
        slope ? NamedNode{bus_.inclinometer->node, "inclinometer"} : NamedNode{bus_.gyro->node, "gyro"};
    warning_ = fmt::format("{} is silent: no posture, and the heading is that of the tracks", to_string(node));
    unseen_s_ += elapsed_s;
    return;
  }
  const ProcessImage& image = cycle.image();
  state.posture_rad[0] = angle_from(bus_.inclinometer->roll, image.slope(), facts_.slope_unit_rad);
  state.posture_rad[1] = angle_from(bus_.inclinometer->pitch, image.slope(), facts_.slope_unit_rad);
  // the rate during a slow turn is not a bias
  bool standing = true;
  for (std::size_t t = 0; t < robot::kTrackCount; ++t) {
    standing = standing && std::abs(state.track_mps[t]) < kStanding_mps && cycle.sent()[t].target == 0;
  }
  elapsed_s += std::min(std::exchange(unseen_s_, 0), kLongestCatchUp_s);
  heading_.update(image.gyro().rate / bus_.gyro->units_per_radps, state.posture_rad[0], state.posture_rad[1], standing,
                  elapsed_s);
  state.posture_rad[2] = heading_.yaw_rad();
  state.fields |= robot::kHasPosture;
}

}  // namespace kenaf::real
