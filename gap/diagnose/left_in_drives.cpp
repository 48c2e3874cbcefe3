#include "gap/diagnose/left_in_drives.hpp"

#include <algorithm>

#include "gap/diagnose/agreement.hpp"
#include "gap/diagnose/channels.hpp"

namespace kenaf::gap {

std::optional<LeftInDrive> left_in_drives(const EffectCurves& curves, const Model& model, const Coherence& coherence,
                                          double inflation) {
  const std::vector<ChannelEnergy> without = coherence.by_channel(curves.gap);
  const std::vector<ChannelEnergy> with =
      coherence.by_channel(whitened_difference(curves, curves.residual, model.shift));
  std::optional<LeftInDrive> least;
  double channels = 0;
  for (std::size_t c = 0; c < with.size(); ++c) {
    if (with[c].cells == 0 || diagnosis_channels()[c].measured != physics::Stage::drive) continue;
    ++channels;
    if (with[c].energy <= kLeftByRight * without[c].energy) continue;
    const double p = p_of_squares(with[c].energy / inflation, static_cast<double>(with[c].cells));
    if (!least || p < least->p) least = {c, p, with[c].energy / without[c].energy};
  }
  if (least) least->p = std::min(1.0, channels * least->p);
  return least;
}

}  // namespace kenaf::gap
