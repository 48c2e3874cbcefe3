// Detects a robot whose tracks turn in the air or on a stand, so that its body tells nothing about ground contact.
//
// Thread safety: a value.
#pragma once

#include <optional>

#include "gap/logs/plausibility.hpp"

namespace kenaf::gap::logs {

// Looks at the runs of one log, one after another.
class LiftedRobot {
 public:
  // `gauge_m`: distance between the tracks.
  void look_at(const runs::Run& run, double gauge_m);
  // Returns a finding for the whole dataset if there are at least three runs in which the measured tracks would carry
  // the robot 0.5 m or more between the first pose and the last, forward or at the tracks in a turn, and the body goes
  // less than 30 % of that in each run and less than 15 % in all together (chosen), by its pose and its gyro: a robot
  // on the ground that is blocked or spins in one run moves in another. A mean turn rate below 0.05 rad/s counts as the
  // gyro's bias. None without a pose.
  std::optional<Finding> finding() const;

 private:
  std::size_t runs_ = 0;
  double belts_m_ = 0, body_m_ = 0;  // of all runs together
  double most_belts_m_ = 0, most_body_m_ = 0;
  bool goes_ = false;
};

// Empties the columns that are not compared of a lifted robot: pose and all other motion of the body.
void forget_body(runs::Run& run);

}  // namespace kenaf::gap::logs
