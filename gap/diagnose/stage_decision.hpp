// Which effects explain the gap of one stage: none, some by name, some that these runs cannot tell apart, or none of
// the candidates. What a named model leaves is reported and takes no name away: it makes evidence weaker, by the
// discrepancy (likelihood.hpp), and intervals wider. docs/gap-method.md has the reasoning.
//
// Thread safety: pure functions apart from what the simulator does. Deterministic.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gap/diagnose/decision_settings.hpp"
#include "gap/diagnose/elsewhere.hpp"
#include "gap/diagnose/evidence.hpp"
#include "gap/diagnose/model_search.hpp"
#include "gap/diagnose/side_by_side.hpp"

namespace kenaf::gap::diagnose {

enum class Verdict { none, named, ambiguous, unknown };
std::string_view verdict_name(Verdict verdict);

// Why an effect of the best model, or the model, gets no name.
enum class Doubt {
  end_of_range,      // the value ends where the range does: it stands for something that the effect cannot do
  ordinary,          // a number of the description that is off by no more than its other numbers are
  disagreement,      // manoeuvres want values that differ by more than a share of the effect
  trend,             // so do earlier and later parts of runs
  refuted,           // another stage would see it, and has more left with it
  not_held_out,      // on runs or manoeuvres held out it takes off too little
  trifle,            // of the stage's whole gap it takes off next to nothing
  little_explained,  // in the channels where it acts, the whole model takes off too little on runs held out
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
  HeldOutShares::OfEffect share{};  // on runs held out
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
  std::optional<Passage> refuted_by{};  // the stage that has more left with it
};

struct StageDecision {
  Verdict verdict = Verdict::none;
  StandingModel best;                // no places: nominal
  std::vector<NamedEffect> effects;  // of the best model, in the order of its places
  std::vector<std::vector<Settings>>
      models_of_rivals;        // of each effect: the model with each of its rivals in its place
  std::vector<Model> singles;  // best first
  NoiseFloor floor;            // around the best model
  StageData data;
  std::vector<Eigen::MatrixXd> shapes_of_all_numbers;  // likewise, of StageAround
  double p_gap = 1, p_left = 1;
  double nominal_deviance = 0;
  bool complete = false;  // what is left is within noise and spread
};

// `elsewhere`: an effect that another stage names and that is among an effect's rivals, at a value that both intervals
// allow, is what both stages show: it takes the effect's place, and has no rivals. Rivals that another stage refutes
// are none, and an effect that it refutes gives way to a rival that it does not.
StageDecision decide_stage(const StageAround& nominal, const EffectCurves& curves, const Simulate& simulate,
                           const Around& around, const GapTest& test, const DecisionSettings& settings,
                           const Elsewhere& elsewhere = {});

// How a stage is decided again with another best model.
struct OtherModel {
  Settings model;   // fitted again where it stands
  Settings around;  // the simulation's open shapes are those around this one
};
// `decided` with these of its best model's effects alone: what has no name is no part of what is said of the others.
OtherModel with_effects_alone(const StageDecision& decided, std::span<const std::size_t> places);
// `decided` with the model of a rival of one effect.
OtherModel with_rival(const StageDecision& decided, std::size_t effect, std::size_t rival);
// The single effects stay as they are.
StageDecision decide_again(StageDecision decided, const OtherModel& other, const EffectCurves& curves,
                           const Simulate& simulate, const Around& around, const GapTest& test,
                           const DecisionSettings& settings, const Elsewhere& elsewhere = {});

// The first of an effect's rivals, itself among them, that another stage names at such a value; its place among them.
std::optional<std::size_t> settled_elsewhere(const StageDecision& decision, std::size_t effect,
                                             std::span<const candidates::Candidate> candidates,
                                             std::span<const NamedElsewhere> elsewhere);

}  // namespace kenaf::gap::diagnose
