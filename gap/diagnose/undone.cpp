#include "gap/diagnose/undone.hpp"

#include <algorithm>
#include <cmath>

namespace kenaf::gap {

std::optional<Undone> undone(const EffectCurves& curves, const Model& model, const Coherence& coherence) {
  if (model.places.size() < 2) return std::nullopt;
  const auto by_channel = [&](const Shift& shift) {
    Whitened whitened;
    for (std::size_t r = 0; r < shift.size(); ++r) whitened.push_back(curves.whiteners[r](shift[r]));
    return coherence.by_channel(whitened);
  };
  std::vector<double> largest(coherence.by_channel({}).size(), 0);
  for (const OnCurve& place : model.places) {
    const std::vector<ChannelEnergy> alone = by_channel(shift_of(curves, {&place, 1}));
    for (std::size_t c = 0; c < alone.size(); ++c) largest[c] = std::max(largest[c], std::sqrt(alone[c].energy));
  }
  return std::nullopt;
}

}  // namespace kenaf::gap
