// Which effect explains the gap: none, one, two, a set that these runs cannot tell apart, or none of the catalogue.
//
// All thresholds are stated in floors, and the chance of a false alarm is read off draws of the floor itself.
// docs/gap-method.md has the reasoning. Deterministic for a seed.
// Thread safety: pure functions apart from what the simulator callbacks do.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "gap/diagnose/coherence.hpp"
#include "gap/diagnose/curve_fit.hpp"

namespace kenaf::gap {

enum class Verdict { none, named, ambiguous, unknown };

struct DecisionSettings {
  double false_alarm = 0.005;       // chance of a verdict other than none where there is no gap
  double surprise = 0.005;          // chance to call a gap unexplained that the right effect is fitted to
  double rival_margin = 9;          // squared floors by which a rival must be worse to be ruled out: 3 sigma at worst
  double model_share = 0.03;        // of a gap's length that even the right effect leaves: curves are straight, numerics differ
  std::size_t null_draws = 1000;
  std::size_t rivals_refined = 10;  // single effects, and pairs, whose curves are made exact where they fit best
  int rounds = 3;                   // of that
};

// A model: effects at their places, and what is left.
struct Model {
  std::vector<OnCurve> places;
  double left = 0;             // squared length, of all runs
  double coherent = 0;         // energy of what is left
  // whitened shift of each run by the effects together, simulated; the curves' sum where it was not
  std::vector<Eigen::VectorXd> shift;
};

struct Decision {
  Verdict verdict = Verdict::none;
  Model best;                                     // no places: nominal
  std::vector<Model> singles;                     // of each curve, best first
  std::vector<std::vector<std::size_t>> rivals;   // for each place of `best`: curves that fit as well, itself first
  double p_gap = 1;                               // of a gap that large by chance
  double p_left = 1;                              // of as much left by chance
  double inflation = 1;                           // of variances: how repeats differ beyond the floor
  double nominal_coherent = 0, chance_coherent = 0;
};

// What the decision needs of the simulator. `exact` returns the whitened shift of each run for effects at given values.
struct Simulator {
  std::function<void(EffectCurves&, std::span<const NewPoint>)> add_points;
  std::function<std::vector<std::vector<Eigen::VectorXd>>(std::span<const std::vector<OnCurve>>)> exact;
};

Decision decide(EffectCurves& curves, const Coherence& coherence, double inflation, const Simulator& simulator,
                const DecisionSettings& settings, std::uint64_t seed);

// How much more repeats of a manoeuvre differ, cell by cell, than the floor says; at least 1. 1 without repeats.
double inflation_from_repeats(const std::vector<FeatureMap>& features, const NoiseFloor& floor,
                              const std::vector<Eigen::VectorXd>& deviations, double stretch_s);

}  // namespace kenaf::gap
