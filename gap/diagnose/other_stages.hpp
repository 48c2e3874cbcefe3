// Reconciles the decisions of stages: the same robot drove in all of them.
//
// Thread safety: pure functions, except that the predictor runs. Deterministic.
#pragma once

#include <vector>

#include "gap/diagnose/stage_diagnosis.hpp"

namespace kenaf::gap::diagnose {

// Decides a stage again if another one names a rival of one of its effects, or refutes the effect or a rival: with it,
// together with the other's best model and alone, the other's residual grows. `prepared`: one per stage.
void settle_by_other_stages(std::vector<StageDiagnosis>& stages, const std::vector<PreparedStage>& prepared,
                            Predictor& predictor, const StageOptions& options);

}  // namespace kenaf::gap::diagnose
