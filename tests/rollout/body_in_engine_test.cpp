// A run whose body another engine moves. Without the engines' libraries there is nothing to test but that it says so.
#include "rollout/engines/body_in_engine.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "rollout/roll_out.hpp"

using namespace kenaf;
using Catch::Contains;

namespace {

struct Driven {
  runs::Run exact, noisy, in_engine, without_noise;
  double last(const runs::Run& run, const char* column) const { return run.column(column).back(); }
};

Driven driven(const std::string& engine, const std::string& manoeuvre_name, const physics::RobotDescription& robot) {
  const rollout::Manoeuvre manoeuvre = rollout::load_manoeuvre(manoeuvre_name);
  std::vector<std::string> unsupported;
  const physics::WorldDescription world = physics::load_world(manoeuvre.world, unsupported);
  rollout::RollOutOptions options;
  Driven result;
  result.noisy = rollout::roll_out(robot, world, manoeuvre, options).run;
  options.noise_scale = options.mocap_noise_m = options.mocap_noise_rad = 0;
  result.exact = rollout::roll_out(robot, world, manoeuvre, options).run;
  result.in_engine = engines::with_body_of(engine, robot, world, result.exact, result.noisy);
  result.without_noise = engines::with_body_of(engine, robot, world, result.exact, result.exact);
  return result;
}

}  // namespace

TEST_CASE("Without engines, or with a name that none has, there is an error that says which there are") {
  const physics::RobotDescription robot = physics::load_robot("kenaf");
  const rollout::Manoeuvre manoeuvre = rollout::load_manoeuvre("straight");
  std::vector<std::string> unsupported;
  const physics::WorldDescription world = physics::load_world("flat", unsupported);
  const runs::Run run = rollout::roll_out(robot, world, manoeuvre, {}).run;
  CHECK_THROWS_WITH(engines::with_body_of("havok", robot, world, run, run), Contains("no engine \"havok\""));
}

TEST_CASE("What is of belts, drives and commands stays, and the body goes where another engine takes it") {
  for (const std::string& engine : engines::engine_names()) {
    CAPTURE(engine);
    const Driven run = driven(engine, "straight", physics::load_robot("kenaf"));
    for (const char* column : {"t_s", "cmd_track_left_mps", "track_left_mps", "track_right_m", "battery_v"})
      CHECK(std::ranges::equal(run.in_engine.column(column), run.noisy.column(column),
                               [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }));
    CHECK(run.in_engine.column("acc_x_mps2").empty());
    // rigid belts that hold on level ground carry the body as far as they run
    const double way_m = run.last(run.exact, "track_left_m");
    CHECK(run.last(run.in_engine, "x_m") - run.in_engine.column("x_m").front() == Approx(way_m).epsilon(0.02));
    CHECK(run.last(run.in_engine, "y_m") == Approx(run.last(run.exact, "y_m")).margin(0.03));
    CHECK(run.last(run.in_engine, "z_m") == Approx(run.last(run.exact, "z_m")).margin(0.01));
    // another engine is another one, and its noise is the run's own
    CHECK(run.last(run.in_engine, "x_m") != run.last(run.noisy, "x_m"));
  }
}

TEST_CASE("The body goes with its belts, not with the late reports of them") {
  const physics::RobotDescription robot = physics::load_robot("kenaf");
  physics::RobotDescription late = robot;
  for (physics::SensorDescription& sensor : late.sensors)
    if (sensor.type == physics::SensorType::tachometer || sensor.type == physics::SensorType::encoder)
      sensor.delay_s = 0.1;
  for (const std::string& engine : engines::engine_names()) {
    CAPTURE(engine);
    const Driven at_once = driven(engine, "straight", robot), later = driven(engine, "straight", late);
    const auto x_m = at_once.without_noise.column("x_m"), x_late_m = later.without_noise.column("x_m");
    const std::size_t midway = x_m.size() / 2;
    const double speed_mps = later.exact.column("track_left_mps")[midway];
    REQUIRE(speed_mps > 0.1);
    // by the reports the body would be 0.1 s of its way behind
    CHECK(x_late_m[midway] == Approx(x_m[midway]).margin(0.1 * 0.1 * speed_mps));
  }
}

TEST_CASE("Another engine climbs nose up, which is a negative pitch, and turns about y as the pitch says") {
  for (const std::string& engine : engines::engine_names()) {
    CAPTURE(engine);
    const Driven run = driven(engine, "step-100", physics::load_robot("kenaf"));
    const auto pitch = run.in_engine.column("pitch_rad"), rate = run.in_engine.column("gyro_y_radps");
    const auto exact = run.exact.column("pitch_rad");
    const auto steepest = [](std::span<const double> of) {
      double least = 0;
      for (const double angle : of)
        if (angle < least) least = angle;
      return least;
    };
    CHECK(steepest(pitch) == Approx(steepest(exact)).margin(0.1));
    // the rate's integral is what the pitch changes by
    double turned = 0;
    const auto t_s = run.in_engine.column("t_s");
    const double from = pitch.front();
    for (std::size_t row = 1; row < t_s.size(); ++row)
      if (!std::isnan(rate[row])) turned += rate[row] * (t_s[row] - t_s[row - 1]);
    CHECK(turned == Approx(pitch.back() - from).margin(0.05));
  }
}

