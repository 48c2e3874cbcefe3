// Reconciles the decisions of stages: the same robot drove in all of them.
//
// Thread safety: pure functions, except that the predictor runs. Deterministic.
#pragma once

#include <span>
#include <vector>

#include "gap/diagnose/stage_diagnosis.hpp"

namespace kenaf::gap::diagnose {

// Whether a candidate would increase the residual of a stage at each of its `values` (at least one), together with the
// rest of the stage's best model and alone: the deviance, and the squares of the kinds of channels in which it acts
// there.
bool refutes(const StageDecision& decision, const Simulate& simulate, std::span<const Setting> values,
             const DecisionSettings& settings);

// Whether a stage's best model lacks one of these effects, though it would gain as much evidence as the search asks
// for: the stage dropped it, as it has no name there.
bool lacks(const StageDecision& decision, const Simulate& simulate, std::span<const NamedElsewhere> named,
           const DecisionSettings& settings);

// The largest error of the description's numbers that other stages find, for a stage whose own data hardly show it:
// from body to sensor, as sensors' bins are differences from the body's motion, in which numbers cancel. 0 for others.
double numbers_off_elsewhere(const std::vector<StageDiagnosis>& stages, Passage passage);

// Decides a stage again if another one names a rival of one of its effects, or refutes the effect or a rival: with it,
// together with the other's best model and alone, the other's residual grows. Or if it lacks an effect that another one
// names. `prepared`: one per stage.
void settle_by_other_stages(std::vector<StageDiagnosis>& stages, const std::vector<PreparedStage>& prepared,
                            Predictor& predictor, const StageOptions& options);

}  // namespace kenaf::gap::diagnose
