
#include <algorithm>
#include <cmath>
#include <numbers>

#include "bench/growth/curves.hpp"
#include "bench/thread_time.hpp"
#include "physics/world.hpp"

namespace kenaf::bench {

namespace {

using namespace physics;

constexpr int kRounds = 3;  // the fastest counts: other programs only slow one down
constexpr double kSettle_s = 0.5, kMeasured_s = 3;

// A robot is let down onto what is below.
Pose above(double x_m = 0, double y_m = 0) {
  Pose X_WB;
  X_WB.p = {x_m, y_m, 0.3};
  return X_WB;
}

robot::Command driving(double left_mps, double right_mps) {
  robot::Command command;
  command.track_speed_mps = {left_mps, right_mps};
  for (const robot::Flipper f : {robot::kFrontLeft, robot::kFrontRight, robot::kRearLeft, robot::kRearRight})
    command.flipper[f] = {robot::JointMode::angle, 1};
  return command;
}

struct StepCost {
  double step_us, contacts;
};

// Robots that do as commanded, from the same state in each round.
StepCost cost_of_steps(World& world, const robot::Command& command) {
  const double dt = world.settings().time_step_s;
  const auto settling = static_cast<long>(kSettle_s / dt), measured = static_cast<long>(kMeasured_s / dt);
  StepCost least{INFINITY, 0};
  for (int round = 0; round < kRounds; ++round) {
    // all robots are at their start, and settle
    world.reset();
    for (const RobotId id : world.robots()) world.set_command(id, command);
    for (long i = 0; i < settling; ++i) world.step();

    double contacts = 0;
    const double start_s = thread_time_s();
    for (long i = 0; i < measured; ++i) {
      world.step();
      contacts += static_cast<double>(world.contact_count());
    }
    const auto steps = static_cast<double>(measured);
    least = {std::min(least.step_us, 1e6 * (thread_time_s() - start_s) / steps), contacts / steps};
  }
  return least;
}

WorldDescription level_ground() {
  WorldDescription world;
  world.planes.emplace_back();
  return world;
}

// A square of ground with its middle at the origin, in squares of two triangles. Its slopes are below 3 %.
WorldDescription rough_ground(int squares_a_side, double square_m) {
  constexpr double kWave_m = 1.3, kHeight_m = 0.005;
  TriangleMesh mesh;
  mesh.name = "ground";
  const int corners = squares_a_side + 1;
  for (int j = 0; j < corners; ++j) {
    for (int i = 0; i < corners; ++i) {
      const double x = (i - squares_a_side / 2.0) * square_m, y = (j - squares_a_side / 2.0) * square_m;
      constexpr double k = 2 * std::numbers::pi / kWave_m;
      mesh.vertices_W.emplace_back(x, y, kHeight_m * std::sin(k * x) * std::sin(k * y));
    }
  }
  for (int j = 0; j < squares_a_side; ++j) {
    for (int i = 0; i < squares_a_side; ++i) {
      const auto a = static_cast<std::uint32_t>(j * corners + i), b = a + 1,
                 c = a + static_cast<std::uint32_t>(corners), d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  }
  WorldDescription world;
  world.meshes.push_back(std::move(mesh));
  return world;
}

Point on_rough_ground(int squares_a_side, double square_m) {
  World world(rough_ground(squares_a_side, square_m), {}, 1);
  world.add_robot(load_robot("kenaf"), "a", above());
  return {2.0 * squares_a_side * squares_a_side, cost_of_steps(world, driving(0.2, 0.2)).step_us};
}

}  // namespace

Growth over_contacts() {
  // Kenaf at rest on cross bars of a centimetre, more and more of them below its belts.
  Growth growth{"contacts of a robot at rest on bars", "µs a step", {}, 1};
  for (const int bars : {3, 6, 12, 24}) {
    WorldDescription description;
    constexpr double kReach_m = 0.44;  // a little less than the flat part of the main belts
    for (int i = 0; i < bars; ++i) {
      Box bar;
      bar.name = "bar";
      bar.size_m = {0.01, 1, 0.1};
      bar.X_WBox.p = {kReach_m * (i / (bars - 1.0) - 0.5), 0, -0.05};
      description.boxes.push_back(bar);
    }
    World world(description, {}, 1);
    world.add_robot(load_robot("kenaf"), "a", above());
    const StepCost cost = cost_of_steps(world, driving(0, 0));
    growth.points.push_back({cost.contacts, cost.step_us});
  }
  return growth;
}

Growth over_robots() {
  Growth growth{"robots that turn in place, apart", "µs a step", {}, 1};
  const RobotDescription robot = load_robot("kenaf");
  for (const int robots : {1, 2, 4, 8, 16, 32}) {
    World world(level_ground(), {}, 1);
    for (int i = 0; i < robots; ++i) {
      const int row = i / 8, column = i % 8;
      world.add_robot(robot, std::to_string(i), above(2.0 * column, 2.0 * row));
    }
    growth.points.push_back({static_cast<double>(robots), cost_of_steps(world, driving(-0.2, 0.2)).step_us});
  }
  return growth;
}

Growth over_triangles_of_larger_ground() {
  Growth growth{"triangles of a mesh, each the half of 0.1 m by 0.1 m", "µs a step", {}, 0};
  for (const int squares : {50, 100, 200, 400}) growth.points.push_back(on_rough_ground(squares, 0.1));
  return growth;
}

Growth over_triangles_of_finer_ground() {
  // The share of them that is below the belts stays the same.
  Growth growth{"triangles of a mesh of 10 m by 10 m", "µs a step", {}, 1};
  for (const int squares : {50, 100, 200, 400}) growth.points.push_back(on_rough_ground(squares, 10.0 / squares));
  return growth;
}

Growth over_rays() {
  Growth growth{"rays of a range scanner, on a mesh of 20,000 triangles", "µs a reading", {}, 1};
  for (const int rays : {91, 181, 361, 721}) {
    // a scanner that is read every 0.02 s
    RobotDescription robot = load_robot("kenaf");
    SensorDescription scanner{};
    scanner.type = SensorType::range_scanner;
    scanner.name = "Scanner";
    scanner.X_BS.p = {0.2, 0, 0.3};
    scanner.period_s = 0.02;
    scanner.max_range_m = 20;
    scanner.field_of_view_rad = std::numbers::pi;
    scanner.resolution_rad = std::numbers::pi / (rays - 1);
    robot.sensors = {scanner};
    World world(rough_ground(100, 0.1), {}, 1);
    const RobotId id = world.add_robot(robot, "a", above());

    // only the readings are timed
    double least_us = INFINITY;
    std::vector<SensorSample> samples;
    for (int round = 0; round < kRounds; ++round) {
      double taken_s = 0, readings = 0;
      for (int i = 0; i < 1000; ++i) {
        world.step();
        samples.clear();
        const double start_s = thread_time_s();
        world.read_sensors(id, samples);
        if (samples.empty()) continue;
        taken_s += thread_time_s() - start_s;
        ++readings;
      }
      least_us = std::min(least_us, 1e6 * taken_s / readings);
    }
    growth.points.push_back({static_cast<double>(rays), least_us});
  }
  return growth;
}

}  // namespace kenaf::bench
