// Effects that undo each other: one moves a channel by a lot, another one moves it back, and nothing is seen there.
//
// A robot of which both are true would have to have two values that fit each other to a few hundredths, in a channel that shows
// none of it. Rather it has one thing that the catalogue lacks and that moves the other channels only: encoders that read too much
// are a robot that drives faster and slips by as much. So such a model fits, on runs held out too, and is no name.
// Thread safety: pure functions.
#pragma once

#include <optional>

#include "gap/diagnose/coherence.hpp"
#include "gap/diagnose/model_search.hpp"

namespace kenaf::gap {

struct Undone {
  std::size_t channel;  // of diagnosis_channels()
  double alone;         // floors by which one of the effects moves it, repeats and neighbouring bins averaged
  double together;      // floors by which all of them do
};
// Of an effect that moves a channel by that many floors at least, all may leave that share. Chosen: docs/gap-method.md.
inline constexpr double kSeenAlone = 20, kUndone = 0.05;

// Where most is undone. What each does alone is taken from its curve.
std::optional<Undone> undone(const EffectCurves& curves, const Model& model, const Coherence& coherence);

}  // namespace kenaf::gap
