// Converts the nodes' measurements to the robot's state: SI units, travel that continues when the drives' counters
// wrap, posture from inclinometer and gyro.
#pragma once

#include <cstdint>
#include <vector>

#include "can/canbus/robot_bus.hpp"
#include "libkenaf_real/bus_cycle.hpp"
#include "libkenaf_real/commissioning.hpp"
#include "libkenaf_real/heading.hpp"
#include "robot/state.hpp"

namespace kenaf::real {

class MeasuredState {
 public:
  MeasuredState(const canbus::RobotBus& bus, const NodeFacts& facts, double period_s);

  // Updates for one beat, without allocating. Values of which nothing has come since the beat before are marked as held
  // (robot::held). No posture (kHasPosture) while inclinometer or gyro are silent or absent;
  // silence() names the one that is silent. After a short silence the heading catches up with the first rate measured
  // after it.
  robot::State update(const BusCycle& cycle, const Beat& beat);
  enum class Silence : std::uint8_t { none, inclinometer, gyro };
  Silence silence() const { return silence_; }
  std::optional<double> unlearnt_gyro_radps() const { return heading_.unlearnt_radps(); }  // as Heading

 private:
  void add_to_side(std::size_t drive, const DriveInput& input, robot::State& state);
  void add_posture(const BusCycle& cycle, double elapsed_s, robot::State& state);
  void mark_held(const ProcessImage& image, robot::State& state);

  const canbus::RobotBus& bus_;
  const NodeFacts facts_;
  const double period_s_;
  std::uint32_t last_beat_ = 0;
  struct Travel {
    std::int32_t last = 0;    // the drive's counter, which wraps
    std::int64_t counts = 0;  // since the first beat
  };
  std::vector<Travel> travels_;  // of each drive; not used for flippers
  // Times of arrival of what the beat before has had.
  struct Arrivals {
    std::optional<canopen::Time> state, effort;
  };
  std::vector<Arrivals> had_;  // of each drive
  std::optional<canopen::Time> had_battery_, had_slope_, had_gyro_;
  Heading heading_;
  double unseen_s_ = 0;  // time without inclinometer or gyro that the heading does not cover yet
  Silence silence_ = Silence::none;
};

}  // namespace kenaf::real
