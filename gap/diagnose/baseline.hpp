// Isolates what changed in a robot between two datasets of the same manoeuvres.
//
// The model's discrepancy is present before and after the change, whatever its cause. So the mean residual of the
// earlier runs that repeat a run is subtracted from that run's residual: the shared discrepancy cancels, and the change
// and the noise of both remain. Thread safety: values and pure functions, except that the simulator runs.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "gap/diagnose/noise_floor.hpp"
#include "gap/diagnose/observation.hpp"
#include "gap/diagnose/prediction.hpp"

namespace kenaf::gap::diagnose {

struct Baseline {
  Observations observations;                     // described as the new dataset's robot
  std::vector<std::vector<std::size_t>> of_run;  // for each run of the new dataset, the baseline's runs that repeat it
};

// Reads the runs of `folder` that repeat those of `now`: same world, commands and initial speed; manoeuvre names do not
// matter. Removes runs of `now` without a repeat, with a warning. `world` as for observe(). Throws like observe(), and
// runs::RunFileError if no run is left.
Baseline observe_baseline(const std::filesystem::path& folder, Observations& now, const std::string& world,
                          const logs::RefusedRuns& refused_runs = {});

// Subtracts the baseline's mean residual from `now.of_stage`. Drops bins that no baseline run has. `residuals`:
// measured minus nominal for each stage and each baseline run; `before`: the baseline's features.
void compare_against(ComparedFeatures& now, const Baseline& baseline, const ComparedFeatures& before,
                     const std::array<std::vector<Eigen::VectorXd>, kPassages.size()>& residuals);

// Adds to the roughness of each run the difference d between its simulation and its baseline's, except for what is
// linear in the start pose: from another start pose a climb or a fall begins at another time, and the real one at yet
// another, by as much again: sqrt(2) d, of the bin itself or the one beside it. `simulated`: of each run, of the
// nominal robot.
void add_roughness_of_starts(std::vector<OpenShapes>& open, const std::vector<StageFeatures>& features,
                             const std::vector<Eigen::VectorXd>& simulated);

}  // namespace kenaf::gap::diagnose
