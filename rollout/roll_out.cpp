#include "rollout/roll_out.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "physics/terrain_effects.hpp"
#include "robot/angles.hpp"
#include "rollout/driver.hpp"
#include "rollout/first_report.hpp"
#include "rollout/run_recorder.hpp"

namespace kenaf::rollout {
namespace {

using physics::Pose;
using physics::RobotDescription;
using physics::RobotId;
using physics::World;
using FlipperAngles = std::array<double, robot::kFlipperCount>;

constexpr double kSettle_s = 0.5;  // a robot that is put down stands still after this time
constexpr double kFold_s = 5;      // flippers with a fast servo reach any angle from any other in this time
constexpr double kStill_radps = 0.005;
constexpr double kAlike_rad = 1e-3;     // an encoder of 12 bits resolves 1.5e-3
constexpr double kLagsUntilStill = 10;  // time constants of a lag after which nothing of it is left
constexpr double kMisplaced_m = 1e-5, kMisplaced_rad = 1e-5;
constexpr double kInTheAir_m = 0.01;  // a recorded start higher than this above the settled robot is a drop

std::uint64_t steps_per_sample(const RollOutOptions& options) {
  const double ratio = options.sample_period_s / options.physics.time_step_s;
  if (!(ratio >= 0.5 && ratio < 1e6) || std::abs(ratio - std::round(ratio)) > 1e-6)
    throw std::invalid_argument(fmt::format("the sample period of {} s is not a multiple of time_step_s = {}",
                                            options.sample_period_s, options.physics.time_step_s));
  return static_cast<std::uint64_t>(std::llround(ratio));
}

FlipperAngles flippers_at_start(const Manoeuvre& manoeuvre, const RobotDescription& robot) {
  FlipperAngles angles{};
  if (!robot.has_flippers()) return angles;
  angles.fill(robot.flipper.front().start_angle_rad);
  if (!manoeuvre.start)
    return manoeuvre.phases.empty() ? angles : manoeuvre.phases.front().flipper_rad.value_or(angles);
  for (std::size_t i = 0; i < angles.size(); ++i)
    if (robot.has(static_cast<robot::Flipper>(i))) angles[i] = manoeuvre.start->flipper_rad[i].value_or(angles[i]);
  return angles;
}

Pose start_pose(const RobotDescription& robot, const physics::WorldDescription& world, const Manoeuvre& manoeuvre,
                const RollOutOptions& options) {
  Pose X_WB = world.start_poses.front().X_WB;
  if (manoeuvre.start) {
    const Start& start = *manoeuvre.start;
    X_WB = {{start.x_m, start.y_m, start.z_m.value_or(X_WB.p.z())}, physics::rotation_from({0, 0, start.yaw_rad})};
    if (!starts_elsewhere(robot.effects, world, manoeuvre)) return X_WB;
    return physics::compose(X_WB, physics::inverse(at_first_report(robot, world, manoeuvre, options)));
  }
  physics::NoiseSource noise(options.seed, "world", "start pose");
  const double x = noise.normal(options.start_scatter_m), y = noise.normal(options.start_scatter_m);
  const double yaw = noise.normal(options.start_scatter_rad);
  return physics::compose(X_WB, {{x, y, 0}, physics::rotation_from({0, 0, yaw})});
}

// One robot in a world, with its prescribed motion and the number of contacts.
struct Scene {
  World world;
  std::uint64_t per_sample;
  RobotId robot{};
  physics::PrescribedMotion held{};  // while it is put down
  std::uint64_t contacts = 0;

