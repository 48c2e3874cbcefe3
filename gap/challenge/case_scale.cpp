#include "gap/challenge/case_scale.hpp"

#include <filesystem>
#include <utility>

#include "gap/challenge/case_runs.hpp"
#include "gap/challenge/foreign.hpp"
#include "gap/challenge/look_alike.hpp"
#include "gap/challenge/stand_ins.hpp"
#include "gap/parallel.hpp"
#include "gap/random_numbers.hpp"
#include "rollout/roll_out.hpp"

namespace kenaf::gap::challenge {
namespace {

const std::filesystem::path& written(const std::filesystem::path& folder, CasePlan plan, unsigned jobs,
                                     const std::atomic<bool>* stop) {
  plan.foreign.clear();
  write_case_runs(plan, physics::load_robot(kChallengedRobot),
                  {plan.manoeuvres, plan.longest_s, plan.repeats, mixed(plan.seed, 0)}, folder, jobs, stop);
  return folder;
}

CasePlan in_own_engine(CasePlan plan) {
  plan.engine.clear();
  return plan;
}

}  // namespace

CaseScale::CaseScale(const CasePlan& plan, unsigned jobs, const std::atomic<bool>* stop)
    : jobs_(jobs),
      stop_(stop),
      robot_(with_background(physics::load_robot(kChallengedRobot), plan.background)),
      runs_(written(folder_.path, in_own_engine(plan), jobs, stop), jobs, stop) {
  floors_ = floors_around(runs_, runs_.predictor.unvaried());
  floor_rms_ = rms_of_repeats(runs_, floors_, runs_.residuals);
  background_ = shifts_of(runs_, robot_, diagnose::Fidelity::coarse);
  background_floors_ = rms(floors_, background_) / floor_rms_;
  if (plan.engine.empty()) return;
  // The same runs with the same noise in the other engine: their difference is background, too.
  TemporaryFolder folder;
  const ComparedRuns in_engine(written(folder.path, plan, jobs, stop), jobs, stop);
  background_floors_ = rms(floors_, background_ - (runs_.residuals - in_engine.residuals)) / floor_rms_;
}

Size CaseScale::size_of(const Differences& shifts) const {
  const double floors = rms(floors_, shifts) / floor_rms_;
  return {floors, background_floors_ > 0 ? floors / background_floors_ : 0};
}

Size CaseScale::size_of(const physics::Effects& effects) {
  return size_of(shift_of(effects));
}

Size CaseScale::size_beside(const physics::Effects& others, const physics::Effects& effects) {
  return size_of(shift_of(effects) - shift_of(others));
}

Size CaseScale::size_of_number(const std::string& key, double value) {
  return size_of(shift_of(with_background(robot_, {{{key, value}}, 0})));
}

Size CaseScale::size_of_foreign(const std::string& foreign, double amount) {
  return size_of(shift_of_foreign(foreign, amount));
}

LookAlike CaseScale::look_alike_of(const CasePlan& plan) {
  return look_alike(
      runs_, floors_,
      plan.foreign.empty() ? shift_of(hidden_robot(plan)) : shift_of_foreign(plan.foreign, plan.foreign_amount),
      withheld_names(plan));
}

Differences CaseScale::shift_of(const physics::RobotDescription& robot) {
  return shifts_of(runs_, robot, diagnose::Fidelity::coarse) - background_;
}

Differences CaseScale::shift_of(const physics::Effects& effects) {
  physics::RobotDescription robot = robot_;
  robot.effects = effects;
  return shift_of(robot);
}

// The shift in each stage's own replay. In a replay of measured belts and flippers commands play no part.
Differences CaseScale::shift_of_foreign(const std::string& foreign, double amount) {
  const diagnose::Observations& observed = runs_.observations;
  Differences shifts;
  for (std::size_t s = 0; s < shifts.size(); ++s) {
    const diagnose::Passage passage = kEachChannelOnce[s];
    shifts[s].resize(observed.runs.size());
    for_each_job(shifts[s].size(), jobs_, [&](std::size_t r) {
      diagnose::check_goes_on(stop_);
      const diagnose::StageFeatures& features = runs_.features.of(passage)[r];
      if (features.bins.empty()) return;

      // The stage's values with the deviation less those without, both without noise.
      const diagnose::Observation& run = observed.runs[r];
      const auto values = [&](double of_it) {
        const bool by_commands = passage == diagnose::Passage::command_to_drive || !run.measured;
        rollout::Manoeuvre replay = by_commands ? run.replay : *run.measured;
        if (by_commands) obey_foreign(replay, foreign, of_it);
        rollout::RollOutOptions options;
        options.noise_scale = options.mocap_noise_m = options.mocap_noise_rad = 0;
        runs::Run simulated = rollout::roll_out(robot_, observed.worlds[run.world], replay, options).run;
        record_foreign(simulated, foreign, of_it);
        const diagnose::FeatureMap& map = runs_.features.maps[r];
        return diagnose::stage_values(passage, features, map, map.of(simulated), simulated);
      };
      shifts[s][r] = values(amount) - values(0);
    });
  }
  return shifts;
}

}  // namespace kenaf::gap::challenge
