#include "libkenaf_real/measured_state.hpp"
#include "robot/state.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kenaf::real {
namespace {

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
    : bus_(bus), facts_(facts), period_s_(period_s), travels_(bus.drives.size()), had_(bus.drives.size()) {}

robot::State MeasuredState::update(const BusCycle& cycle, const Beat& beat) {
  robot::State state{};
  state.frame = beat.number;
  state.robot_time_s = beat.number * period_s_;
  state.late_commands = cycle.late_orders();
  state.fields = robot::kHasEncoders;
  if (has_flippers(bus_)) {
    state.fields |= robot::kHasFlippers;
    state.flipper_rad.fill(robot::kNoFlipper);
  }
  const bool has_currents = bus_.has_currents && facts_.has_currents;
  if (has_currents) state.fields |= robot::kHasCurrents;
  for (std::size_t i = 0; i < bus_.drives.size(); ++i) {
    const canbus::DriveOnBus& drive = bus_.drives[i];
    // CiA 402, 0x6078: thousandths of the rated current
    const double current_a =
        has_currents ? 1e-3 * std::abs(cycle.image().drive(i).current_permil) * facts_.rated_current_a[i] : 0;
    if (drive.is_flipper()) {
      state.flipper_rad[*drive.flipper] = position_from_drive(drive.units, cycle.image().drive(i).position);
      state.flipper_a[*drive.flipper] = current_a;
    } else {
      add_to_side(i, cycle.image().drive(i), state);
      state.track_a[drive.side] += current_a;
    }
  }
  if (const std::optional<double> battery_v = cycle.image().battery_v()) {
    state.battery_v = *battery_v;
    state.fields |= robot::kHasBattery;
  }
  const std::uint32_t beats = last_beat_ == 0 ? 1 : beat.number - last_beat_;
  add_posture(cycle, beats * period_s_, state);
  last_beat_ = beat.number;
  mark_held(cycle.image(), state);
  return state;
}

// By arrival: not each PDO comes in each cycle, and one may be lost.
void MeasuredState::mark_held(const ProcessImage& image, robot::State& state) {
  const auto has_come = [](std::optional<canopen::Time>& had, const std::optional<canopen::Time>& at) {
    return std::exchange(had, at) != at;
  };
  bool tracks = true, flippers = true, track_currents = true, flipper_currents = true;
  for (std::size_t i = 0; i < bus_.drives.size(); ++i) {
    const DriveInput& drive = image.drive(i);
    const bool has_state = has_come(had_[i].state, drive.state_at),
               has_effort = has_come(had_[i].effort, drive.effort_at);
    if (bus_.drives[i].is_flipper()) {
      flippers = flippers && has_state;
      flipper_currents = flipper_currents && has_effort;
    } else {
      tracks = tracks && has_state;
      track_currents = track_currents && has_effort;
    }
  }
  const bool battery = has_come(had_battery_, image.battery_at());
  // roll and pitch by the one, yaw by the other
  const bool slope = has_come(had_slope_, image.slope().at), gyro = has_come(had_gyro_, image.gyro().at);
  const auto mark = [&](robot::StateField field, bool is_new) {
    if ((state.fields & field) != 0 && !is_new) state.fields |= robot::held(field);
  };
  mark(robot::kHasEncoders, tracks);
  mark(robot::kHasFlippers, flippers);
  mark(robot::kHasCurrents, track_currents);
  mark(robot::kHasBattery, battery);
  mark(robot::kHasPosture, slope || gyro);
  if ((state.fields & robot::kHasCurrents) != 0 && !flipper_currents) state.fields |= robot::kHeldFlipperCurrents;
}

// Several drives of a side: the mean of their travels and of their speeds, as ros2_controllers' diff_drive_controller
// takes it of the wheels of a side. One that slips or spins free counts with its share, and no drive is singled out.
void MeasuredState::add_to_side(std::size_t i, const DriveInput& input, robot::State& state) {
  const canbus::DriveOnBus& drive = bus_.drives[i];
  const auto count = static_cast<double>(drive.drives_of_side);
  Travel& travel = travels_[i];
  travel.counts += last_beat_ == 0 ? 0 : difference(input.position, travel.last);
  travel.last = input.position;
  state.track_m[drive.side] += static_cast<double>(travel.counts) / drive.units.counts_per_unit / count;
  state.track_mps[drive.side] += velocity_from_drive(drive.units, input.velocity) / count;
}

void MeasuredState::add_posture(const BusCycle& cycle, double elapsed_s, robot::State& state) {
  silence_ = Silence::none;
  if (!bus_.inclinometer || !bus_.gyro) return;
  if (cycle.slope_is_silent() || cycle.gyro_is_silent()) {
    silence_ = cycle.slope_is_silent() ? Silence::inclinometer : Silence::gyro;
    unseen_s_ += elapsed_s;
    return;
  }
  const ProcessImage& image = cycle.image();
  state.posture_rad[0] = angle_from(bus_.inclinometer->roll, image.slope(), facts_.slope_unit_rad);
  state.posture_rad[1] = angle_from(bus_.inclinometer->pitch, image.slope(), facts_.slope_unit_rad);
  // the rate during a slow turn is not a bias
  bool standing = true;
  for (std::size_t i = 0; i < bus_.drives.size(); ++i) {
    const canbus::DriveOnBus& drive = bus_.drives[i];
    if (drive.is_flipper()) continue;
    standing = standing && std::abs(state.track_mps[drive.side]) < kStanding_mps && cycle.sent()[i].target == 0;
  }
  elapsed_s += std::min(std::exchange(unseen_s_, 0), kLongestCatchUp_s);
  heading_.update(image.gyro().rate / bus_.gyro->units_per_radps, state.posture_rad[0], state.posture_rad[1], standing,
                  elapsed_s);
  state.posture_rad[2] = heading_.yaw_rad();
  state.fields |= robot::kHasPosture;
}

}  // namespace kenaf::real
