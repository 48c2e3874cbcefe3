// Candidates that can act in a stage, and robots with some of them.
//
// Thread safety: pure functions.
#pragma once

#include <span>
#include <vector>

#include "gap/diagnose/effect_curves.hpp"
#include "gap/diagnose/stage_features.hpp"

namespace kenaf::gap::diagnose {

// The candidates that can act in a stage at some value. `drives_measured`: every run measured its tracks, so that the
// body is compared in a replay of these.
std::vector<std::size_t> candidates_of(Passage passage, std::span<const candidates::Candidate> candidates,
                                       bool drives_measured);

// The nominal robot with candidates at these values, in whatever order they are listed.
physics::RobotDescription with_settings(physics::RobotDescription robot,
                                        std::span<const candidates::Candidate> candidates, const Settings& settings);

}  // namespace kenaf::gap::diagnose
