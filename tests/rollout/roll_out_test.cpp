// A robot driven through a manoeuvre: what mechanics says it does, and what is recorded of it.
#include "rollout/roll_out.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <thread>

#include "physics/effects.hpp"
#include "rollout/moves_alike.hpp"
#include "tests/rollout/exact_runs.hpp"

using namespace kenaf;
using namespace kenaf::rollout;
using Catch::Contains;
using test::exact;
using test::flat;

namespace {

Manoeuvre straight(double speed_mps, double time_s) {
  Manoeuvre manoeuvre;
  manoeuvre.name = "straight";
  manoeuvre.phases = {
      {.name = "", .track_mps = {speed_mps, speed_mps}, .flipper_rad = {}, .at_most_s = time_s, .end = {}}};
  manoeuvre.success = Success{.x_above_m = speed_mps * time_s / 2};
  return manoeuvre;
}

// Cells that were not measured are equal too.
bool same_bits(const runs::Run& a, const runs::Run& b) {
  const auto same = [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
  return a.columns == b.columns && std::ranges::equal(a.values, b.values, [&](const auto& x, const auto& y) {
           return std::ranges::equal(x, y, same);
         });
}

}  // namespace

// A first-order lag of T = 0.05 s costs v T of the way: x = v (t - T) once t >> T.
TEST_CASE("Straight ahead: the way of a speed loop with a lag, in every column that measures it") {
  const auto robot = physics::load_robot("kenaf");
  const RollOut out = roll_out(robot, flat(), straight(0.2, 1), exact());
  REQUIRE(out.run.row_count() == 101);
  CHECK(out.run.column("t_s")[29] == 0.29);
  CHECK(out.run.column("t_s").back() == 1);
  const double way_m = 0.2 * (1 - robot.drive.time_constant_s);
  const double moved_m = out.run.column("x_m").back() - out.run.column("x_m").front();
  CHECK(moved_m == Approx(way_m).epsilon(0.01));
  CHECK(out.run.column("track_left_m").back() == Approx(way_m).epsilon(0.01));
  CHECK(out.run.column("track_left_m").front() == 0);
  CHECK(out.run.column("track_right_mps").back() == Approx(0.2).epsilon(0.001));
  CHECK(out.run.column("cmd_track_right_mps").front() == 0.2);
  CHECK(out.run.column("acc_z_mps2").back() == Approx(9.80665).epsilon(0.01));
  CHECK(out.run.column("y_m").back() == Approx(0).margin(1e-4));
  CHECK(out.run.column("battery_v").back() < robot.battery.open_circuit_v);
  CHECK(out.run.column("track_left_a").back() >= robot.drive.idle_amperes);
  CHECK(out.succeeded);
  CHECK(out.fault.empty());
  CHECK(out.steps == 1500);  // half a second of them to settle
  CHECK(out.contacts_per_step > 4);
  CHECK(out.end.X_WB.p.x() == out.run.column("x_m").back());
}

TEST_CASE("The robot stands still before the first row") {
  const auto robot = physics::load_robot("kenaf");
  Manoeuvre stand = straight(0, 0.2);
  stand.phases[0].flipper_rad = GENERATE(std::array{0.0, 0.0, 0.0, 0.0}, std::array{1.2, 1.2, 0.2, 0.2});
  const RollOut out = roll_out(robot, flat(), stand, exact());
  for (const char* column : {"x_m", "z_m", "pitch_rad", "flipper_fl_rad", "flipper_rl_rad"}) {
    INFO(column);
    CHECK(out.run.column(column).back() == Approx(out.run.column(column).front()).margin(1e-4));
  }
  CHECK(out.run.column("flipper_fl_rad").front() == Approx((*stand.phases[0].flipper_rad)[0]).margin(0.01));
  CHECK(out.run.column("flipper_rl_rad").front() == Approx((*stand.phases[0].flipper_rad)[2]).margin(0.01));
}

// g t^2 / 2 = 50 mm after 0.101 s; the semi-implicit step falls by g h t / 2 more, 0.5 mm.
TEST_CASE("A drop falls freely, then lies on the ground") {
  const auto robot = physics::load_robot("kenaf");
  const RollOut out = roll_out(robot, flat(), load_manoeuvre("drop"), exact());
  const auto z = out.run.column("z_m");
  CHECK(z[0] - z[8] == Approx(9.80665 * 0.08 * 0.08 / 2).margin(6e-4));
  CHECK(z.front() - z.back() == Approx(0.05).margin(0.002));
  CHECK(out.succeeded);
}

// 1.62 (0.2 s)^2 / 2 = 32.4 mm; the step adds g h t / 2 = 0.2 mm.
TEST_CASE("On the Moon a drop takes 2.5 times as long") {
  physics::WorldDescription moon = flat();
  moon.gravity_W_mps2 = {0, 0, -1.62};
  const auto out = roll_out(physics::load_robot("kenaf"), moon, load_manoeuvre("drop"), exact());
  const auto z = out.run.column("z_m");
  CHECK(z[0] - z[20] == Approx(1.62 * 0.2 * 0.2 / 2).margin(3e-4));
  CHECK(out.succeeded);
}

TEST_CASE("An operator who gives up stops the robot where it is") {
  Manoeuvre manoeuvre = straight(0.2, 2);
  const Phase drive = manoeuvre.phases[0];
  manoeuvre.phases = {drive, drive, drive};
  const bool gives_up = GENERATE(true, false);
  manoeuvre.phases[1].give_up = GiveUp{.x_below_m = gives_up ? 1.0 : 0.1};  // 0.4 m are driven by then
  manoeuvre.phases[2].track_mps = {0, 0};
  const RollOut out = roll_out(physics::load_robot("kenaf"), flat(), manoeuvre, exact());
  CHECK(out.gave_up == gives_up);
  CHECK(out.phase_began_s == (gives_up ? std::vector<double>{0, 2, 2} : std::vector<double>{0, 2, 4}));
  CHECK(out.end.X_WB.p.x() == Approx(gives_up ? 0.4 : 0.8).margin(0.02));  // the drive's lag, before and after
}

TEST_CASE("Phases end where the robot is, and say when they began") {
  const auto robot = physics::load_robot("kenaf");
  Manoeuvre manoeuvre = straight(0.4, 5);
  manoeuvre.phases[0].end.x_above_m = 0.2;
  manoeuvre.phases.push_back(manoeuvre.phases[0]);
  manoeuvre.phases[1].track_mps = {-0.4, -0.4};
  manoeuvre.phases[1].end = {.x_below_m = 0.1};
  const RollOut out = roll_out(robot, flat(), manoeuvre, exact());
  REQUIRE(out.phase_began_s.size() == 2);
  CHECK(out.phase_began_s[0] == 0);
  CHECK(out.phase_began_s[1] == Approx(0.2 / 0.4 + 0.05).margin(0.03));
  CHECK(out.end.X_WB.p.x() == Approx(0.1).margin(0.01));
  CHECK_FALSE(out.succeeded);  // back again
}

TEST_CASE(
    "Without noise the seed changes no bit, with noise it does, the same seed gives the same bits on any thread") {
  const auto robot = physics::load_robot("kenaf");
  const Manoeuvre manoeuvre = straight(0.2, 0.3);
  RollOutOptions one = exact(), two = exact();
  two.seed = 2;
  CHECK(same_bits(roll_out(robot, flat(), manoeuvre, one).run, roll_out(robot, flat(), manoeuvre, two).run));
  one.noise_scale = two.noise_scale = 1;
  const runs::Run first = roll_out(robot, flat(), manoeuvre, one).run;
  CHECK_FALSE(same_bits(first, roll_out(robot, flat(), manoeuvre, two).run));
  std::array<runs::Run, 2> runs;
  {
    std::vector<std::jthread> threads;
    for (runs::Run& run : runs) threads.emplace_back([&] { run = roll_out(robot, flat(), manoeuvre, one).run; });
  }
  CHECK(same_bits(first, runs[0]));
  CHECK(same_bits(first, runs[1]));
}

TEST_CASE("Noise has the sigma that is stated for its column") {
  const auto robot = physics::load_robot("kenaf");
  RollOutOptions options;
  options.noise_scale = 2;
  const auto noise = column_noise(robot, options);
  CHECK(noise.at("x_m") == 2 * options.mocap_noise_m);
  const runs::Run run = roll_out(robot, flat(), straight(0, 3), options).run;
  for (const auto& [column, sigma] : noise) {
    if (column.starts_with("track_") && column.ends_with("_m")) continue;  // stands on one count
    INFO(column);
    const auto values = run.column(column);
    double mean = 0, squares = 0;
    for (const double value : values) mean += value / static_cast<double>(values.size());
    for (const double value : values) squares += (value - mean) * (value - mean);
    // 301 samples know their sigma to 4 %; four times that
    CHECK(std::sqrt(squares / static_cast<double>(values.size() - 1)) == Approx(sigma).epsilon(0.16));
  }
}

TEST_CASE("Starts scatter with the sigma asked for, and not in a replay") {
  auto robot = physics::load_robot("kenaf");
  RollOutOptions options = exact();
  options.start_scatter_m = 0.005;
  double squares = 0;
  for (options.seed = 1; options.seed <= 8; ++options.seed) {
    const double x = roll_out(robot, flat(), straight(0, 0.01), options).run.column("x_m").front();
    squares += x * x / 8;
  }
  CHECK(std::sqrt(squares) > 0.002);  // a chi square of 8 is not below 1.3 in 99.6 % of cases
  CHECK(std::sqrt(squares) < 0.009);
  Manoeuvre replay = straight(0, 0.01);
  replay.start = Start{.x_m = 0.5, .y_m = 0, .yaw_rad = 0, .z_m = {}, .flipper_rad = {}};
  CHECK(roll_out(robot, flat(), replay, options).run.column("x_m").front() == Approx(0.5).margin(1e-4));
}

TEST_CASE("A robot without sensors or flippers leaves their columns out, a slow sensor leaves cells empty") {
  auto robot = physics::load_robot("kenaf");
  robot.flipper.clear();
  std::erase_if(robot.sensors, [](const auto& sensor) { return sensor.type != physics::SensorType::ins; });
  robot.sensors.front().period_s = 0.05;
  const runs::Run run = roll_out(robot, flat(), straight(0.2, 0.2), {}).run;
  CHECK(run.columns == std::vector<std::string>{"t_s", "cmd_track_left_mps", "cmd_track_right_mps", "x_m", "y_m", "z_m",
                                                "roll_rad", "pitch_rad", "yaw_rad"});
  const auto pitch = run.column("pitch_rad");
  for (std::size_t i = 0; i < pitch.size(); ++i) CHECK(std::isnan(pitch[i]) == (i % 5 != 0));
}

// 100 m of fall take sqrt(2 * 100 / g) = 4.516 s, half a second of it before the first row.
TEST_CASE("A robot that leaves the world ends its run there, and is no success") {
  physics::WorldDescription nothing = flat();
  nothing.planes.clear();
  Manoeuvre fall = straight(0, 10);
  fall.success = Success{.z_below_m = 0};
  const RollOut out = roll_out(physics::load_robot("kenaf"), nothing, fall, {});
  CHECK_THAT(out.fault, Contains("left the world"));
  CHECK(out.run.column("t_s").back() == Approx(4.02).margin(0.011));
  CHECK_FALSE(out.succeeded);
}

TEST_CASE("A time step that does not divide the sample period is refused in words") {
  RollOutOptions options;
  options.physics.time_step_s = 0.003;
  CHECK_THROWS_WITH(roll_out(physics::load_robot("kenaf"), flat(), straight(0.2, 1), options),
                    Contains("0.01") && Contains("time_step_s = 0.003"));
  options.physics.time_step_s = 0.002;
  CHECK(roll_out(physics::load_robot("kenaf"), flat(), straight(0.2, 0.1), options).run.row_count() == 11);
}

TEST_CASE("A robot with one pair of flippers is recorded with empty cells where it has none") {
  physics::RobotDescription robot = physics::load_robot("kenaf");
  robot.flipper_pairs = {.front = true, .rear = false};
  const RollOut out = roll_out(robot, flat(), straight(0.2, 1), exact());
  CHECK(out.succeeded);
  CHECK(out.run.column("flipper_fr_rad").back() == Approx(robot.flipper.front().start_angle_rad).margin(0.01));
  CHECK(std::ranges::all_of(out.run.column("flipper_rl_rad"), [](double cell) { return std::isnan(cell); }));
  CHECK(std::ranges::all_of(out.run.column("flipper_rr_a"), [](double cell) { return std::isnan(cell); }));
}

namespace {

// The robot once without effects, and once with each effect on sensors, far from neutral.
std::vector<physics::RobotDescription> with_each_sensor_effect(const physics::RobotDescription& robot) {
  std::vector<physics::RobotDescription> robots{robot};
  for (const physics::EffectInfo& effect : physics::effect_catalogue())
    if (effect.stage == physics::Stage::sensor)
      for (const physics::EffectParameter& parameter : effect.parameters) {
        robots.push_back(robot);
        robots.back().effects.*parameter.value = parameter.neutral + 0.3 * (parameter.max - parameter.neutral);
      }
  return robots;
}

// Those that move on flat ground as the first one does.
std::vector<physics::RobotDescription> moving_alike(std::vector<physics::RobotDescription> robots,
                                                    const Manoeuvre& manoeuvre) {
  const physics::RobotDescription moves = as_it_moves(robots.front(), flat(), manoeuvre);
  std::erase_if(robots, [&](const auto& robot) { return !(as_it_moves(robot, flat(), manoeuvre) == moves); });
  return robots;
}

}  // namespace

TEST_CASE("Robots that move alike are simulated once, with the bits of a simulation of each") {
  const auto kenaf = physics::load_robot("kenaf");
  const std::vector<physics::RobotDescription> robots = with_each_sensor_effect(kenaf);
  std::size_t next = 0;
  for (const Manoeuvre& manoeuvre : shipped_manoeuvres()) {
    INFO(manoeuvre.name);
    std::vector<std::string> unsupported;
    const physics::WorldDescription world = physics::load_world(manoeuvre.world, unsupported);
    RollOutOptions options;  // with noise, which does not depend on who else reports
    options.physics.time_step_s = 0.002;
    const std::vector<RollOut> together = roll_outs(robots, world, manoeuvre, options);
    REQUIRE(together.size() == robots.size());
    // one of them alone, another one in each manoeuvre
    const RollOut alone = roll_out(robots[next], world, manoeuvre, options);
    CHECK(same_bits(alone.run, together[next].run));
    CHECK(alone.steps == together[next].steps);
    next = (next + 1) % robots.size();
  }
  CHECK(shipped_manoeuvres().size() >= robots.size());
}

TEST_CASE("A replay of belts takes encoders' errors out of the motion: robots with other encoders do not move alike") {
  const auto kenaf = physics::load_robot("kenaf");
  const std::vector<physics::RobotDescription> robots = with_each_sensor_effect(kenaf);
  const runs::Run run = roll_out(kenaf, flat(), straight(0.2, 1), exact()).run;
  const Manoeuvre commands = replay_of(run, "run"), belts = replay_measured_of(run, "run");
  CHECK(moving_alike(robots, commands).size() == robots.size());
  const std::vector<physics::RobotDescription> alike = moving_alike(robots, belts);
  CHECK(alike.size() == robots.size() - 2);  // encoder_scale, encoder_asymmetry
  physics::RobotDescription late = kenaf;
  for (physics::SensorDescription& sensor : late.sensors)
    if (sensor.type == physics::SensorType::tachometer) sensor.delay_s += 0.05;
  CHECK(as_it_moves(late, flat(), commands) == as_it_moves(kenaf, flat(), commands));
  CHECK_FALSE(as_it_moves(late, flat(), belts) == as_it_moves(kenaf, flat(), belts));

  const std::vector<RollOut> together = roll_outs(alike, flat(), belts, exact());
  for (std::size_t r = 0; r < alike.size(); ++r)
    CHECK(same_bits(roll_out(alike[r], flat(), belts, exact()).run, together[r].run));
  CHECK_THROWS_WITH(roll_outs({}, flat(), belts, exact()), Contains("no robot"));
}

TEST_CASE("Effects on obstacles change no motion where there are none, and count where there are") {
  const auto kenaf = physics::load_robot("kenaf");
  physics::RobotDescription higher = kenaf;
  higher.effects.obstacle_height_m = 0.02;
  const Manoeuvre ahead = straight(0.2, 1), climb = load_manoeuvre("step-100");
  CHECK(as_it_moves(higher, flat(), ahead) == as_it_moves(kenaf, flat(), ahead));
  CHECK(same_bits(roll_out(higher, flat(), ahead, exact()).run, roll_out(kenaf, flat(), ahead, exact()).run));
  std::vector<std::string> unsupported;
  const physics::WorldDescription step = physics::load_world(climb.world, unsupported);
  CHECK_FALSE(as_it_moves(higher, step, climb) == as_it_moves(kenaf, step, climb));
}

TEST_CASE("A run begins when its flippers have arrived, however slow their servos are") {
  Manoeuvre manoeuvre = straight(0, 0.5);
  manoeuvre.phases.front().flipper_rad = {{0.6, 0.6, 0.9, 0.9}};
  const auto first_angles = [&](const physics::RobotDescription& robot) {
    const RollOut out = roll_out(robot, flat(), manoeuvre, exact());
    return std::array{out.run.column("flipper_fl_rad").front(), out.run.column("flipper_rr_rad").front()};
  };
  physics::RobotDescription slow = physics::load_robot("kenaf");
  slow.servo.max_speed_radps = 0.08;  // 12 s from -0.05 to 0.9 rad
  slow.flipper.front().start_angle_rad = -0.05;
  physics::RobotDescription lagging = physics::load_robot("kenaf"), late = lagging;
  lagging.effects.flipper_lag_s = 3;
  late.effects.command_delay_s = 1;
  for (const physics::RobotDescription& robot : {slow, lagging, late}) {
    const auto [front_left, rear_right] = first_angles(robot);
    CHECK(front_left == Approx(0.6).margin(0.02));
    CHECK(rear_right == Approx(0.9).margin(0.02));
  }
}
