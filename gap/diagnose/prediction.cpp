#include "gap/diagnose/prediction.hpp"

#include "gap/parallel.hpp"
#include "rollout/roll_out.hpp"

namespace kenaf::gap {

Predictor::Predictor(const Observations& observations, const std::vector<FeatureMap>& features, unsigned threads)
    : observations_(observations), features_(features), threads_(threads) {}

runs::Run Predictor::simulate(std::size_t run, const Variation& variation) const {
  const Observation& observed = observations_.runs[run];
  physics::RobotDescription robot = observations_.robot;
  robot.effects = variation.effects;
  rollout::Manoeuvre replay = observed.replay;
  replay.start->x_m += variation.start_x_m;
  replay.start->y_m += variation.start_y_m;
  replay.start->yaw_rad += variation.start_yaw_rad;
  rollout::RollOutOptions options;
  options.physics = variation.physics;
  options.noise_scale = 0;
  options.mocap_noise_m = options.mocap_noise_rad = 0;
  return rollout::roll_out(robot, observations_.worlds[observed.world], replay, options).run;
}

std::vector<std::vector<Eigen::VectorXd>> Predictor::predict(const std::vector<Variation>& variations) {
  const std::size_t runs = observations_.runs.size();
  std::vector<std::vector<Eigen::VectorXd>> result(variations.size(), std::vector<Eigen::VectorXd>(runs));
  for_each_job(variations.size() * runs, threads_, [&](std::size_t job) {
    const std::size_t variation = job / runs, run = job % runs;
    result[variation][run] = features_[run].of(simulate(run, variations[variation]));
  });
  roll_outs_ += variations.size() * runs;
  return result;
}

}  // namespace kenaf::gap
