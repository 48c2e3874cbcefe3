// The robot of a case, and its runs.
//
// Thread safety: pure functions, but for the files they write. Deterministic for a plan, on any number of threads.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "gap/challenge/plan.hpp"
#include "physics/robot_description.hpp"

namespace kenaf::gap::challenge {

// The "real" robot: background, number and effects, as the plan has them.
physics::RobotDescription hidden_robot(const CasePlan& plan);
// The same before its last change: of the background alone.
physics::RobotDescription robot_before(const CasePlan& plan);
// The nominal robot with its hidden effects at the values that a model needs for the same (value_in_model); those named
// in `without` are left out.
physics::RobotDescription hidden_robot_in_model(const CasePlan& plan, const std::vector<std::string>& without = {});

struct RunsToWrite {
  std::vector<std::string> manoeuvres;
  std::vector<double> longest_s;  // as in CasePlan
  int repeats;
  std::uint64_t seed;
};
// A dataset of `robot` with the contacts, the noise and the foreign deviation of a plan. Throws Stopped soon after
// `stop`, if there is one, is true.
void write_case_runs(const CasePlan& plan, const physics::RobotDescription& robot, const RunsToWrite& runs,
                     const std::filesystem::path& folder, unsigned jobs, const std::atomic<bool>* stop);

}  // namespace kenaf::gap::challenge
