#include "rollout/engines/body_in_engine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>
#include <stdexcept>

#include "physics/body_effects.hpp"
#include "physics/terrain_effects.hpp"
#include "robot/parts.hpp"
#include "rollout/engines/runner.hpp"
#include "rollout/measured_motion.hpp"

namespace kenaf::engines {
namespace {

using namespace physics;

constexpr double kSettle_s = 0.5;  // before the first row: engines rest at different depths

// Engines in settings with contacts all along a track that give the same bits each time.
struct NamedEngine {
  std::string name;
  Engine engine;
};
std::vector<NamedEngine> engines_there() {
  std::vector<NamedEngine> engines;
#ifdef KENAF_WITH_ENGINES
  engines.push_back({"mujoco", mujoco_engines().front()});
  engines.push_back({"ode", repeatable_ode_engine()});
#endif
  return engines;
}

Engine engine_named(std::string_view name) {
  std::string known;
  for (NamedEngine& there : engines_there()) {
    if (there.name == name) return std::move(there.engine);
    known += (known.empty() ? "" : ", ") + there.name;
  }
  throw std::invalid_argument(fmt::format("no engine \"{}\"; this program was built with {}", name,
                                          known.empty() ? "none: libmujoco-dev and libode-dev were not there" : known));
}

// Bodies and belts with their effects, for engines that know none.
RobotDescription with_effects(RobotDescription robot) {
  robot.body = with_body_effects(robot.body, robot.effects);
  for (TrackDescription& track : robot.track) track.friction_along *= robot.effects.friction_along_scale;
  for (FlipperDescription& flipper : robot.flipper) flipper.friction_along *= robot.effects.friction_along_scale;
  return robot;
}

std::span<const double> measured(const runs::Run& run, std::string_view column) {
  const std::span<const double> values = run.column(column);
  if (!runs::any_measured(values))
    throw std::invalid_argument(fmt::format("{}: is missing in the run, so no other engine can move its body", column));
  return values;
}

std::vector<DriveSample> drives_of(const runs::Run& run, const RobotDescription& robot) {
  for (const std::string_view belt : {"track_left_mps", "track_right_mps"}) measured(run, belt);
  for (std::size_t i = 0; i < robot::kFlipperCount; ++i)
    if (robot.has(static_cast<robot::Flipper>(i)))
      measured(run, fmt::format("flipper_{}_rad", robot::kFlipperNames[i]));

  // True motion of belts and flippers, row by row; while the robot settles, belts stand, flippers at their first
  // angles.
  const rollout::MeasuredMotion reported = rollout::measured_motion(run);
  const rollout::ReportDelays late = rollout::report_delays(robot);
  const std::span<const double> t_s = run.column("t_s");
  std::vector<DriveSample> samples;
  for (const double row_s : t_s) {
    const double since_s = row_s - t_s.front();
    const PrescribedMotion motion = rollout::actual_motion(reported, since_s, robot, late);
    DriveSample sample{kSettle_s + since_s};
    for (std::size_t i = 0; i < robot::kTrackCount; ++i) sample.belt_mps[i] = motion.track_mps[i].value();
    for (std::size_t i = 0; i < robot::kFlipperCount; ++i)
      if (robot.has(static_cast<robot::Flipper>(i))) sample.flipper_rad[i] = motion.flipper_rad[i].value();
    if (samples.empty()) samples.push_back({0, {}, sample.flipper_rad});
    samples.push_back(sample);
  }
  return samples;
}

// `q_LW`: the run's roll and pitch are against gravity (physics::leveling()), the engine's pose is in W.
Pose start_of(const runs::Run& run, const Eigen::Quaterniond& q_LW) {
  const auto first = [&](std::string_view column) {
    const std::span<const double> values = measured(run, column);
    return *std::ranges::find_if(values, [](double value) { return !std::isnan(value); });
  };
  return {{first("x_m"), first("y_m"), first("z_m")},
          q_LW.conjugate() * rotation_from({first("roll_rad"), first("pitch_rad"), first("yaw_rad")})};
}

// Columns that measure the body; Motion has them in this order.
constexpr std::array kColumns{"x_m",     "y_m",          "z_m",          "roll_rad",    "pitch_rad",
                              "yaw_rad", "gyro_x_radps", "gyro_y_radps", "gyro_z_radps"};
constexpr std::size_t kYaw = 5;
using Motion = std::array<double, kColumns.size()>;

// Rates are central differences, from the row before to the row after, so that they are not late.
Motion motion_of(const Pose& before, const Pose& now, const Pose& after, double span_s,
                 const Eigen::Quaterniond& q_LW) {
  const Eigen::Vector3d angles = roll_pitch_yaw(q_LW * now.q);
  const double yaw_rad = roll_pitch_yaw(now.q).z();
  const Eigen::AngleAxisd turned(before.q.conjugate() * after.q);
  const double angle = std::remainder(turned.angle(), 2 * std::numbers::pi);
  const Eigen::Vector3d rates =
      span_s > 0 ? Eigen::Vector3d(turned.axis() * (angle / span_s)) : Eigen::Vector3d::Zero();
  return {now.p.x(), now.p.y(), now.p.z(), angles.x(), angles.y(), yaw_rad, rates.x(), rates.y(), rates.z()};
}

// Settles, then runs the engine from row to row.
std::vector<Motion> motions_in(const Engine& engine, const EngineScene& scene, std::span<const double> t_s) {
  const std::unique_ptr<Runner> runner = engine.build(scene);
  std::vector<Pose> poses;
  long steps = 0;
  for (const double row_s : t_s) {
    const long until = std::lround((kSettle_s + row_s - t_s.front()) / scene.time_step_s);
    for (; steps < until; ++steps) runner->step();
    poses.push_back(runner->pose());
  }
  const Eigen::Quaterniond q_LW = leveling(scene.world.gravity_W_mps2);
  std::vector<Motion> motions;
  for (std::size_t row = 0; row < poses.size(); ++row) {
    const std::size_t before = row > 0 ? row - 1 : 0, after = std::min(row + 1, poses.size() - 1);
    motions.push_back(motion_of(poses[before], poses[row], poses[after], t_s[after] - t_s[before], q_LW));
  }
  return motions;
}

}  // namespace

std::vector<std::string> engine_names() {
  std::vector<std::string> names;
  for (const NamedEngine& there : engines_there()) names.push_back(there.name);
  return names;
}

bool shows_in_engine(const EffectInfo& effect) {
  // No column shows what lies between servo and arm; MuJoCo refuses moments of inertia that no rigid body has.
  constexpr std::string_view kNot[] = {"flipper_backlash", "flipper_compliance", "roll_inertia",  "pitch_inertia",
                                       "yaw_inertia",      "ground_compliance",  "ground_damping"};
  switch (effect.stage) {
    case Stage::command:
    case Stage::drive:
    case Stage::body:
    case Stage::terrain:
      return std::ranges::count(kNot, effect.name) == 0;
    case Stage::contact:
      return effect.name == "friction_along";
    case Stage::sensor:
      return false;
  }
  return false;
}

runs::Run with_body_of(std::string_view engine, const RobotDescription& robot, const WorldDescription& world,
                       const runs::Run& exact, const runs::Run& noisy) {
  // The engine drives the exact run's belts and flippers.
  EngineScene scene;
  scene.world = with_terrain_effects(world, robot.effects);
  scene.robot = with_effects(robot);
  scene.X_start = start_of(exact, physics::leveling(scene.world.gravity_W_mps2));
  scene.prescribed = drives_of(exact, robot);
  const std::vector<Motion> motions = motions_in(engine_named(engine), scene, exact.column("t_s"));

  // Columns of the body: the engine's value plus the noise of Kenaf's run, noisy - exact; for yaw that difference is
  // wrapped. Accelerations are dropped, all other columns copied.
  runs::Run run;
  for (std::size_t c = 0; c < noisy.columns.size(); ++c) {
    if (noisy.columns[c].starts_with("acc_")) continue;
    run.columns.push_back(noisy.columns[c]);
    run.values.push_back(noisy.values[c]);
    const auto moved = std::ranges::find(kColumns, noisy.columns[c]);
    if (moved == kColumns.end()) continue;
    const auto which = static_cast<std::size_t>(moved - kColumns.begin());
    const std::span<const double> without_noise = exact.column(noisy.columns[c]);
    for (std::size_t row = 0; row < run.values.back().size(); ++row) {
      double noise = noisy.values[c][row] - without_noise[std::min(row, without_noise.size() - 1)];
      if (which == kYaw) noise = std::remainder(noise, 2 * std::numbers::pi);
      run.values.back()[row] = motions[std::min(row, motions.size() - 1)][which] + noise;
    }
  }
  return run;
}

}  // namespace kenaf::engines
