#include "bench/engines/accuracy.hpp"

#include <cmath>
#include <numbers>

namespace kenaf::bench {
namespace {

using namespace physics;
using engines::on_plane;

constexpr double kGravity = 9.80665;

void run(Runner& runner, double time_s, double time_step_s) {
  const long steps = std::lround(time_s / time_step_s);
  for (long i = 0; i < steps; ++i) runner.step();
}

double fall_error_m(const Engine& engine) {
  EngineScene scene;
  scene.block = Box{"block", {0.1, 0.1, 0.1}, {}, 1, 1};
  const auto runner = engine.build(scene);
  run(*runner, 1, scene.time_step_s);
  return -runner->pose().p.z() - kGravity / 2;
}

// Relative error of a block's slide of 1 s down 30 degrees, mu = 0.3: g (sin a - mu cos a) t^2 / 2.
double slide_error(const Engine& engine) {
  constexpr double kSlope = std::numbers::pi / 6, kMu = 0.3;
  EngineScene scene;
  const Pose X_WP{Eigen::Vector3d::Zero(), rotation_from({0, kSlope, 0})};
  scene.world.planes.push_back({X_WP, kMu});
  scene.block = Box{"block", {0.2, 0.2, 0.1}, compose(X_WP, {{0, 0, 0.05}, Eigen::Quaterniond::Identity()}), 1, 2};
  const auto runner = engine.build(scene);
  run(*runner, 1, scene.time_step_s);
  const double way_m = (X_WP.q.inverse() * runner->pose().p).x();
  return way_m / (kGravity * (std::sin(kSlope) - kMu * std::cos(kSlope)) / 2) - 1;
}

// Displacement in 10 s of the robot with stopped belts on 20 degrees, far below its friction angle: should be 0.
double creep_m(const Engine& engine, const RobotDescription& robot) {
  const EngineScene scene = on_plane(robot, std::numbers::pi / 9);
  const auto runner = engine.build(scene);
  run(*runner, 1, scene.time_step_s);
  const Eigen::Vector3d start = runner->pose().p;
  run(*runner, 10, scene.time_step_s);
  return (runner->pose().p - start).norm();
}

double speed_error(const Engine& engine, const RobotDescription& robot) {
  constexpr double kSpeed_mps = 0.2, kTime_s = 5;
  EngineScene scene = on_plane(robot, 0);
  scene.command.track_speed_mps = {kSpeed_mps, kSpeed_mps};
  const auto runner = engine.build(scene);
  run(*runner, 2, scene.time_step_s);
  const double start_m = runner->pose().p.x();
  run(*runner, kTime_s, scene.time_step_s);
  return (runner->pose().p.x() - start_m) / (kSpeed_mps * kTime_s) - 1;
}

double sink_m(const Engine& engine, const RobotDescription& robot) {
  const EngineScene scene = on_plane(robot, 0);
  const auto runner = engine.build(scene);
  run(*runner, 2, scene.time_step_s);
  return robot.ride_height_m() - runner->pose().p.z();
}

// Yaw rate w of two belts that run against each other, each with its load spread evenly over its straight run and
// isotropic Coulomb friction: the w at which friction's moment about the middle vanishes, for any coefficient.
// The slip at (x, y) is (u - w y, w x), so w solves: integral of (y (u - w y) - x (w x)) / |slip| = 0. By bisection.
double turn_rate_radps(const TrackDescription& track, double speed_mps) {
  constexpr int kCells = 60;
  const double half_m = track.length_m / 2 - track.end_radius_m;
  const auto moment = [&](double w) {
    double sum = 0;
    for (int i = 0; i < kCells; ++i)
      for (int k = 0; k < kCells; ++k) {
        const double x = half_m * (2 * (i + 0.5) / kCells - 1);
        const double y = track.p_BT_m.y() + track.width_m * ((k + 0.5) / kCells - 0.5);
        const double along = speed_mps - w * y, across = w * x;
        sum += (y * along - x * across) / std::hypot(along, across);
      }
    return sum;
  };
  double low = 0, high = speed_mps / (track.p_BT_m.y() - track.width_m / 2);
  for (int i = 0; i < 50; ++i) (moment((low + high) / 2) > 0 ? low : high) = (low + high) / 2;
  return low;
}

double turn_error(const Engine& engine, RobotDescription robot) {
  constexpr double kSpeed_mps = 0.2, kTime_s = 3;
  robot.track.front().friction_across = robot.track.front().friction_along;
  EngineScene scene = on_plane(robot, 0);
  scene.command.track_speed_mps = {-kSpeed_mps, kSpeed_mps};
  const auto runner = engine.build(scene);
  run(*runner, 1, scene.time_step_s);
  double turned = 0, yaw = roll_pitch_yaw(runner->pose().q).z();
  for (int tenth = 0; tenth < kTime_s * 10; ++tenth) {
    run(*runner, 0.1, scene.time_step_s);
    const double now = roll_pitch_yaw(runner->pose().q).z();
    turned += std::remainder(now - yaw, 2 * std::numbers::pi);
    yaw = now;
  }
  return turned / kTime_s / turn_rate_radps(robot.track.front(), kSpeed_mps) - 1;
}

}  // namespace

const std::vector<AccuracyFigure>& accuracy_figures() {
  static const std::vector<AccuracyFigure> figures{
      {"fall_error_mm", "way of a fall of 1 s against g t^2/2", "{:.3f}", 0},
      {"slide_error_percent", "way of a block in 1 s down 30 degrees, friction 0.3", "{:.3f}", 1},
      {"creep_mm", "robot with stopped belts on 20 degrees, in 10 s", "{:.3f}", 0.1},
      {"speed_error_percent", "way of the robot at 0.2 m/s on level ground", "{:.3f}", 0.1},
      {"sink_mm", "robot at rest on level ground", "{:.3f}", 0.1},
      {"turn_error_percent", "turn in place against the uniform-pressure solution", "{:.1f}", 10}};
  return figures;
}

std::vector<double> measure_accuracy(const Engine& engine) {
  const RobotDescription robot = load_robot("kenaf");
  return {1000 * fall_error_m(engine),      100 * slide_error(engine),    1000 * creep_m(engine, robot),
          100 * speed_error(engine, robot), 1000 * sink_m(engine, robot), 100 * turn_error(engine, robot)};
}

}  // namespace kenaf::bench
