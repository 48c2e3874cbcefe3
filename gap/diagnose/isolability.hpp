// Which effects these runs can tell apart, and which manoeuvre would do it better.
// Thread safety: pure functions.
#pragma once

#include <Eigen/Core>
#include <atomic>
#include <span>
#include <string>
#include <vector>

#include "gap/diagnose/effect_curves.hpp"
#include "gap/diagnose/model_search.hpp"

namespace kenaf::gap {

// Two effects whose shifts are at a smaller angle cannot be told apart; an effect that is no closer to any other one can be
// told from all of them. Of what is outside the catalogue the same is said of its look-alike.
inline constexpr double kToldApart_deg = 10;

struct Isolability {
  std::vector<std::size_t> curves;  // that these runs show at all
  Eigen::MatrixXd angle_deg;        // between their shifts, 0 (the same) to 90 (nothing in common)
};
// Between the directions in which small amounts of each effect move all runs together, in floors.
Isolability isolability(const EffectCurves& curves);

struct NextManoeuvre {
  std::string manoeuvre;
  std::vector<std::size_t> separates;  // curves
  double expected_score;  // floors by which the two that are hardest to tell apart would differ in one run of it
};
// Of the shipped manoeuvres that last at most 40 s and that the robot can drive, best first. `rivals`: models that are to be
// told apart, each at the values that fit; what a change of their own values could take back does not count. Throws Stopped
// once `stop` is true.
std::vector<NextManoeuvre> rank_manoeuvres(const physics::RobotDescription& robot, const EffectCurves& curves,
                                           std::span<const Model> rivals, const NoiseFloor& floor, double span_s,
                                           unsigned threads, const std::atomic<bool>* stop);

}  // namespace kenaf::gap