  void step() {
    world.step();
    contacts += world.contact_count();
  }
  // Sends the command at every sample, as in a run: a single one might be lost.
  void hold(const robot::Command& command, double time_s) {
    for (const double end_s = world.time_s() + time_s; world.time_s() < end_s;) {
      world.set_command(robot, command);
      world.prescribe(robot, held);  // a teleport ends it
      for (std::uint64_t i = 0; i < per_sample; ++i) step();
    }
  }
  bool flippers_move() const {
    return std::ranges::any_of(world.truth(robot).flipper_radps,
                               [](double speed_radps) { return std::abs(speed_radps) > kStill_radps; });
  }
};

// Returns the pose from which a robot settles at X_WB, given that from X_WB it settled at X_WB_settled: first order,
// the miss is added to the aim.
Pose aimed_off(const Pose& X_WB, const Pose& X_WB_settled) {
  const auto yaw = [](const Pose& X) { return physics::roll_pitch_yaw(X.q).z(); };
  const Eigen::Vector3d miss = X_WB.p - X_WB_settled.p;
  return {X_WB.p + Eigen::Vector3d(miss.x(), miss.y(), 0),
          physics::rotation_from({0, 0, yaw(X_WB) + robot::wrap_angle(yaw(X_WB) - yaw(X_WB_settled))})};
}

bool apart(const Pose& X_WB, const Pose& other) {
  return (other.p - X_WB.p).norm() > kMisplaced_m || other.q.angularDistance(X_WB.q) > kMisplaced_rad;
}

// In which its flippers reach any angle from any other.
double longest_fold_s(const RobotDescription& robot) {
  return kFold_s + robot.effects.command_delay_s + 2 * std::numbers::pi / robot.servo.max_speed_radps +
         kLagsUntilStill * robot.effects.flipper_lag_s;
}

// The angle of all flippers that the robot has; empty if they differ by more than a servo corrects while the robot
// settles, or if it has none.
std::optional<double> common_angle(const RobotDescription& robot, const FlipperAngles& flippers) {
  std::optional<double> common;
  for (std::size_t i = 0; i < flippers.size(); ++i) {
    if (!robot.has(static_cast<robot::Flipper>(i))) continue;
    if (common && std::abs(*common - flippers[i]) > kAlike_rad) return std::nullopt;
    if (!common) common = flippers[i];
  }
  return common;
}

// The robots that report one drive; all move as the first does.
using Robots = std::span<const RobotDescription>;

// Puts the robot down with its flippers at their angles, and returns the pose in which it has settled.
Pose put_down(Scene& scene, Robots robots, const Manoeuvre& manoeuvre, const FlipperAngles& flippers,
              const Pose& X_WB) {
  RobotDescription robot = robots.front();
  // Flippers that are all alike can start at their angle.
  const std::optional<double> common_rad = common_angle(robot, flippers);
  if (common_rad)
    robot.flipper.front().start_angle_rad =
        std::clamp(*common_rad, robot.flipper.front().min_angle_rad, robot.flipper.front().max_angle_rad);

  // Placed with belts held still and measured flippers held at their first angles.
  scene.robot = scene.world.add_robot(robot, "robot", X_WB);
  for (const RobotDescription& other : robots.subspan(1)) scene.world.add_instruments(scene.robot, other);
  if (manoeuvre.measured) {
    scene.held = actual_motion(*manoeuvre.measured, 0, robot, report_delays(robot));
    for (std::optional<double>& speed : scene.held.track_mps)
      if (speed) speed = 0;
  }

  // Flippers at different angles have to be driven there first; then the robot is put down again.
  robot::Command rest;
  for (std::size_t i = 0; i < flippers.size(); ++i) rest.flipper[i] = {robot::JointMode::angle, flippers[i]};
  if (robot.has_flippers() && !common_rad) {
    const double by_s = longest_fold_s(robot);
    scene.hold(rest, robot.effects.command_delay_s);  // nothing moves before
    do scene.hold(rest, kSettle_s);
    while (scene.flippers_move() && scene.world.time_s() < by_s);
    scene.world.teleport(scene.robot, X_WB);
  }
  scene.hold(rest, kSettle_s);
  return scene.world.truth(scene.robot).X_WB;
}

// Puts the robot at rest at the start pose, and resets its sensors.
void put_at_start(Scene& scene, Robots robots, const Manoeuvre& manoeuvre, const FlipperAngles& flippers,
                  const Pose& X_WB) {
  Pose X_WB_settled = put_down(scene, robots, manoeuvre, flippers, X_WB);
  // A recorded start is where the robot stood at rest. A robot that comes down on its flippers moves by millimetres; it
  // is then put down again, not moved, since the way it is put down decides which forces friction holds.
  const Pose X_WB_aim = manoeuvre.start ? aimed_off(X_WB, X_WB_settled) : X_WB;
  if (apart(X_WB, X_WB_aim)) {
    scene.world.remove_robot(scene.robot);
    scene.world.reset();
    scene.contacts = 0;
    X_WB_settled = put_down(scene, robots, manoeuvre, flippers, X_WB_aim);
  }

  // A start in the air: by the manoeuvre, or by a recorded height.
  double lift_m = manoeuvre.start_lift_m;
  if (manoeuvre.start && manoeuvre.start->z_m && *manoeuvre.start->z_m > X_WB_settled.p.z() + kInTheAir_m)
    lift_m = *manoeuvre.start->z_m - X_WB_settled.p.z();
  if (lift_m > 0) scene.world.teleport(scene.robot, {X_WB_settled.p + Eigen::Vector3d(0, 0, lift_m), X_WB_settled.q});
  for (std::size_t r = 0; r < robots.size(); ++r)
    for (std::size_t i = 0; i < robots[r].sensors.size(); ++i) scene.world.reset_sensor(scene.robot, i, {}, r);
}

// Sets the settled robot in motion as at the start of the run: on its known tracks, or on those without slip.
void set_in_motion(Scene& scene, const RobotDescription& robot, const StartMotion& motion,
                   const robot::Command& command) {
  const auto [forward_mps, yaw_radps] = body_motion(robot, motion);
  const double half_gauge_m = robot.track_gauge_m() / 2;
  physics::RobotMotion start;
  start.track_mps = motion.track_mps
                        ? without_encoder_errors(robot, *motion.track_mps)
                        : std::array{forward_mps - yaw_radps * half_gauge_m, forward_mps + yaw_radps * half_gauge_m};
  const Eigen::Quaterniond& q_WB = scene.world.truth(scene.robot).X_WB.q;
  start.v_WB_mps = q_WB * Eigen::Vector3d(forward_mps, 0, 0);
  start.w_WB_radps = q_WB * Eigen::Vector3d(0, 0, yaw_radps);
  scene.world.set_in_motion(scene.robot, start, command);
}

}  // namespace

std::vector<RollOut> roll_outs(std::span<const RobotDescription> robots, const physics::WorldDescription& world,
                               const Manoeuvre& manoeuvre, const RollOutOptions& options) {
  if (robots.empty()) throw std::invalid_argument("no robot to roll out");
  if (manoeuvre.phases.empty() && manoeuvre.timed.empty())
    throw std::invalid_argument(fmt::format("manoeuvre {}: has neither phases nor commands", manoeuvre.name));
  const std::uint64_t per_sample = steps_per_sample(options);
  std::vector<RobotDescription> measured;
  for (const RobotDescription& robot : robots) measured.push_back(instrumented(robot, options.noise_scale));
  const RobotDescription& robot = measured.front();
  const ReportDelays late = report_delays(robot);
  const FlipperAngles flippers = flippers_at_start(manoeuvre, robot);
  Scene scene{World(physics::with_terrain_effects(world, robot.effects), options.physics, options.seed), per_sample};
  put_at_start(scene, measured, manoeuvre, flippers, start_pose(robots.front(), world, manoeuvre, options));

  // Operator, recorders, and a recorded run's motion at its start.
  RollOut out;
  std::vector<RunRecorder> recorders;
  double pose_after_s = 0;
  for (const RobotDescription& one : measured) {
    recorders.emplace_back(one, options, manoeuvre.start);
    pose_after_s = std::max(pose_after_s, -late_s(one.effects));
  }
  Driver driver(manoeuvre, flippers);
  robot::Command command;
  if (manoeuvre.start && manoeuvre.start->motion)
    set_in_motion(scene, robot, *manoeuvre.start->motion,
                  manoeuvre.timed.empty() ? command : manoeuvre.timed.front().command);

  const auto time_of = [&](std::uint64_t step) { return static_cast<double>(step) * options.physics.time_step_s; };
  const auto row_time = [](double t_s) { return std::round(t_s * 1e9) / 1e9; };  // nine decimals: 0.29, not 29 * 0.01
  const auto advance = [&](double t_s) {
    if (manoeuvre.measured)
      scene.world.prescribe(scene.robot,
                            actual_motion(*manoeuvre.measured, t_s + options.physics.time_step_s, robot, late));
    scene.step();
  };

  // At each sample, and when a replay's command is due: the next command, and a row; then a step.
  std::vector<physics::SensorSample> samples;
  std::uint64_t step = 0;
  for (;; ++step) {
    const double t_s = time_of(step);
    const bool sample = step % per_sample == 0;
    if (sample || t_s >= driver.next_due_s()) {
      out.end = scene.world.truth(scene.robot);
      const auto next = driver.command(t_s, out.end.X_WB);
      if (next) command = *next;
      while (out.phase_began_s.size() < std::min(driver.phase() + 1, manoeuvre.phases.size()))
        out.phase_began_s.push_back(t_s);
      for (std::size_t r = 0; sample && r < recorders.size(); ++r) {
        samples.clear();
        scene.world.read_sensors(scene.robot, samples, r);
        recorders[r].add(row_time(t_s), command, out.end, samples);
      }
      out.fault = scene.world.fault(scene.robot);
      if (!next || !out.fault.empty()) break;
      scene.world.set_command(scene.robot, command);
    }
    advance(t_s);
  }
  out.succeeded = out.fault.empty() && succeeded(manoeuvre, out.end.X_WB);
  out.gave_up = driver.gave_up();
  out.steps = scene.world.step_count();
  out.contacts_per_step = static_cast<double>(scene.contacts) / static_cast<double>(out.steps);

  // A pose whose clock is ahead shows where the robot goes then, as it was told and measured last.
  const double until_s = pose_after_s > 0 ? time_of(step) + pose_after_s + options.sample_period_s : 0;
  while (time_of(step) < until_s && scene.world.fault(scene.robot).empty()) {
    advance(time_of(step++));
    if (step % per_sample != 0) continue;
    const physics::RobotTruth later = scene.world.truth(scene.robot);
    for (RunRecorder& recorder : recorders) recorder.add_pose(row_time(time_of(step)), later);
  }

  std::vector<RollOut> outs(robots.size(), out);
  for (std::size_t r = 0; r < outs.size(); ++r) outs[r].run = recorders[r].take();
  return outs;
}

RollOut roll_out(const RobotDescription& robot, const physics::WorldDescription& world, const Manoeuvre& manoeuvre,
                 const RollOutOptions& options) {
  return std::move(roll_outs({&robot, 1}, world, manoeuvre, options).front());
}

}  // namespace kenaf::rollout
