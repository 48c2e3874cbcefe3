// A robot whose tracks turn in the air, or on a stand: its body says nothing of contact with the ground.
//
// Thread safety: a value.
#pragma once

#include <optional>

#include "gap/logs/plausibility.hpp"

namespace kenaf::gap::logs {

// Looks at the runs of one log, one after another.
class LiftedRobot {
 public:
  // `gauge_m`: between the tracks.
  void look_at(const runs::Run& run, double gauge_m);
  // Where there are three runs or more in which the measured tracks would carry the robot 0.5 m or more, as a way or at
  // the tracks in a turn, and the pose goes less than 30 % of that in every one, less than 15 % in all together
  // (chosen): a robot on the ground that is blocked or spins in one run goes in another. Of the whole dataset; none of
  // a robot without a pose.
  std::optional<Finding> finding() const;

 private:
  std::size_t runs_ = 0;
  double belts_m_ = 0, body_m_ = 0;  // of all runs together
  double most_belts_m_ = 0, most_body_m_ = 0;
  bool goes_ = false;
};

// What is not compared of a robot that is lifted: pose and everything else that the body does.
void forget_body(runs::Run& run);

}  // namespace kenaf::gap::logs
