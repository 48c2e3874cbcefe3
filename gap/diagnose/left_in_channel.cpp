#include "gap/diagnose/left_in_channel.hpp"

#include <algorithm>

#include "gap/diagnose/agreement.hpp"

namespace kenaf::gap {

LeftInChannel left_in_channel(const EffectCurves& curves, const Model& model, const Coherence& coherence,
                              double numerics, double inflation) {
  const std::vector<ChannelEnergy> without = coherence.by_channel(curves.gap);
  const std::vector<ChannelEnergy> left =
      coherence.by_channel(whitened_difference(curves, curves.residual, model.shift));
  LeftInChannel least;
  double channels = 0;
  for (std::size_t c = 0; c < left.size(); ++c) {
    if (left[c].cells == 0) continue;
    ++channels;
    const double energy = std::max(0.0, left[c].energy - numerics * without[c].energy) / inflation;
    const double p = p_of_squares(energy, static_cast<double>(left[c].cells));
    if (p < least.p) least = {c, p};
  }
  least.p = std::min(1.0, channels * least.p);
  return least;
}

}  // namespace kenaf::gap
