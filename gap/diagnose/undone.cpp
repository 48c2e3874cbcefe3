#include "gap/diagnose/undone.hpp"

#include <cmath>

namespace kenaf::gap {
namespace {

std::vector<double> lengths_by_channel(const EffectCurves& curves, const Coherence& coherence, const Shift& shift) {
  std::vector<double> lengths;
  for (const ChannelEnergy& channel : coherence.by_channel(whitened(curves, shift)))
    lengths.push_back(std::sqrt(channel.energy));
  return lengths;
}

}  // namespace

std::optional<Undone> undone(const EffectCurves& curves, const Model& model, const Coherence& coherence) {
  std::optional<Undone> most;
  if (model.places.size() < 2) return most;
  const std::vector<double> together = lengths_by_channel(curves, coherence, model.shift);
  for (const OnCurve& place : model.places) {
    const std::vector<double> alone = lengths_by_channel(curves, coherence, shift_of(curves, {&place, 1}));
    for (std::size_t c = 0; c < alone.size(); ++c) {
      if (alone[c] < kSeenAlone || together[c] > kUndone * alone[c]) continue;
      if (!most || together[c] * most->alone < most->together * alone[c]) most = Undone{c, alone[c], together[c]};
    }
  }
  return most;
}

}  // namespace kenaf::gap
