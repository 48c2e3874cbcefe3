// Candidates that explain as much as one effect of a best model in its place.
//
// Thread safety: pure functions, except that the simulator runs. Deterministic.
#pragma once

#include <cstddef>
#include <vector>

#include "gap/diagnose/decision_settings.hpp"
#include "gap/diagnose/side_by_side.hpp"

namespace kenaf::gap::diagnose {

// Models with a rival in the place of one effect, the best model itself first. `curves`: of all candidates alone.
// `without`: the best model without the effect.
std::vector<Settings> rivals_of(const StageData& data, const EffectCurves& curves, const StandingModel& standing,
                                std::size_t place, const Model& without, const Simulate& simulate,
                                const DecisionSettings& settings);

}  // namespace kenaf::gap::diagnose
