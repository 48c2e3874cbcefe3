#include "gap/challenge/shrinks.hpp"

#include "gap/challenge/compared_runs.hpp"
#include "gap/diagnose/evidence.hpp"

namespace kenaf::gap {
namespace {

using Eigen::VectorXd;

std::vector<VectorXd> difference(const std::vector<VectorXd>& a, const std::vector<VectorXd>& b) {
  std::vector<VectorXd> result;
  for (std::size_t r = 0; r < a.size(); ++r) result.push_back(a[r] - b[r]);
  return result;
}

}  // namespace

Shrinks shrinks_on(const std::filesystem::path& dataset, const physics::Effects& told, const physics::Effects& hidden,
                   unsigned threads) {
  ComparedRuns runs(dataset, threads);
  std::vector<Variation> models(2, runs.predictor.unvaried());
  models[0].effects = told;
  models[1].effects = hidden;
  const NoiseFloor floor = floor_around(runs, models[1]);
  const std::vector<Shift> shifts = runs.predictor.shifts(models, Fidelity::every_run);
  const std::vector<VectorXd> left = difference(runs.residuals, shifts[1]);
  Shrinks result;
  result.before = floor.rms(runs.residuals);
  result.floor = rms_of_repeats(runs, floor, left);
  result.told = shrink(result.before, floor.rms(difference(runs.residuals, shifts[0])), result.floor);
  result.hidden = shrink(result.before, floor.rms(left), result.floor);
  return result;
}

}  // namespace kenaf::gap