TEST_CASE("Effects on the body are in the engine, too") {
  for (const std::string& engine : engines::engine_names()) {
    CAPTURE(engine);
    physics::RobotDescription robot = physics::load_robot("kenaf");
    robot.effects.com_left_m = 0.05;
    const Driven run = driven(engine, "straight", robot);
    // the left belt sinks in more: a roll to the left, which is negative
    CHECK(run.last(run.without_noise, "roll_rad") < 0);
    // the noise is the same on both
    CHECK(run.last(run.in_engine, "roll_rad") - run.last(run.without_noise, "roll_rad") ==
          Approx(run.last(run.noisy, "roll_rad") - run.last(run.exact, "roll_rad")).margin(1e-12));
  }
}

TEST_CASE("Effects of sensors and of what engines lack do not show in them") {
  const auto shows = [](const char* name) { return engines::shows_in_engine(*physics::find_effect(name)); };
  CHECK(shows("command_delay"));
  CHECK(shows("drive_lag"));
  CHECK(shows("mass"));
  CHECK(shows("ground_slope"));
  CHECK(shows("friction_along"));
  CHECK_FALSE(shows("friction_across"));
  CHECK_FALSE(shows("flipper_backlash"));
  CHECK_FALSE(shows("gyro_bias"));
  CHECK_FALSE(shows("yaw_inertia"));
}

TEST_CASE("Flippers are where the run says, whatever they carry") {
  for (const std::string& engine : engines::engine_names()) {
    CAPTURE(engine);
    const Driven run = driven(engine, "flipper-sweep", physics::load_robot("kenaf"));
    // a servo of 5 N m s and 30/s, as without this, gives way by 0.07 rad under a quarter of 20 kg at 0.2 m
    for (const auto& [column, within] : {std::pair{"pitch_rad", 0.01}, std::pair{"z_m", 0.002}}) {
      const auto in_engine = run.without_noise.column(column), exact = run.exact.column(column);
      double off = 0;
      for (std::size_t row = 0; row < exact.size(); ++row) off = std::max(off, std::abs(in_engine[row] - exact[row]));
      CHECK(off < within);
    }
    // they tilt it by more than that
    CHECK(std::ranges::any_of(run.exact.column("pitch_rad"), [](double p) { return std::abs(p) > 0.05; }));
  }
}

// Without ground the body falls from the start, so that from rows 0.2 s apart z0 - 2 z1 + z2 = g (0.2 s)^2.
TEST_CASE("A body falls in every engine along the world's gravity") {
  const physics::RobotDescription robot = physics::load_robot("kenaf");
  const rollout::Manoeuvre manoeuvre = rollout::load_manoeuvre("drop");
  std::vector<std::string> unsupported;
  physics::WorldDescription world = physics::load_world(manoeuvre.world, unsupported);
  rollout::RollOutOptions exact;
  exact.noise_scale = exact.mocap_noise_m = exact.mocap_noise_rad = 0;
  const runs::Run run = rollout::roll_out(robot, world, manoeuvre, exact).run;
  world.planes.clear();
  world.gravity_W_mps2 = {0.3, 0, -1.62};
  for (const std::string& engine : engines::engine_names()) {
    CAPTURE(engine);
    const runs::Run falling = engines::with_body_of(engine, robot, world, run, run);
    const auto x_m = falling.column("x_m"), z_m = falling.column("z_m");
    REQUIRE(falling.column("t_s")[20] - falling.column("t_s")[0] == Approx(0.2));
    CHECK(x_m[0] - 2 * x_m[20] + x_m[40] == Approx(0.3 * 0.04).epsilon(0.01));
    CHECK(z_m[0] - 2 * z_m[20] + z_m[40] == Approx(-1.62 * 0.04).epsilon(0.01));
  }
}

TEST_CASE("Ground has the friction of each of its pieces, or is refused where an engine has one for all") {
  const physics::RobotDescription robot = physics::load_robot("kenaf");
  const rollout::Manoeuvre manoeuvre = rollout::load_manoeuvre("straight");
  std::vector<std::string> unsupported;
  physics::WorldDescription world = physics::load_world(manoeuvre.world, unsupported);
  const runs::Run run = rollout::roll_out(robot, world, manoeuvre, {}).run;
  // far from where the robot drives
  world.boxes.push_back(
      {"ice", {1, 1, 1}, {{100, 100, 0.5}, Eigen::Quaterniond::Identity()}, world.planes.at(0).friction, 0});
  physics::WorldDescription mixed = world;
  mixed.boxes.back().friction = 0.01;
  for (const std::string& engine : engines::engine_names()) {
    CAPTURE(engine);
    const runs::Run alike = engines::with_body_of(engine, robot, world, run, run);
    if (engine == "mujoco") {
      CHECK_THROWS_WITH(engines::with_body_of(engine, robot, mixed, run, run), Contains("one friction"));
    } else {
      CHECK(engines::with_body_of(engine, robot, mixed, run, run).column("x_m").back() == alike.column("x_m").back());
    }
  }
}
