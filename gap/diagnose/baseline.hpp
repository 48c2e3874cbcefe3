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

// Adds to each run what another start pose does beyond shapes that are linear in it: from there a climb or a fall
// begins at another time, and the robot leaves an obstacle in another direction. d: the difference between the run's
// simulation and its baseline's, less the best fit of the start pose's shapes. The real difference is another one of
// that size, of which d is the only example: both have 2 d, spread over the run and its baseline as their noise is.
// Nothing on flat ground undoes a change of x, y or yaw: each period's change of d is a way on of unknown amount, from
// then on, and rough where it happens. All other channels return: they are rough by d. What happens in a bin may happen
// in the one beside it. `simulated`: of each run, of the nominal robot.
void add_other_ways(std::vector<OpenShapes>& open, const std::vector<StageFeatures>& features,
                    const std::vector<Eigen::VectorXd>& simulated);

}  // namespace kenaf::gap::diagnose
