// From the robot's command to the command of each drive in a cycle: limits, ramps if the mode leaves them to the
// master, and the handshake of profile position mode.
#pragma once

#include <array>
#include <vector>

#include "can/canbus/robot_bus.hpp"
#include "can/canopen/drive.hpp"
#include "libkenaf_real/bus_cycle.hpp"
#include "robot/command.hpp"

namespace kenaf::real {

// A position that moves to a target within a speed and an acceleration limit and stops there without overshoot.
struct PositionRamp {
  double position = 0, speed = 0;
  void step(double target, double max_speed, double acceleration, double dt_s);
};

class DriveTargets {
 public:
  // Until they are commanded the flippers stay where `held` has told them to, which is not where they are measured if
  // they carry a load.
  DriveTargets(const canbus::RobotBus& bus, const DriveOrders& held);

  // Commands to flippers that the robot has not are ignored. A speed out of range is limited to the description's
  // maximum; a flipper angle is taken to the same direction within the limits or, if there is none, to the nearer
  // limit. Ramps advance by one period per call, even if the previous call is longer ago: a drive reaches each target
  // within a period, and catching up would be a jump beyond the limits.
  // Valid until the next call; allocates nothing.
  const DriveOrders& step(const robot::Command& command, const ProcessImage& image, double period_s);

 private:
  DriveOrder track(std::size_t drive, double speed_mps, double period_s);
  DriveOrder flipper(std::size_t drive, const robot::JointCommand& command, const DriveInput& input, double period_s);

  const canbus::RobotBus& bus_;
  DriveOrders orders_;             // of the newest step
  std::vector<double> track_mps_;  // of each drive: the speed it was commanded last; flippers 0
  std::array<double, robot::kFlipperCount> hold_rad_{};
  std::array<PositionRamp, robot::kFlipperCount> ramps_{};
  std::array<canopen::SetPointHandshake, robot::kFlipperCount> handshakes_{};
};

}  // namespace kenaf::real
