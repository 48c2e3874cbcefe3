// What chance alone does where there is no gap, by draws of the floor.
// Thread safety: values and pure functions; deterministic for a seed.
#pragma once

#include <cstdint>
#include <vector>

#include "gap/diagnose/coherence.hpp"
#include "gap/diagnose/effect_curves.hpp"
#include "gap/diagnose/noise_floor.hpp"

namespace kenaf::gap {

struct Chance {
  std::vector<double> improvement;  // by the best single effect, of squared length; sorted
  std::vector<double> energy;       // of cells; sorted
};
Chance draw_chance(const EffectCurves& curves, const Coherence& coherence, std::size_t draws, std::uint64_t seed);

// The share of draws that reach `value`, never 0; energies beyond all draws by the tail of a Gaussian, which a sum of
// many squares is near to.
double p_of_improvement(const Chance& chance, double value);
double p_of_energy(const Chance& chance, double value);

// How much more repeats of a manoeuvre differ, cell by cell, than the floor says; at least 1. 1 without repeats.
double inflation_from_repeats(const std::vector<FeatureMap>& features, const NoiseFloor& floor,
                              const std::vector<Eigen::VectorXd>& deviations, double stretch_s);

}  // namespace kenaf::gap
