// From a dataset to a verdict: the whole diagnosis, without its reports.
// Deterministic: the same dataset, options and seed give the same result, on any number of threads.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "gap/diagnose/decision.hpp"
#include "gap/diagnose/observation.hpp"

namespace kenaf::gap {

struct DiagnosisOptions {
  std::string robot, world;           // instead of the dataset's; empty: its own
  std::vector<std::string> without;   // effects taken out of the catalogue
  unsigned jobs = 0;                  // threads; 0: one a core
  std::uint64_t seed = 1;
  double span_s = 0.25;               // of a bin (chosen: four to a manoeuvre's quickest event)
  double stretch_s = 1;               // of a cell
  DecisionSettings decision;
};

// The fit of one effect, for the ranking.
struct EffectEvidence {
  const physics::EffectInfo* effect;
  const physics::EffectParameter* parameter;
  double value, ci95_from, ci95_to;
  double explains;      // share of the gap beyond the floor, of all runs
  double heldout_shrink, heldout_shrink_from, heldout_shrink_to;
  double p_value;       // of as much explained by chance
  bool at_bound;
};

struct Diagnosis {
  Observations observations;
  std::vector<FeatureMap> features;
  NoiseFloor floor;
  EffectCurves curves;
  Decision decision;
  std::vector<EffectEvidence> effects;   // of `decision.best` first, then the other single effects, best first
  std::size_t roll_outs = 0;
};

Diagnosis diagnose(const std::filesystem::path& folder, const DiagnosisOptions& options);

}  // namespace kenaf::gap
