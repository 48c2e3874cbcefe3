// From what the nodes measured to the robot's state: SI units, travel that counts on where the drives' counters wrap,
// posture from inclinometer and gyro.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "can/canbus/robot_bus.hpp"
#include "libkenaf_real/bus_cycle.hpp"
#include "libkenaf_real/commissioning.hpp"
#include "libkenaf_real/heading.hpp"
#include "robot/state.hpp"

namespace kenaf::real {

class MeasuredState {
 public:
  MeasuredState(const canbus::RobotBus& bus, const NodeFacts& facts, double period_s);

  // For one beat. Without posture (kHasPosture) while inclinometer or gyro are silent or there is none of them;
  // warning() says so. The heading catches up on a short silence with the rate that it finds after it.
  robot::State update(const BusCycle& cycle, const Beat& beat);
  const std::string& warning() const { return warning_; }

 private:
  void add_posture(const BusCycle& cycle, double elapsed_s, robot::State& state);

  const canbus::RobotBus& bus_;
  const NodeFacts facts_;
  const double period_s_;
  std::uint32_t last_beat_ = 0;
  std::array<std::int32_t, robot::kTrackCount> last_counts_{};
  std::array<std::int64_t, robot::kTrackCount> travelled_counts_{};
  Heading heading_;
  double unseen_s_ = 0;  // without inclinometer or gyro, and not in the heading yet
  std::string warning_;
};

}  // namespace kenaf::real
