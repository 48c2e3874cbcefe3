// Deviations that no candidate of a diagnosis is: what they do to commands, or to what is measured of the robot.
//
// Thread safety: pure functions.
#pragma once

#include <string_view>

#include "formats/runs/run_file.hpp"
#include "rollout/manoeuvre.hpp"

namespace kenaf::gap::challenge {

// `amount`: 0 changes nothing, 1 is as much as is credible.

// What of the commands of a replay arrives, of one that changes commands at all.
bool is_of_commands(std::string_view foreign);
void obey_foreign(rollout::Manoeuvre& replay, std::string_view foreign, double amount);
// What is recorded of a run.
void record_foreign(runs::Run& run, std::string_view foreign, double amount);

}  // namespace kenaf::gap::challenge
