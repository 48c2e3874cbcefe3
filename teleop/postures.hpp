// The flipper postures that have a key, in degrees: front left, front right, rear left, rear right. Postures 3 to 5 are
// those with which an operator climbs a step (share/manoeuvres/step-flippers.toml).
#pragma once

#include <array>
#include <string_view>

#include "link.hpp"

namespace kenaf::teleop {

struct Posture {
  std::string_view name;
  std::array<double, kFlipperCount> flipper_deg;
};

inline constexpr std::array<Posture, 6> kPostures{{
    {"folded", {165, 165, 165, 165}},         // tips in, over the tracks: short, for narrow turns
    {"flat", {0, 0, 0, 0}},                   // straight out: longest, for trenches and stairs
    {"climb front", {58, 58, -20, -20}},      // nose up against a step, tail held
    {"over the edge", {-16, -16, -20, -20}},  // front flippers hook onto the top
    {"climb rear", {-40, -40, -49, -49}},     // rear flippers lift the tail, front ones soften the landing
    {"tall", {-70, -70, -70, -70}},           // body off the ground
}};

inline constexpr double kNudge_deg = 3;  // per press or repeat of a key that moves a flipper
inline constexpr double kMaxNudged_deg = 180;

}  // namespace kenaf::teleop
