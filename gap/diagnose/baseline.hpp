// What changed in a robot between two datasets of the same manoeuvres.
//
// What both differ from the simulation by, whatever its cause, is there before and after the change. So each run of the
// new dataset is compared with the simulation less what the runs of before that repeat it differ from theirs: the
// model's discrepancy cancels as far as both share it, and what is left is the change and the noise of both. Thread
// safety: values and pure functions apart from what the simulator does.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "gap/diagnose/observation.hpp"
#include "gap/diagnose/prediction.hpp"

namespace kenaf::gap::diagnose {

struct Baseline {
  Observations observations;                     // described as the new dataset's robot
  std::vector<std::vector<std::size_t>> of_run;  // of each run of the new dataset: the baseline's runs that repeat it
};

// Runs of `folder` that repeat those of `now`: same world, commands and speed at the start, whatever the manoeuvres are
// called. Runs of `now` that none repeats are taken out, with a warning there. `world` as observe() takes it. Throws as
// observe() does, and runs::RunFileError where no run is left.
Baseline observe_baseline(const std::filesystem::path& folder, Observations& now, const std::string& world);

// Takes off `now.of_stage` what the baseline differs from its simulation by. Bins that no run of the baseline has are
// left out. `residuals`: measured minus nominal of each stage and each run of the baseline; `before`: its features.
void compare_against(ComparedFeatures& now, const Baseline& baseline, const ComparedFeatures& before,
                     const std::array<std::vector<Eigen::VectorXd>, kPassages.size()>& residuals);

}  // namespace kenaf::gap::diagnose
