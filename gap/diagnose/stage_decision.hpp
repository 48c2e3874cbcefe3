// Which effects explain the gap of one stage: none, some by name, some that these runs cannot tell apart, or none of the
// candidates. What a named model leaves is reported and takes no name away: it makes evidence weaker, by the discrepancy
// (likelihood.hpp), and intervals wider. docs/gap-method.md has the reasoning.
// Thread safety: pure functions apart from what the simulator does. Deterministic.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gap/diagnose/evidence.hpp"
#include "gap/diagnose/model_search.hpp"
#include "gap/diagnose/side_by_side.hpp"

namespace kenaf::gap {

enum class Verdict { none, named, ambiguous, unknown };
std::string_view verdict_name(Verdict verdict);

// Why an effect of the best model, or the model, gets no name.
enum class Doubt {
  end_of_range,     // the value ends where the range does: it stands for something that the effect cannot do
  ordinary,         // a number of the description that is off by no more than its other numbers are
  disagreement,     // manoeuvres want values that differ by more than a share of the effect
  not_held_out,     // on runs or manoeuvres held out it takes off too little
  trifle,           // of the stage's whole gap it takes off next to nothing
  little_explained, // in the channels where it acts, the whole model takes off too little on runs held out
};

struct DecisionSettings {
  double false_alarm = 0.005;      // chance of a verdict other than none where there is no gap
  double negligible = 0.25;        // of the noise's length: what explains less is no gap that anybody would see (chosen)
  double surprise = 0.005;         // chance to call a complete explanation incomplete
  double evidence = 16;            // deviance that an effect must gain: 4 sigma, for the best of some 70 candidates (chosen)
  double rival_evidence = 9;       // deviance by which a rival must be worse: 3 sigma
  // Of the squared gap of the kind of channels where an effect takes off most, on runs held out: what the effect must take off,
  // and what the whole model must (chosen).
  double effect_share = 0.2, model_share = 0.5;
  double stage_share = 0.1;        // of the stage's whole squared gap, what the effect must take off (chosen)
  double ordinary = 3;             // a number of the description is named beyond so many sigma of all of them
  double agreement = 1;            // an effect is at least as many times its spread between manoeuvres (chosen): then five in
                                   // six of them agree on its sign
  std::size_t most_effects = 6;
  SearchSettings search;
};

// The data of a stage around a model: noise as it is, and what the simulation leaves open with these effects.
struct StageAround {
  NoiseFloor floor;
  StageData data;
  // NoiseFloor::number_shapes, of those too that have a value (number_shapes.hpp).
  std::vector<Eigen::MatrixXd> shapes_of_all_numbers{};
};
// `valued`: candidates whose values are estimated, so that they are no numbers that are a little off.
using Around = std::function<StageAround(const Settings& model, std::span<const std::size_t> valued)>;

// What noise is held to be where there is no gap.
struct GapTest {
  double inflation = 1;  // of variances: inflation_from_repeats()
  double stretch_s = 1;  // of a cell
};

struct NamedEffect {
  std::size_t candidate;
  EffectValue value;
  double evidence = 0;              // deviance that the model without it has more
  HeldOutShares::OfEffect share{};               // on runs held out
  // On manoeuvres held out; as `share` where there is one alone, not a number where one alone shows the effect.
  HeldOutShares::OfEffect share_by_manoeuvre{};
  bool at_bound = false;
  std::vector<Doubt> doubts;        // none: it is named, alone or in a set
  std::vector<std::size_t> rivals;  // candidates that do as well in its place, itself first
  // Of an effect that takes off enough only together with others of the model, as each takes up what the others leave:
  // their places, and what all of them take off. They are among the rivals.
  std::vector<std::size_t> partners{};
  HeldOutShares::OfEffect share_of_set{};
  // How far numbers of the description are off, 1 sigma, in the unit of this one; 0: it is none of them.
  double ordinarily_off = 0;
};

struct StageDecision {
  Verdict verdict = Verdict::none;
  StandingModel best;               // no places: nominal
  std::vector<NamedEffect> effects; // of the best model, in the order of its places
  std::vector<std::vector<Settings>> models_of_rivals;  // of each effect: the model with each of its rivals in its place
  std::vector<Model> singles;       // best first
  NoiseFloor floor;                 // around the best model
  StageData data;
  std::vector<Eigen::MatrixXd> shapes_of_all_numbers;  // likewise, of StageAround
  double p_gap = 1, p_left = 1;
  double nominal_deviance = 0;
  bool complete = false;            // what is left is within noise and spread
};

// An effect that another stage names, alone.
struct NamedElsewhere {
  std::size_t candidate;
  Interval value;
};

// `elsewhere`: one of them that is among an effect's rivals, at a value that both intervals allow, is what both stages show: it takes
// the effect's place, and has no rivals.
StageDecision decide_stage(const StageAround& nominal, const EffectCurves& curves, const Simulate& simulate,
                           const Around& around, const GapTest& test, const DecisionSettings& settings,
                           std::span<const NamedElsewhere> elsewhere = {});

// `decided` with these of its best model's effects alone, fitted again where they stand: what has no name is no part of what is
// said of the others. The single effects stay as they are.
StageDecision with_effects_alone(StageDecision decided, std::span<const std::size_t> places, const EffectCurves& curves,
                                 const Simulate& simulate, const Around& around, const GapTest& test,
                                 const DecisionSettings& settings, std::span<const NamedElsewhere> elsewhere = {});

// The first of an effect's rivals, itself among them, that another stage names at such a value; its place among them.
std::optional<std::size_t> settled_elsewhere(const StageDecision& decision, std::size_t effect,
                                             std::span<const Candidate> candidates,
                                             std::span<const NamedElsewhere> elsewhere);

}  // namespace kenaf::gap
