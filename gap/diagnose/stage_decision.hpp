// Decides whether a stage has a gap, and finds the model that explains it best, with values, evidence and rivals of its
// effects. Which of them get a name is for judge() (judgement.hpp) to decide, from their shares on held-out runs.
//
// A residual beyond noise alone keeps no effect from a name: it is reported, and via the discrepancy (likelihood.hpp)
// it weakens evidence and widens intervals. docs/gap-method.md has the reasoning.
//
// Thread safety: pure functions, except that the simulator runs. Deterministic.
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

enum class Verdict {
  none,       // no gap beyond noise and the spread of repeats
  named,      // a gap, and effects that explain it
  ambiguous,  // the same, but these runs cannot distinguish some effect from its rivals
  unknown,    // a gap, and no effect with a name
};
std::string_view verdict_name(Verdict verdict);

// Reasons why an effect of the best model gets no name.
enum class Doubt {
  end_of_range,      // the value is at the end of its range: it absorbs something that the effect cannot model
  ordinary,          // the error of a number of the description is no larger than that of the others
  disagreement,      // values of manoeuvres differ by more than a share of the effect
  trend,             // so do values of earlier and later parts of runs
  kinds_differ,      // so do values of kinds of channels
  uncertain,         // errors of the description's numbers change its value by too large a part of it
  not_held_out,      // it explains too little on held-out runs or manoeuvres
  negligible,        // it explains hardly anything of the stage's whole gap
  little_explained,  // in the channels where it acts, the whole model explains too little on held-out runs
  leaves_much,       // in channels that it should explain, the model leaves too much of its shift
  not_simulated,     // simulated on held-out runs, the whole model explains too little of the stage
  not_predicted,     // the same on held-out manoeuvres: the others predict nothing of what one manoeuvre shows
};

// The data of a stage around a model: the same noise, and the open shapes (noise_floor.hpp) of the simulation with the
// model's effects.
struct StageAround {
  NoiseFloor floor;
  StageData data;
  // NoiseFloor::number_shapes including numbers that have a value (number_shapes.hpp).
  std::vector<Eigen::MatrixXd> shapes_of_all_numbers{};
};
// `valued`: candidates whose values are estimated, which removes them from the population of small errors.
using Around = std::function<StageAround(const Settings& model, std::span<const std::size_t> valued)>;

// Noise assumptions of the test for a gap.
struct GapTest {
  double inflation = 1;  // of variances: inflation_from_repeats()
  double stretch_s = 1;  // of a cell
};

// Whether kinds of channels contradict the effect: it resembles what it explains, and is not its cause
// (fit_by_kind.hpp).
bool is_misfit_of_kinds(Doubt doubt);

// An effect of a best model, with or without a name.
struct ModelEffect {
  std::size_t candidate;
  EffectValue value;
  double evidence = 0;  // additional deviance of the model without it
  // Shares and doubts are those of judge(); until then there are none.
  HeldOutShares::OfEffect share{};  // on runs held out
  // On held-out manoeuvres; equal to `share` if there is only one, NaN if only one shows the effect.
  HeldOutShares::OfEffect share_by_manoeuvre{};
  bool at_bound = false;
  std::vector<Doubt> doubts;        // none after judge(): it is named, alone or in a set
  std::vector<std::size_t> rivals;  // candidates that explain as much in its place, first itself (kItself)
  // For an effect that explains enough only together with others of the model, as each compensates for the others:
  // their places, and the share of all of them. They are among the rivals.
  std::vector<std::size_t> partners{};
  HeldOutShares::OfEffect share_of_set{};
  // Error of the description's numbers, 1 sigma, in the unit of this one; 0 for other candidates.
  double ordinarily_off = 0;
  bool is_named_elsewhere = false;  // by another stage, at a value within both intervals
  // Difference from its present value at which errors of the description's numbers could not be its cause; 0 if there
  // are none.
  double sure_from = 0;
};

// Index of an effect itself among its rivals, and of the best model among the models with these.
inline constexpr std::size_t kItself = 0;

struct StageDecision {
  Verdict verdict = Verdict::none;                      // with effects: of judge()
  StandingModel best;                                   // no places: nominal
  std::vector<ModelEffect> effects;                     // of the best model, in the order of its places
  std::vector<std::vector<Settings>> models_of_rivals;  // by effect: models with its rivals in its place, first kItself
  std::vector<Model> singles;                           // best first
  EffectCurves curves;                                  // of single effects, as far as the search has followed them
  NoiseFloor floor;                                     // around the best model
  StageData data;
  std::vector<Eigen::MatrixXd> shapes_of_all_numbers;  // likewise, from StageAround
  double p_gap = 1, p_left = 1;
  double nominal_deviance = 0;
  bool complete = false;  // the residual is within noise and spread
};

// Without a gap the verdict is `none`. With one it is `unknown`: if there are effects, judge() has to replace it.
//
// `elsewhere`: if another stage names one of an effect's rivals at a value within both intervals, both stages show that
// rival: it replaces the effect and has no rivals. What another stage refutes is not searched for.
StageDecision decide_stage(const StageAround& nominal, const EffectCurves& curves, const Simulate& simulate,
                           const Around& around, const GapTest& test, const DecisionSettings& settings,
                           const Elsewhere& elsewhere = {});

// Another best model with which a stage is decided again.
struct OtherModel {
  Settings model;   // refitted together
  Settings around;  // the simulation's open shapes are those of the robot with these effects
};
// `decided` with only these of its best model's effects: those that explain nothing must not influence the others.
OtherModel with_effects_alone(const StageDecision& decided, std::span<const std::size_t> places);
// `decided` with the model of a rival of one effect.
OtherModel with_rival(const StageDecision& decided, std::size_t effect, std::size_t rival);
// Decides again: the other model becomes the best one. The verdict has to be judged again.
StageDecision decide_again(StageDecision decided, const OtherModel& other, const Simulate& simulate,
                           const Around& around, const GapTest& test, const DecisionSettings& settings,
                           const Elsewhere& elsewhere = {});

// Index of the first of an effect's rivals, including itself, that another stage names at a value within both
// intervals.
std::optional<std::size_t> settled_elsewhere(const StageDecision& decision, std::size_t effect,
                                             std::span<const candidates::Candidate> candidates,
                                             std::span<const NamedElsewhere> elsewhere);

}  // namespace kenaf::gap::diagnose
