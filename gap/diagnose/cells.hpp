// How far residuals are from noise, summed where a gap adds up and noise does not: a cell is one channel in one stretch
// of time of one manoeuvre.
//
// Thread safety: pure functions.
#pragma once

#include "gap/diagnose/likelihood.hpp"

namespace kenaf::gap::diagnose {

struct CellEnergy {
  double sum =
      0;  // of squared cells: each is the mean of its whitened bins, scaled to be standard normal without a gap
  double cells = 0;
  // Chance that noise reaches the sum; `inflation`: of its variance.
  double p_of_noise(double inflation) const;
};
// Of what a model leaves; shapes that the simulation leaves open are taken off.
CellEnergy cell_energy(const StageData& data, const GroupVectors& rest, double stretch_s);

// How much more repeats of a manoeuvre differ, cell by cell, than the floor says: a factor on variances, at least 1. 1
// without repeats.
double inflation_from_repeats(const std::vector<StageFeatures>& features, const NoiseFloor& floor,
                              const std::vector<Eigen::VectorXd>& deviations, double stretch_s);

}  // namespace kenaf::gap::diagnose
