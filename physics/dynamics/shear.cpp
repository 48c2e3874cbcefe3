#include "physics/dynamics/shear.hpp"

#include <algorithm>
#include <cmath>

#include "physics/dynamics/belt_ground.hpp"

namespace kenaf::physics {
namespace {

// Below this speed a belt stands, and has all of its friction at once. Chosen: above what the iterations leave of the
// speed of a belt that a motor holds (0.02 mm/s on a slope), far below any command.
constexpr double kStanding_mps = 1e-4;

bool on_lower_run(const BeltTouch& touch) {
  return touch.normal_T.z() > 0;
}

// (1 - exp(-x)) / x, 1 at 0.
btScalar mean_decay(btScalar x) {
  return x < 1e-8 ? 1 : -std::expm1(-x) / x;
}

// 1 - mean_decay(x), without the loss of digits near 0: x / 2 - x² / 6 + x³ / 24 - ...
btScalar mean_growth(btScalar x) {
  return x < 1e-3 ? x * (0.5 - x * (1.0 / 6 - x / 24)) : 1 - mean_decay(x);
}

PressedRun pressed_run(const BeltShape& belt, bool lower, std::span<BeltPair* const> pairs) {
  PressedRun pressed{belt.pieces + 1, -1};
  for (const BeltPair* pair : pairs) {
    if (pair->belt != &belt) continue;
    for (const BeltContact& contact : pair->contacts) {
      const BeltTouch& touch = contact.touch;
      if (touch.run_place < 0 || touch.gap_m >= 0 || on_lower_run(touch) != lower) continue;
      pressed.first = std::min(pressed.first, touch.run_place);
      pressed.last = std::max(pressed.last, touch.run_place);
    }
  }
  return pressed;
}

}  // namespace

Shearing shearing_of(const BeltShape& belt, std::span<BeltPair* const> pairs) {
  const Surface& surface = belt.surface;
  if (surface.shear_deformation_m <= 0 || !surface.belt) return {};
  const btScalar speed_mps = surface.belt->speed_mps;
  if (std::abs(speed_mps) < kStanding_mps) return {};
  return {1 / (surface.shear_deformation_m * std::abs(speed_mps)), speed_mps * surface.axis_y > 0,
          pressed_run(belt, true, pairs), pressed_run(belt, false, pairs)};
}

ShearStretch stretch_of(const BeltShape& belt, const BeltTouch& touch, const Shearing& shearing) {
  const bool lower = on_lower_run(touch);
  const auto& [first, last] = lower ? shearing.lower : shearing.upper;
  const int place = touch.run_place;
  if (place < first || place > last || first == last) return {};
  // The belt enters at the end that its surface comes from.
  const int behind = shearing.forward == lower ? last - place : place - first;
  const btScalar piece = shearing.rate * belt.length * belt.rise / belt.pieces;
  return {std::max(behind - 0.5, 0.0) * piece, std::min(behind + 0.5, 1.0 * (last - first)) * piece};
}

btScalar sheared_share_per_slip(const ShearStretch& stretch, btScalar slip_mps) {
  // The mean of 1 - exp(-s x) from x = a to b: with A = s a and D = s (b - a)
  //   1 - exp(-A) (1 - exp(-D)) / D = (1 - exp(-A)) + exp(-A) (1 - (1 - exp(-D)) / D).
  const btScalar A = slip_mps * stretch.from, D = slip_mps * (stretch.to - stretch.from);
  // As the slip vanishes: (a + b) / 2, the middle of the stretch.
  if (A + D < 1e-9) return (stretch.from + stretch.to) / 2;
  return (-std::expm1(-A) + std::exp(-A) * mean_growth(D)) / slip_mps;
}

}  // namespace kenaf::physics
