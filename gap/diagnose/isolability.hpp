// Which effects these runs can distinguish.
//
// Thread safety: pure functions.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "gap/diagnose/effect_curves.hpp"

namespace kenaf::gap::diagnose {

// Effects whose shifts are at a smaller angle cannot be distinguished. For a cause outside the catalogue, the angles of
// its look-alike count.
inline constexpr double kDistinguishable_deg = 10;

struct Isolability {
  std::vector<std::size_t> candidates;  // those that these runs show at all
  Eigen::MatrixXd angle_deg;            // between their shifts, 0 (the same) to 90 (orthogonal)
};
// Angles between the directions in which small amounts of each effect shift all runs, in units of noise.
Isolability isolability(const StageData& data, const EffectCurves& curves);

}  // namespace kenaf::gap::diagnose
