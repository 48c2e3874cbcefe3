// The charts of single runs: measured and simulated.
//
// Thread safety: pure functions.
#pragma once

#include <span>

#include "gap/diagnose/page/moments.hpp"
#include "gap/diagnose/page/overlays.hpp"
#include "gap/plot/chart.hpp"

namespace kenaf::gap::diagnose {

inline constexpr double kWide_px = 1060, kHalf_px = 524;

// One channel over time; `index` into Overlay::channels.
plot::Chart channel_figure(const Diagnosis& d, const Overlay& overlay, std::size_t index);

// The path to scale: from the side if the robot changes its height, otherwise from above.
plot::Chart path_figure(const Diagnosis& d, const Overlay& overlay);

// Its residual, as means over short spans, in the channel's unit.
plot::Chart channel_residual_figure(const Diagnosis& d, const Overlay& overlay, std::size_t index);

// The rms of all channels over time, in times the noise (run_gap.hpp).
plot::Chart residual_figure(const Diagnosis& d, const Overlay& overlay);

// The path with the gap of each phase of a stage at the place of the phase, before (rings) and after (discs); each
// links to the moment of its phase.
plot::Chart places_figure(const Diagnosis& d, const Overlay& overlay, std::span<const Moment> moments,
                          std::size_t stage);

}  // namespace kenaf::gap::diagnose
