// The charts of single runs: what was measured beside what is simulated.
//
// Thread safety: pure functions.
#pragma once

#include "gap/diagnose/page/overlays.hpp"
#include "gap/plot/chart.hpp"

namespace kenaf::gap::diagnose {

inline constexpr double kWide_px = 1060, kHalf_px = 524;

// One channel over time; `index` of Overlay::channels.
plot::Chart channel_figure(const Diagnosis& d, const Overlay& overlay, std::size_t index);

// The path to scale: from the side where the robot changes its height, otherwise from above.
plot::Chart path_figure(const Diagnosis& d, const Overlay& overlay);

// What of it is left, as means over short spans, in the channel's unit.
plot::Chart channel_residual_figure(const Diagnosis& d, const Overlay& overlay, std::size_t index);

// Over time the rms of all channels, in noise units.
plot::Chart residual_figure(const Diagnosis& d, const Overlay& overlay);

// The path with the gap of each phase of a stage at the place of the phase, before (rings) and after (discs).
plot::Chart places_figure(const Diagnosis& d, const Overlay& overlay, const StageDiagnosis& stage);

}  // namespace kenaf::gap::diagnose
