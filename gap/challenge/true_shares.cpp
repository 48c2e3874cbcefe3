#include "gap/challenge/true_shares.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "gap/challenge/case_runs.hpp"
#include "gap/challenge/compared_runs.hpp"
#include "gap/diagnose/gap_size.hpp"
#include "gap/diagnose/repeats.hpp"
#include "gap/diagnose/stage_decision.hpp"

namespace kenaf::gap::challenge {
namespace {

diagnose::Shift difference(diagnose::Shift a, const diagnose::Shift& b) {
  for (std::size_t r = 0; r < a.size(); ++r) a[r] -= b[r];
  return a;
}

class StageGap {
 public:
  StageGap(ComparedRuns& runs, diagnose::Passage passage, const physics::RobotDescription& truth)
      : runs_(runs), passage_(passage), features_(runs.features.of(passage)) {
    for (std::size_t r = 0; r < features_.size(); ++r)
      residuals_.push_back(features_[r].measured - runs.predictor.nominal(passage)[r]);
    // The floor, the gap before, and what remains of it with the true model, weighted by kind of channel.
    if (!is_measured()) return;
    diagnose::Variation model = runs_.predictor.unvaried();
    model.robot = truth;
    floor_ = diagnose::noise_floor(features_, residuals_, runs_.same_command_sequence,
                                   diagnose::open_shapes(features_, runs_.predictor, passage_, model,
                                                         diagnose::kOpenStart_m, diagnose::kOpenStart_rad));
    left_by_truth_ = difference(residuals_, shift(truth));
    const diagnose::KindSquares before = squares(residuals_);
    const diagnose::KindSquares floor = diagnose::squares_of_floor(
        features_, floor_, diagnose::deviations_from_repeats(features_, left_by_truth_, runs_.same_command_sequence));
    weights_ = diagnose::kind_weights(before, floor);
    before_ = diagnose::weighted_rms(before, weights_);
    gap_floor_ = std::min(diagnose::weighted_rms(floor, weights_), before_);
  }

  bool is_measured() const {
    return std::ranges::any_of(features_, [](const diagnose::StageFeatures& run) { return !run.bins.empty(); });
  }
  double explained_by_truth() const { return explained(left_by_truth_); }
  double explained_by(const physics::RobotDescription& robot) {
    return explained(difference(residuals_, shift(robot)));
  }
  // Whether the difference of these two robots is visible in the stage.
  bool shows(const physics::RobotDescription& a, const physics::RobotDescription& b) {
    return floor_.rms(difference(shift(a), shift(b))) >= diagnose::DecisionSettings().negligible;
  }

 private:
  diagnose::Shift shift(const physics::RobotDescription& robot) {
    diagnose::Variation variation = runs_.predictor.unvaried();
    variation.robot = robot;
    return runs_.predictor.shifts({&variation, 1}, passage_, diagnose::Fidelity::every_run).front();
  }
  diagnose::KindSquares squares(const diagnose::Shift& differences) const {
    return diagnose::squares_by_kind(features_, floor_, differences);
  }
  double explained(const diagnose::Shift& left) const {
    return diagnose::explained_share(before_, diagnose::weighted_rms(squares(left), weights_), gap_floor_);
  }

  ComparedRuns& runs_;
  diagnose::Passage passage_;
  const std::vector<diagnose::StageFeatures>& features_;
  diagnose::Shift residuals_, left_by_truth_;
  diagnose::NoiseFloor floor_;
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
  // share = explained by all effects - explained by the others
  for (const diagnose::Passage passage : diagnose::kPassages) {
    StageGap gap(runs, passage, truth);
    if (!gap.is_measured()) continue;
    for (HiddenEffect& hidden : plan.effects) {
      const physics::RobotDescription others = hidden_robot_in_model(plan, {hidden.effect});
      if (!gap.shows(truth, others)) continue;
      const double of_others = plan.effects.size() > 1 ? gap.explained_by(others) : 0;
      hidden.shares.push_back({std::string(diagnose::passage_name(passage)), gap.explained_by_truth() - of_others});
    }
  }
}

}  // namespace kenaf::gap::challenge
