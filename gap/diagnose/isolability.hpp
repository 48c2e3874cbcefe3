// Which effects these runs can tell apart.
//
// Thread safety: pure functions.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "gap/diagnose/effect_curves.hpp"

namespace kenaf::gap::diagnose {

// Two effects whose shifts are at a smaller angle cannot be told apart; an effect that is no closer to any other one
// can be told from all of them. Of what is outside the catalogue the same is said of its look-alike.
inline constexpr double kToldApart_deg = 10;

struct Isolability {
  std::vector<std::size_t> candidates;  // that these runs show at all
  Eigen::MatrixXd angle_deg;            // between their shifts, 0 (the same) to 90 (nothing in common)
};
// Between the directions in which small amounts of each effect move all runs together, in units of noise.
Isolability isolability(const StageData& data, const EffectCurves& curves);

}  // namespace kenaf::gap::diagnose
