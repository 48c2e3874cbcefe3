// Measures the size of gaps in the runs of a case.
//
// Thread safety: one thread at a time; calculates on as many as it is given. Deterministic.
#pragma once

#include <atomic>
#include <string>

#include "gap/challenge/compared_runs.hpp"
#include "gap/challenge/plan.hpp"
#include "gap/challenge/temporary_folder.hpp"

namespace kenaf::gap::challenge {

struct Size {
  double floors = 0;            // rms over all channels, relative to that of repeats of a robot without gap
  double times_background = 0;  // 0 without a background

  double planned_as(const CasePlan& plan) const { return plan.is_sized_by_background() ? times_background : floors; }
};

// Sizes in the manoeuvres of a plan, driven by a robot that hides nothing.
class CaseScale {
 public:
  // Throws Stopped soon after `stop` becomes true, as all other functions do; it may be null.
  CaseScale(const CasePlan& plan, unsigned jobs, const std::atomic<bool>* stop);

  double background_floors() const { return background_floors_; }
  // Sizes of effects, a number or a deviation on the robot of the background.
  Size size_of(const physics::Effects& effects);
  // What `effects` add to `others`, which are a part of them.
  Size size_beside(const physics::Effects& others, const physics::Effects& effects);
  Size size_of_number(const std::string& key, double value);
  Size size_of_foreign(const std::string& foreign, double amount);
  // The look-alike of the plan's effect outside the catalogue.
  LookAlike look_alike_of(const CasePlan& plan);

 private:
  Size size_of(const Differences& shifts) const;
  // Shift of a robot that has the background and the hidden effects, less the background's.
  Differences shift_of(const physics::RobotDescription& robot);
  Differences shift_of(const physics::Effects& effects);
  Differences shift_of_foreign(const std::string& foreign, double amount);

  unsigned jobs_;
  const std::atomic<bool>* stop_;
  TemporaryFolder folder_;
  physics::RobotDescription robot_;  // of the background
  ComparedRuns runs_;
  Floors floors_;
  double floor_rms_ = 1;
  Differences background_;  // the background's shift, by coarse simulation
  double background_floors_ = 0;
};

}  // namespace kenaf::gap::challenge
