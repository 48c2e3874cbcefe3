// Energy of residuals in cells, in which a gap adds up and noise averages out: a cell is one channel in one stretch of
// time of one manoeuvre.
//
// Thread safety: pure functions.
#pragma once

#include "gap/diagnose/likelihood.hpp"

namespace kenaf::gap::diagnose {

struct CellEnergy {
  double sum = 0;  // of squared cells: means of whitened bins, scaled to be standard normal without a gap
  double cells = 0;
  // Probability that noise alone reaches the sum; `inflation`: factor on its variance.
  double p_of_noise(double inflation) const;
};
// Cell energy of a model's residual `rest`, without the simulation's open shapes.
CellEnergy cell_energy(const StageData& data, const GroupVectors& rest, double stretch_s);

// Ratio of the variance between repeats, by cells, to the floor's variance: at least 1; 1 without repeats.
double inflation_from_repeats(const std::vector<StageFeatures>& features, const NoiseFloor& floor,
                              const Deviations& repeats, double stretch_s);

}  // namespace kenaf::gap::diagnose
