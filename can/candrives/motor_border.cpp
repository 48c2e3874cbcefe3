#include "can/candrives/motor_border.hpp"

#include <algorithm>
#include <cmath>

namespace kenaf::candrives {

namespace {

constexpr double kTrackPositionGain_ps = 20;  // speed per distance, chosen: settles within a few cycles
constexpr double kHomingMaxLag_rad = 0.1;     // chosen: five times the lag of a free flipper at homing speed

double to_counts(const canbus::DriveUnits& units, double position) {
  return position * units.counts_per_unit + units.zero_counts;
}

}  // namespace

DriveSetup drive_setup(const canbus::RobotBus& bus, std::size_t drive) {
  const canbus::DriveOnBus& on_bus = bus.drives[drive];
  const double counts_per_unit = std::abs(on_bus.units.counts_per_unit);
  return {.node = on_bus.node,
          .name = on_bus.name,
          .scale = {.counts_per_velocity_unit = counts_per_unit / std::abs(on_bus.units.velocity_per_unit),
                    .counts_per_acceleration_unit = counts_per_unit / on_bus.units.acceleration_per_unit,
                    .homing_max_lag = kHomingMaxLag_rad * counts_per_unit,
                    .home_offset_direction = on_bus.homing ? on_bus.homing->offset_direction : 1},
          .absolute_encoder = on_bus.is_flipper() && !on_bus.homing,
          .has_current = bus.has_currents,
          .has_voltage = bus.has_battery,
          .has_event_timer = bus.event_timer.value_or(true)};
}

Measured measure(const canbus::RobotBus& bus, std::size_t drive, const PlantState& state) {
  const canbus::DriveOnBus& on_bus = bus.drives[drive];
  const canbus::DriveUnits& units = on_bus.units;
  Measured motor{.supply_v = state.battery_v};
  if (!on_bus.is_flipper()) {
    motor.position = to_counts(units, state.track_m[on_bus.side]);
    motor.velocity = state.track_mps[on_bus.side] * units.counts_per_unit;
    motor.current_a = state.track_a[on_bus.side] / static_cast<double>(on_bus.drives_of_side);
    return motor;
  }
  const robot::Flipper flipper = *on_bus.flipper;
  const double angle = state.flipper_rad[flipper];
  const bool at_min = angle <= on_bus.min_position + kSwitchBeforeEnd_rad;
  const bool at_max = angle >= on_bus.max_position - kSwitchBeforeEnd_rad;
  const bool same_way = units.counts_per_unit > 0;
  motor.position = to_counts(units, angle);
  motor.velocity = state.flipper_radps[flipper] * units.counts_per_unit;
  motor.current_a = state.flipper_a[flipper];
  motor.negative_switch = same_way ? at_min : at_max;
  motor.positive_switch = same_way ? at_max : at_min;
  return motor;
}

void add_command(const canbus::RobotBus& bus, std::size_t drive, const Drive& from, const Measured& motor,
                 PlantCommand& to) {
  const canbus::DriveOnBus& on_bus = bus.drives[drive];
  const canbus::DriveUnits& units = on_bus.units;
  const Demand& demand = from.demand();
  if (on_bus.is_flipper()) {
    to.flipper_rad[*on_bus.flipper] = (demand.position - units.zero_counts) / units.counts_per_unit;
    return;
  }
  double velocity = demand.velocity;
  if (from.is_powered() && from.holds_position())
    velocity += kTrackPositionGain_ps * (demand.position - motor.position);
  to.track_mps[on_bus.side] += velocity / units.counts_per_unit / static_cast<double>(on_bus.drives_of_side);
}

}  // namespace kenaf::candrives
