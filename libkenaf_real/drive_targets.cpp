#include "libkenaf_real/drive_targets.hpp"

#include <algorithm>
#include <cmath>

#include "robot/angles.hpp"

namespace kenaf::real {

using canbus::DriveOnBus;
using canopen::DriveMode;

void PositionRamp::step(double target, double max_speed, double acceleration, double dt_s) {
  // The fastest speed from which it can still stop at the target, one step ahead: v dt / 2 + v^2 / (2 a) = remaining
  // way. If v is no whole number of speed steps, stopping takes up to dv dt / 8 more.
  const double left = target - position, way = std::abs(left), dv = acceleration * dt_s;
  const double reachable =
      way <= dv * dt_s ? way / dt_s : std::sqrt(dv * dv / 4 + 2 * acceleration * (way - dv * dt_s / 8)) - dv / 2;
  const double wanted = std::copysign(std::min(max_speed, reachable), left);
  speed = std::clamp(wanted, speed - dv, speed + dv);
  position += speed * dt_s;
}

DriveTargets::DriveTargets(const canbus::RobotBus& bus, const DriveOrders& held)
    : bus_(bus), orders_(bus.drives.size()), track_mps_(bus.drives.size()) {
  for (std::size_t i = 0; i < bus.drives.size(); ++i) {
    const DriveOnBus& drive = bus.drives[i];
    if (!drive.is_flipper()) continue;
    hold_rad_[*drive.flipper] = position_from_drive(drive.units, held[i].target);
    ramps_[*drive.flipper].position = hold_rad_[*drive.flipper];
  }
}

const DriveOrders& DriveTargets::step(const robot::Command& command, const ProcessImage& image, double period_s) {
  for (std::size_t i = 0; i < bus_.drives.size(); ++i) {
    const DriveOnBus& drive = bus_.drives[i];
    orders_[i] = drive.is_flipper() ? flipper(i, command.flipper[*drive.flipper], image.drive(i), period_s)
                                    : track(i, command.track_speed_mps[drive.side], period_s);
  }
  return orders_;
}

DriveOrder DriveTargets::track(std::size_t i, double speed_mps, double period_s) {
  const DriveOnBus& drive = bus_.drives[i];
  const double wanted_mps = std::clamp(speed_mps, -drive.max_speed, drive.max_speed);
  if (drive.mode == DriveMode::cyclic_velocity) {
    // The drive follows each target at once: the master does the ramp. The other way round begins with slowing down to
    // 0.
    const double before_mps = track_mps_[i];
    const double towards_mps = wanted_mps * before_mps < 0 ? 0 : wanted_mps;
    const bool slower = std::abs(towards_mps) < std::abs(before_mps);
    const double dv = (slower ? drive.quick_stop_deceleration : drive.acceleration) * period_s;
    track_mps_[i] = std::clamp(towards_mps, before_mps - dv, before_mps + dv);
  } else {
    track_mps_[i] = wanted_mps;
  }
  return {canopen::kControlEnable, velocity_to_drive(drive.units, track_mps_[i])};
}

DriveOrder DriveTargets::flipper(std::size_t i, const robot::JointCommand& command, const DriveInput& input,
                                 double period_s) {
  const DriveOnBus& drive = bus_.drives[i];
  const robot::Flipper f = *drive.flipper;
  const bool commanded = command.mode == robot::JointMode::angle;
  // a drive that was never commanded stays where it is, even outside its limits
  if (commanded)
    hold_rad_[f] = robot::reachable_angle(command.value, position_from_drive(drive.units, input.position),
                                          drive.min_position, drive.max_position);
  if (drive.mode == DriveMode::cyclic_position) {
    ramps_[f].step(hold_rad_[f], drive.max_speed, drive.acceleration, period_s);
    return {canopen::kControlEnable, position_to_drive(drive.units, ramps_[f].position)};
  }
  const std::int32_t target = position_to_drive(drive.units, hold_rad_[f]);
  // a drive in profile position mode holds the position at which it was enabled
  if (!commanded) return {canopen::kControlEnable, target};
  const std::uint16_t handshake = handshakes_[f].step(target, input.statusword);
  return {static_cast<std::uint16_t>(canopen::kControlEnable | handshake), target};
}

}  // namespace kenaf::real
