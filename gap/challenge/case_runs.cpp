#include "gap/challenge/case_runs.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <span>

#include "formats/runs/dataset.hpp"
#include "gap/challenge/foreign.hpp"
#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/prediction.hpp"
#include "gap/parallel.hpp"
#include "gap/random_numbers.hpp"
#include "rollout/engines/body_in_engine.hpp"
#include "rollout/roll_out.hpp"

namespace kenaf::gap::challenge {
namespace {

namespace fs = std::filesystem;

// Adds coloured noise to the white noise of the pose, as pose estimates are filtered: a first-order autoregressive
// process w(k+1) = a w(k) + sqrt(1 - a^2) n(k), a = exp(-period / memory), of stationary variance 1, times sigma.
void add_coloured_noise(runs::Run& run, const CasePlan& plan, std::uint64_t seed) {
  if (plan.noise_memory_s == 0) return;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const std::span<const double> time = run.column("t_s");
  const double period_s = (time.back() - time.front()) / static_cast<double>(time.size() - 1);
  const double keep = std::exp(-period_s / plan.noise_memory_s);
  const rollout::RollOutOptions usual;
  for (const auto& [name, sigma] : {std::pair{"x_m", usual.mocap_noise_m}, std::pair{"y_m", usual.mocap_noise_m},
                                    std::pair{"z_m", usual.mocap_noise_m}, std::pair{"yaw_rad", usual.mocap_noise_rad}})
    for (std::size_t c = 0; c < run.columns.size(); ++c) {
      if (run.columns[c] != name) continue;
      double wander = normal(random);
      for (double& value : run.values[c]) {
        value += plan.noise_scale * sigma * wander;
        wander = keep * wander + std::sqrt(1 - keep * keep) * normal(random);
      }
    }
}

// Rounds to whole counts, as a sensor reports them.
void count(runs::Run& run, double count_scale) {
  if (count_scale == 0) return;
  for (const diagnose::Channel& channel : diagnose::diagnosis_channels())
    for (std::size_t c = 0; c < run.columns.size(); ++c) {
      if (run.columns[c] != channel.column) continue;
      const double step = count_scale * channel.resolution;
      for (double& value : run.values[c]) value = std::round(value / step) * step;
    }
}

void cut_off(runs::Run& run, double longest_s) {
  const std::span<const double> time = run.column("t_s");
  const auto rows = static_cast<std::size_t>(std::ranges::upper_bound(time, time.front() + longest_s) - time.begin());
  for (std::vector<double>& values : run.values) values.resize(rows);
}

runs::Run make_run(const CasePlan& plan, const physics::RobotDescription& robot, const std::string& name,
                   std::uint64_t seed) {
  rollout::Manoeuvre manoeuvre = rollout::load_manoeuvre(name);
  std::vector<std::string> unsupported;
  const physics::WorldDescription world = physics::load_world(manoeuvre.world, unsupported);
  rollout::RollOutOptions options;
  options.physics = plan.physics;
  options.seed = seed;
  options.noise_scale = plan.noise_scale;
  options.mocap_noise_m *= plan.noise_scale;
  options.mocap_noise_rad *= plan.noise_scale;
  rollout::scatter_starts(options, 1);

  // Another engine moves the body of an exact run; the noise is that of the run in Kenaf's own engine.
  rollout::RollOutOptions exact = options;
  exact.noise_scale = exact.mocap_noise_m = exact.mocap_noise_rad = 0;
  const auto driven_as = [&](const rollout::Manoeuvre& driven) {
    runs::Run run = rollout::roll_out(robot, world, driven, options).run;
    if (plan.engine.empty()) return run;
    return engines::with_body_of(plan.engine, robot, world, rollout::roll_out(robot, world, driven, exact).run, run);
  };

  // A deviation of the commands: the robot obeys the changed commands of a replay, and the log has those that were
  // sent.
  runs::Run run;
  if (is_of_commands(plan.foreign)) {
    const runs::Run asked = rollout::roll_out(robot, world, manoeuvre, exact).run;
    rollout::Manoeuvre replay = rollout::replay_of(asked, name);
    obey_foreign(replay, plan.foreign, plan.foreign_amount);
    run = driven_as(replay);
    for (std::size_t c = 0; c < run.columns.size(); ++c)
      if (run.columns[c].starts_with("cmd_"))
        for (std::size_t i = 0; i < run.row_count(); ++i)
          run.values[c][i] = asked.column(run.columns[c])[std::min(i, asked.row_count() - 1)];
  } else {
    run = driven_as(manoeuvre);
  }

  // Deviations of the sensors, then noise and resolution.
  record_foreign(run, plan.foreign, plan.foreign_amount);
  add_coloured_noise(run, plan, mixed(seed, 1));
  count(run, plan.count_scale);
  return run;
}

}  // namespace

physics::RobotDescription hidden_robot(const CasePlan& plan) {
  Background numbers = plan.background;
  if (!plan.number.key.empty()) numbers.numbers.push_back({plan.number.key, plan.number.value});
  physics::RobotDescription robot = with_background(physics::load_robot(kChallengedRobot), numbers);
  for (const HiddenEffect& hidden : plan.effects) robot.effects.*parameter_of(hidden).value = hidden.value;
  return robot;
}

physics::RobotDescription robot_before(const CasePlan& plan) {
  return with_background(physics::load_robot(kChallengedRobot), plan.background);
}

physics::RobotDescription hidden_robot_in_model(const CasePlan& plan, const std::vector<std::string>& without) {
  physics::RobotDescription robot = physics::load_robot(kChallengedRobot);
  for (const HiddenEffect& hidden : plan.effects)
    if (std::ranges::count(without, hidden.effect) == 0)
      robot.effects.*parameter_of(hidden).value = value_in_model(plan, hidden);
  return robot;
}

void write_case_runs(const CasePlan& plan, const physics::RobotDescription& robot, const RunsToWrite& runs,
                     const fs::path& folder, unsigned jobs, const std::atomic<bool>* stop) {
  fs::create_directories(folder);
  runs::Dataset dataset{
      .source = "real", .robot = kChallengedRobot, .world = "flat", .description = plan.name, .noise = {}, .runs = {}};
  const auto repeats = static_cast<std::size_t>(runs.repeats);
  for (std::size_t i = 0; i < runs.manoeuvres.size() * repeats; ++i) {
    const rollout::Manoeuvre manoeuvre = rollout::load_manoeuvre(runs.manoeuvres[i / repeats]);
    dataset.runs.push_back({runs::numbered_run_file(i), manoeuvre.name, manoeuvre.world});
  }
  for_each_job(dataset.runs.size(), jobs, [&](std::size_t i) {
    diagnose::check_goes_on(stop);
    runs::Run run = make_run(plan, robot, dataset.runs[i].manoeuvre, mixed(runs.seed, i + 2));
    if (!runs.longest_s.empty()) cut_off(run, runs.longest_s[i / repeats]);
    runs::write_run(folder / dataset.runs[i].file, run);
  });
  runs::write_dataset(folder, dataset);
}

}  // namespace kenaf::gap::challenge
