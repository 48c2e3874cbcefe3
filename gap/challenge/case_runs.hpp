// The robots of a case and their runs.
//
// Thread safety: pure functions, except for the files they write. Deterministic for a plan, on any number of threads.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "gap/challenge/plan.hpp"
#include "physics/robot_description.hpp"

namespace kenaf::gap::challenge {

// Returns the "real" robot, with background, number and effects of the plan.
physics::RobotDescription hidden_robot(const CasePlan& plan);
// Returns the robot before its last change, with the background alone.
physics::RobotDescription robot_before(const CasePlan& plan);
// Returns the nominal robot with the hidden effects at the values that a model needs for them (value_in_model), except
// those named in `without`.
physics::RobotDescription hidden_robot_in_model(const CasePlan& plan, const std::vector<std::string>& without = {});

struct RunsToWrite {
  std::vector<std::string> manoeuvres;
  std::vector<double> longest_s;  // as in CasePlan
  int repeats;
  std::uint64_t seed;
};
// Writes a dataset of `robot` with the contacts, the noise and the foreign deviation of a plan. Throws Stopped soon
// after `stop` becomes true; it may be null.
void write_case_runs(const CasePlan& plan, const physics::RobotDescription& robot, const RunsToWrite& runs,
                     const std::filesystem::path& folder, unsigned jobs, const std::atomic<bool>* stop);

}  // namespace kenaf::gap::challenge
