// Deviations that no candidate of a diagnosis describes, and their effect on commands or measurements.
//
// Thread safety: pure functions.
#pragma once

#include <string_view>

#include "formats/runs/run_file.hpp"
#include "rollout/manoeuvre.hpp"

namespace kenaf::gap::challenge {

// `amount`: 0 changes nothing, 1 is the largest credible deviation.

// Whether a deviation changes commands; obey_foreign() changes those of a replay to the ones that the robot obeys.
bool is_of_commands(std::string_view foreign);
void obey_foreign(rollout::Manoeuvre& replay, std::string_view foreign, double amount);
// Changes the recorded columns of a run.
void record_foreign(runs::Run& run, std::string_view foreign, double amount);

}  // namespace kenaf::gap::challenge
