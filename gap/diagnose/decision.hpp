// Which effect explains the gap: none, one or several, a set that these runs cannot tell apart, or none of the catalogue.
//
// All thresholds are stated in floors, and the chance of a false alarm is read off draws of the floor itself.
// docs/gap-method.md has the reasoning. Deterministic for a seed.
// Thread safety: pure functions apart from what the simulator callbacks do.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "gap/diagnose/chance.hpp"
#include "gap/diagnose/left_in_drives.hpp"
#include "gap/diagnose/model_search.hpp"
#include "gap/diagnose/undone.hpp"

namespace kenaf::gap {

enum class Verdict { none, named, ambiguous, unknown };

// Why the best model is not believed, each of which makes the verdict unknown.
enum class Doubt {
  much_left,      // more than chance leaves
  left_in_drive,  // the same in a single channel of the drives
  disagreement,   // manoeuvres want different values
  end_of_range,   // a value stands for something that its effect cannot do
  trifle,         // one of three effects or more accounts for too little
  undone,         // one effect takes back what another one does
  // found after decide(), on runs held out of the fit:
  not_held_out,    // too little of the gap is gone
  beyond_repeats,  // more is left than repeats differ by
};

struct DecisionSettings {
  double false_alarm = 0.005;       // chance of a verdict other than none where there is no gap
  double negligible = 0.25;         // of the noise's length: what explains less is no gap that anybody would see (chosen)
  double surprise = 0.005;          // chance to call a gap unexplained that the right effect is fitted to
  double rival_margin = 9;          // squared floors by which a model must be better than another one, or than none, to
                                    // count as better at all: 3 sigma at worst
  double model_share = 0.03;        // of a gap's length that even the right effect leaves: numerics differ
  std::size_t most_effects = 4;
  double due_share = 0.1;           // of what a model of three or more effects explains, that each of them must: with enough
                                    // effects anything can be explained (chosen)
  std::size_t null_draws = 1000;
  SearchSettings search;
};

struct Decision {
  Verdict verdict = Verdict::none;
  Model best;                                     // no places: nominal
  std::vector<Model> singles;                     // best first
  std::vector<Model> together;                    // of several effects that were tried, of the largest number, best first
  // All curves, those of the effects in `best` as they are where they stand beside one another (side_by_side.hpp). None without effects.
  std::vector<EffectCurve> beside;
  std::vector<Doubt> doubts;                      // where it is unknown, at least one
  std::vector<std::vector<std::size_t>> rivals;   // for each place of `best`: curves that fit as well, itself first
  double p_gap = 1;                               // of a gap that large by chance
  double p_left = 1;                              // of as much left by chance
  double p_agree = 1;                             // that manoeuvres differ as much about the best model's values
  std::optional<LeftInDrive> left_in_drive;
  std::optional<Undone> undone;
  double inflation = 1;                           // of variances: how repeats differ beyond the floor
};

// What noise and spread of repeats alone amount to.
struct Spread {
  double inflation = 1;       // inflation_from_repeats()
  double squared_length = 0;  // of all runs, whitened
};

Decision decide(EffectCurves& curves, const Coherence& coherence, const Spread& spread, const Simulator& simulator,
                const DecisionSettings& settings, std::uint64_t seed);

}  // namespace kenaf::gap
