// Stages hear each other: the same robot drove in all of them.
//
// Thread safety: pure functions apart from what the predictor does. Deterministic.
#pragma once

#include <vector>

#include "gap/diagnose/stage_diagnosis.hpp"

namespace kenaf::gap::diagnose {

// A stage is decided again where another one names a rival of what it names, or would see what it names, or a rival of
// it, and refutes it: with it there, beside the other's best model and alone, the other has more left. `prepared`: of
// each of `stages`.
void settle_by_other_stages(std::vector<StageDiagnosis>& stages, const std::vector<PreparedStage>& prepared,
                            Predictor& predictor, const StageOptions& options);

}  // namespace kenaf::gap::diagnose
