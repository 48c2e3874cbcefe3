#include "gap/challenge/true_shares.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "gap/challenge/case_runs.hpp"
#include "gap/challenge/compared_runs.hpp"
#include "gap/diagnose/gap_size.hpp"
#include "gap/diagnose/repeats.hpp"
#include "gap/diagnose/stage_decision.hpp"

namespace kenaf::gap {
namespace {

Shift difference(Shift a, const Shift& b) {
  for (std::size_t r = 0; r < a.size(); ++r) a[r] -= b[r];
  return a;
}

class StageGap {
 public:
  StageGap(ComparedRuns& runs, Passage passage, const physics::RobotDescription& truth)
      : runs_(runs), passage_(passage), features_(runs.features.of(passage)) {
    for (std::size_t r = 0; r < features_.size(); ++r)
      residuals_.push_back(features_[r].measured - runs.predictor.nominal(passage)[r]);
    if (!is_measured()) return;
    Variation model = runs_.predictor.unvaried();
    model.robot = truth;
    floor_ = noise_floor(features_, residuals_, runs_.same_orders,
                         open_shapes(features_, runs_.predictor, passage_, model, kOpenStart_m, kOpenStart_rad));
    left_by_truth_ = difference(residuals_, shift(truth));
    const KindSquares before = squares(residuals_);
    const KindSquares repeats = squares(deviations_from_repeats(features_, left_by_truth_, runs_.same_orders));
    weights_ = kind_weights(before, repeats);
    before_ = weighted_rms(before, weights_);
    const double of_repeats = weighted_rms(repeats, weights_);
    gap_floor_ = std::min(of_repeats > 0 ? of_repeats : 1.0, before_);
  }

  bool is_measured() const {
    return std::ranges::any_of(features_, [](const StageFeatures& run) { return !run.bins.empty(); });
  }
  double explained_by_truth() const { return explained(left_by_truth_); }
  double explained_by(const physics::RobotDescription& robot) {
    return explained(difference(residuals_, shift(robot)));
  }
  // Whether anybody could see what these two do differently.
  bool shows(const physics::RobotDescription& a, const physics::RobotDescription& b) {
    return floor_.rms(difference(shift(a), shift(b))) >= DecisionSettings().negligible;
  }

 private:
  Shift shift(const physics::RobotDescription& robot) {
    Variation variation = runs_.predictor.unvaried();
    variation.robot = robot;
    return runs_.predictor.shifts({&variation, 1}, passage_, Fidelity::every_run).front();
  }
  KindSquares squares(const Shift& differences) const { return squares_by_kind(features_, floor_, differences); }
  double explained(const Shift& left) const {
    return explained_share(before_, weighted_rms(squares(left), weights_), gap_floor_);
  }

  ComparedRuns& runs_;
  Passage passage_;
  const std::vector<StageFeatures>& features_;
  Shift residuals_, left_by_truth_;
  NoiseFloor floor_;
  std::vector<double> weights_;
  double before_ = 0, gap_floor_ = 0;
};

}  // namespace

void set_true_shares(CasePlan& plan, const std::filesystem::path& dataset, unsigned jobs,
                     const std::atomic<bool>* stop) {
  if (plan.effects.empty()) return;
  ComparedRuns runs(dataset, jobs, stop);
  const physics::RobotDescription truth = hidden_robot_in_model(plan);
  for (HiddenEffect& hidden : plan.effects) hidden.shares.clear();
  for (const Passage passage : kPassages) {
    StageGap gap(runs, passage, truth);
    if (!gap.is_measured()) continue;
    for (HiddenEffect& hidden : plan.effects) {
      const physics::RobotDescription others = hidden_robot_in_model(plan, {hidden.effect});
      if (!gap.shows(truth, others)) continue;
      const double of_others = plan.effects.size() > 1 ? gap.explained_by(others) : 0;
      hidden.shares.push_back({std::string(passage_name(passage)), gap.explained_by_truth() - of_others});
    }
  }
}

}  // namespace kenaf::gap
