// Runs that begin in motion, and runs driven by what was measured.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "robot/angles.hpp"
#include "rollout/roll_out.hpp"
#include "tests/rollout/exact_runs.hpp"

using namespace kenaf;
using namespace kenaf::rollout;
using Catch::Contains;
using test::exact;
using test::flat;

namespace {

Manoeuvre drive(std::initializer_list<std::pair<double, double>> speeds_mps, double each_s) {
  Manoeuvre manoeuvre;
  manoeuvre.name = "drive";
  for (const auto& [left, right] : speeds_mps)
    manoeuvre.phases.push_back({.name = "",
                                .track_mps = {left, right},
                                .flipper_rad = {{0.9, 0.9, 0.9, 0.9}},
                                .at_most_s = each_s,
                                .end = {}});
  return manoeuvre;
}

// The rows of a run from one on, without the columns that are not wanted.
runs::Run cut(const runs::Run& run, std::size_t from_row, const std::vector<std::string>& without = {}) {
  runs::Run out;
  for (std::size_t c = 0; c < run.columns.size(); ++c) {
    if (std::ranges::count(without, run.columns[c]) > 0) continue;
    out.columns.push_back(run.columns[c]);
    out.values.emplace_back(run.values[c].begin() + static_cast<std::ptrdiff_t>(from_row), run.values[c].end());
  }
  return out;
}

struct Apart {
  double m = 0, rad = 0;
};

// The furthest that the second run is from the rows of the first one from `from_row` on.
Apart apart(const runs::Run& whole, std::size_t from_row, const runs::Run& continued) {
  Apart most;
  REQUIRE(continued.row_count() + from_row == whole.row_count());
  for (std::size_t row = 0; row < continued.row_count(); ++row) {
    const auto off = [&](const char* column) {
      return continued.column(column)[row] - whole.column(column)[from_row + row];
    };
    most.m = std::max(most.m, std::hypot(off("x_m"), off("y_m")));
    most.rad = std::max(most.rad, std::abs(robot::wrap_angle(off("yaw_rad"))));
  }
  return most;
}

runs::Run table(const std::string& columns, std::size_t rows, const auto& row_at) {
  std::string text = columns + "\n";
  for (std::size_t i = 0; i < rows; ++i) text += row_at(i) + "\n";
  return runs::parse_run(text, "run.csv");
}

}  // namespace

TEST_CASE("A run cut while it drives goes on where it was cut, not from rest") {
  const auto robot = physics::load_robot("kenaf");
  struct Case {
    const char* what;
    double left_mps, right_mps;
  };
  for (const Case& now :
       {Case{"straight", 0.3, 0.3}, Case{"back", -0.3, -0.3}, Case{"arc", 0.3, 0.15}, Case{"turn", -0.2, 0.2}}) {
    INFO(now.what);
    const RollOut whole = roll_out(robot, flat(), drive({{now.left_mps, now.right_mps}}, 2), exact());
    const RollOut rest = roll_out(robot, flat(), replay_of(cut(whole.run, 100), "cut"), exact());
    const Apart off = apart(whole.run, 100, rest.run);
    // From rest it would lag by 0.05 s: 15 mm. What is missing is how the robot leaned and how its contact points were
    // loaded, as it settles at rest first: with 0.04 mm of give, parts of a millimetre, and of that over the track's
    // length.
    CHECK(off.m < 1e-3);
    CHECK(off.rad < 2e-3);
    CHECK(rest.run.column("track_left_mps").front() == Approx(now.left_mps).margin(2e-3));
  }
}

TEST_CASE("A run cut while its drives still speed up goes on speeding up") {
  const auto robot = physics::load_robot("kenaf");
  const RollOut whole = roll_out(robot, flat(), drive({{0.1, 0.1}, {0.4, 0.4}}, 1), exact());
  const RollOut rest = roll_out(robot, flat(), replay_of(cut(whole.run, 104), "cut"), exact());  // 0.04 s into the step
  CHECK(apart(whole.run, 104, rest.run).m < 3e-3);
  const auto a = whole.run.column("track_left_mps"), b = rest.run.column("track_left_mps");
  // a drive's reference is ahead of its belt by what force over belt and robot needs, below 5 mm/s here
  for (std::size_t i = 0; i < b.size(); ++i) CHECK(b[i] == Approx(a[104 + i]).margin(5e-3));
}

TEST_CASE("A delayed command was on its way when the run began") {
  auto robot = physics::load_robot("kenaf");
  robot.effects.command_delay_s = 0.2;
  const RollOut whole = roll_out(robot, flat(), drive({{0.3, 0.3}, {0.1, 0.1}}, 1), exact());
  const RollOut rest = roll_out(robot, flat(), replay_of(cut(whole.run, 90), "cut"), exact());
  CHECK(apart(whole.run, 90, rest.run).m < 3e-3);
}

TEST_CASE("A run without encoders that moves in its poses begins in motion too, with noise as well") {
  const auto robot = physics::load_robot("kenaf");
  const std::vector<std::string> encoders{"track_left_mps", "track_right_mps", "track_left_m", "track_right_m"};
  for (const double noise : {0.0, 1.0}) {
    RollOutOptions options = exact();
    options.noise_scale = noise;
    const RollOut whole = roll_out(robot, flat(), drive({{0.3, 0.3}}, 2), options);
    const Manoeuvre moving = replay_of(cut(whole.run, 100, encoders), "cut");
    REQUIRE(moving.start->motion);
    CHECK_FALSE(moving.start->motion->track_mps);
    // sigma of a cubic's first slope, 26 poses of 1 mm in 0.25 s: sqrt(1200 / 26) / 0.25 s = 27 mm/s
    CHECK(*moving.start->motion->forward_mps == Approx(0.3).margin(noise > 0 ? 0.1 : 2e-3));
    const Manoeuvre standing = replay_of(cut(whole.run, 0, encoders), "whole");
    // a speed loop of 0.05 s is no cubic: it may be thought to have a quarter of its speed
    if (standing.start->motion) CHECK(std::abs(*standing.start->motion->forward_mps) < 0.1);
  }
}

TEST_CASE("A run that stands in its first row starts at rest, whatever it does next") {
  const auto robot = physics::load_robot("kenaf");
  RollOutOptions noisy;
  const RollOut run = roll_out(robot, flat(), drive({{0.3, -0.3}}, 0.5), noisy);
  CHECK_FALSE(replay_of(run.run, "run").start->motion);
}

TEST_CASE("How the body moves at first: the tracks' motion, times the share that poses show") {
  // left 0.2, right 0.6 m/s: forward 0.4 m/s, and it turns at 0.5 rad/s for 0.4 m/s between the tracks. The body
  // goes at 0.9 of the tracks' mean; poses each 0.1 s, first at yaw 1.
  const auto with = [](double share) {
    const double w = 0.5;
    return motion_at_start(
        table("t_s,track_left_mps,track_right_mps,x_m,y_m,yaw_rad", 40, [&](std::size_t i) -> std::string {
          const double t_s = 0.025 * static_cast<double>(i), yaw = 1 + w * t_s, r = share * 0.4 / w;
          if (i % 4 != 0) return fmt::format("{},0.2,0.6,,,", t_s);
          return fmt::format("{},0.2,0.6,{},{},{}", t_s, r * (std::sin(yaw) - std::sin(1.0)),
                             -r * (std::cos(yaw) - std::cos(1.0)), yaw);
        }));
  };
  for (const double share : {0.9, 0.6, 1.4, -0.3}) {
    const auto motion = with(share);
    REQUIRE(motion);
    CHECK((*motion->track_mps)[robot::kLeft] == 0.2);
    CHECK((*motion->track_mps)[robot::kRight] == 0.6);
    CHECK(*motion->forward_mps ==
          Approx(std::clamp(share, 0.0, 1.0) * 0.4).epsilon(1e-3));  // chords of an arc of 0.05 rad: 1e-4
    CHECK(*motion->yaw_radps == Approx(0.5).epsilon(1e-9));
  }
}

TEST_CASE("Poses that are late make no body turn faster than its tracks can turn it, nor the other way") {
  const auto robot = physics::load_robot("kenaf");
  Manoeuvre still = drive({{0, 0}}, 0.1);
  for (const double yaw_radps : {9.0, -9.0, 0.5}) {
    still.start = Start{.x_m = 0,
                        .y_m = 0,
                        .yaw_rad = 0,
                        .z_m = {},
                        .flipper_rad = {},
                        .motion = StartMotion{.track_mps = {{-0.1, 0.1}}, .forward_mps = 0, .yaw_radps = yaw_radps}};
    const double first = roll_out(robot, flat(), still, exact()).run.column("gyro_z_radps").front();
    CHECK(first == Approx(std::clamp(yaw_radps, 0.0, 0.2 / robot.track_gauge_m())).margin(1e-9));
  }
}

TEST_CASE("Without poses to tell, a body moves as its tracks do") {
  const auto motion = motion_at_start(runs::parse_run(
      "t_s,track_left_mps,track_right_mps,x_m,y_m,yaw_rad\n0,0.2,0.3,0,0,0\n2,0.2,0.3,,,\n", "run.csv"));
  REQUIRE(motion);
  CHECK_FALSE(motion->forward_mps);
  CHECK_FALSE(motion->yaw_radps);
}

TEST_CASE("Measured speed: cells between are interpolated, what is before and after is constant") {
  const MeasuredMotion motion = measured_motion(
      runs::parse_run("t_s,track_left_mps,flipper_rl_rad\n3,,\n4,0.2,3\n5,,\n6,0.4,-3\n7,,\n", "run.csv"));
  REQUIRE(motion.track_mps[robot::kRight].empty());
  const TimeSeries& left = motion.track_mps[robot::kLeft];
  CHECK(left.at(0) == 0.2);
  CHECK(left.at(1) == 0.2);
  CHECK(left.at(2) == Approx(0.3));
  CHECK(left.at(3) == 0.4);
  CHECK(left.at(9) == 0.4);
  // 3 to -3 rad is the short way over pi
  CHECK(motion.flipper_rad[robot::kRearLeft].at(2) == Approx(std::numbers::pi));
  const physics::PrescribedMotion at = motion.at(2);
  CHECK_FALSE(at.track_mps[robot::kRight]);
  CHECK(at.flipper_rad[robot::kRearLeft]);
  CHECK_FALSE(at.flipper_rad[robot::kFrontLeft]);
}

TEST_CASE("Where travel is measured too, speed keeps its shape and comes as far as the travel") {
  // a speed that reads 0.05 m/s too much and swings; travel without that error
  const auto shape = [](double t_s) { return 0.3 + 0.1 * std::sin(2 * t_s); };
  const auto way = [](double t_s) { return 0.3 * t_s - 0.05 * (std::cos(2 * t_s) - 1); };
  const auto run = table("t_s,track_left_mps,track_left_m", 201, [&](std::size_t i) {
    const double t_s = 0.01 * static_cast<double>(i);
    return fmt::format("{},{},{}", t_s, shape(t_s) + 0.05, way(t_s));
  });
  const TimeSeries speed = measured_motion(run).track_mps[robot::kLeft];
  double come_m = 0;
  for (int i = 0; i < 2000; ++i) {
    const double t_s = 0.001 * (i + 0.5);
    CHECK(speed.at(t_s) == Approx(shape(t_s)).margin(1e-4));
    come_m += 0.001 * speed.at(t_s);
  }
  CHECK(come_m == Approx(way(2)).margin(1e-6));
}

TEST_CASE("Travel alone gives the speed, with its counts smoothed") {
  // counts of 0.2 mm at 100 Hz: single differences would be off by up to 20 mm/s
  const auto run = table("t_s,track_right_m", 301, [](std::size_t i) {
    const double t_s = 0.01 * static_cast<double>(i);
    return fmt::format("{},{}", t_s, std::floor(0.123 * t_s / 0.0002) * 0.0002);
  });
  const TimeSeries speed = measured_motion(run).track_mps[robot::kRight];
  double come_m = 0;
  for (int i = 0; i < 3000; ++i) {
    const double is = speed.at(0.001 * (i + 0.5));
    CHECK(is == Approx(0.123).margin(0.0002 / 0.05 + 0.0002 / 0.1));  // a count in 0.05 s, and one in 0.1 s
    come_m += 0.001 * is;
  }
  CHECK(come_m == Approx(0.369).margin(2.5e-4));  // a count
}

TEST_CASE("A replay of measured tracks turns them exactly so, and commands and drives play no part") {
  const auto robot = physics::load_robot("kenaf");
  auto weak = robot;
  weak.effects.command_gain = 0.5;
  weak.effects.drive_lag_s = 0.5;
  weak.effects.drive_asymmetry = 0.3;
  weak.effects.drive_coulomb_n = 50;
  const Manoeuvre weave = drive({{0.3, 0.1}, {0.05, 0.3}, {-0.2, -0.3}}, 0.6);
  const RollOut real = roll_out(robot, flat(), weave, exact());
  const Manoeuvre measured = replay_measured_of(real.run, "run");
  const RollOut nominal = roll_out(robot, flat(), measured, exact());
  const RollOut bad_drives = roll_out(weak, flat(), measured, exact());
  CHECK(bad_drives.run.column("x_m").back() == nominal.run.column("x_m").back());
  CHECK(bad_drives.run.column("yaw_rad").back() == nominal.run.column("yaw_rad").back());
  for (const char* column : {"track_left_mps", "track_right_mps"})
    for (std::size_t i = 0; i < real.run.row_count(); ++i)
      // over 0.1 s: a count of 0.2 mm; between samples a step's exponential is no straight line, 0.06 mm; the
      // simulator's travel is a sum of speeds at the steps' ends, half a step of 0.35 m/s, 0.18 mm
      CHECK(nominal.run.column(column)[i] == Approx(real.run.column(column)[i]).margin(4.5e-3));
  CHECK(apart(real.run, 0, nominal.run).m < 2e-3);
  CHECK(apart(real.run, 0, nominal.run).rad < 10e-3);
}

TEST_CASE("A replay of measured tracks that begins in motion comes v t far") {
  const auto robot = physics::load_robot("kenaf");
  const auto run = table("t_s,track_left_mps,track_right_mps,x_m,y_m,yaw_rad", 21, [](std::size_t i) {
    const double t_s = 0.1 * static_cast<double>(i);
    return fmt::format("{},0.25,0.25,{},0,0", t_s, 0.25 * t_s);
  });
  const RollOut out = roll_out(robot, flat(), replay_measured_of(run, "run"), exact());  // needs no commands
  CHECK(out.run.column("x_m").back() == Approx(0.5).margin(1e-3));
  CHECK(out.run.column("track_left_mps").front() == 0.25);
}

TEST_CASE("Encoders that report too much are no reason to drive too far") {
  auto robot = physics::load_robot("kenaf");
  robot.effects.encoder_scale = 1.1;
  const RollOut real = roll_out(robot, flat(), drive({{0.3, 0.3}}, 2), exact());
  const RollOut again = roll_out(robot, flat(), replay_measured_of(real.run, "run"), exact());
  CHECK(real.run.column("track_left_mps").back() == Approx(0.33).epsilon(0.01));
  CHECK(again.run.column("track_left_mps").back() == Approx(0.33).epsilon(0.01));
  CHECK(again.run.column("x_m").back() == Approx(real.run.column("x_m").back()).margin(2e-3));
}

TEST_CASE("Sensors that report late are no reason to drive late") {
  const auto robot = physics::load_robot("kenaf");
  auto late = robot;
  for (physics::SensorDescription& sensor : late.sensors)
    if (sensor.type == physics::SensorType::encoder || sensor.type == physics::SensorType::tachometer)
      sensor.delay_s = 0.1;
  const RollOut real = roll_out(late, flat(), drive({{0.3, 0.3}}, 2), exact());
  const Manoeuvre measured = replay_measured_of(real.run, "run");
  // by 0.1 s at 0.3 m/s
  const auto behind_m = [&](const physics::RobotDescription& described) {
    const RollOut again = roll_out(described, flat(), measured, exact());
    const std::size_t row = real.run.row_count() / 2;
    return real.run.column("x_m")[row] - again.run.column("x_m")[row];
  };
  CHECK(behind_m(robot) == Approx(0.03).margin(2e-3));
  CHECK(behind_m(late) == Approx(0).margin(2e-3));
}

TEST_CASE("Of speed that is held to travel the delay of the travel counts") {
  const auto at_one = [](const char* csv, const ReportDelays& late) {
    return *measured_motion(runs::parse_run(csv, "run.csv")).at(1, late).track_mps[robot::kLeft];
  };
  const ReportDelays late{.track_speed_s = 1, .track_travel_s = 2, .flipper_s = 0};
  // the speed grows by 0.1 m/s each second
  CHECK(at_one("t_s,track_left_mps\n0,0\n4,0.4\n", late) == Approx(0.2));
  CHECK(at_one("t_s,track_left_mps,track_left_m\n0,0,0\n1,0.1,0.05\n2,0.2,0.2\n3,0.3,0.45\n4,0.4,0.8\n", late) ==
        Approx(0.3));
}

TEST_CASE("Encoders that report more on the left are no reason to turn, from rest or on the way") {
  auto robot = physics::load_robot("kenaf");
  robot.effects.encoder_scale = 1.1;
  robot.effects.encoder_asymmetry = 0.1;
  const auto run = table("t_s,track_left_mps,track_right_mps,x_m,y_m,yaw_rad", 21, [](std::size_t i) {
    const double t_s = 0.1 * static_cast<double>(i);
    return fmt::format("{},{},{},{},0,0", t_s, 0.2 * 1.1 * 1.05, 0.2 * 1.1 * 0.95, 0.2 * t_s);
  });
  const RollOut out = roll_out(robot, flat(), replay_measured_of(run, "run"), exact());
  CHECK(out.run.column("track_left_mps").front() == Approx(0.2 * 1.1 * 1.05));
  CHECK(out.run.column("track_right_mps").back() == Approx(0.2 * 1.1 * 0.95));
  CHECK(out.run.column("x_m").back() == Approx(0.4).margin(1e-3));
  CHECK(std::abs(out.run.column("yaw_rad").back()) < 1e-3);
}

TEST_CASE("A run that measured nothing of its drives is not replayed so, and it says why") {
  const auto replay = [](const char* csv) { return replay_measured_of(runs::parse_run(csv, "run.csv"), "run.csv"); };
  CHECK_THROWS_WITH(replay("t_s,cmd_track_left_mps,cmd_track_right_mps,x_m,y_m,yaw_rad\n0,0,0,0,0,0\n"),
                    Contains("run.csv: has no measured tracks"));
  CHECK_THROWS_WITH(replay("t_s,track_left_mps,x_m,y_m,yaw_rad\n0,0,0,0,0\n"),
                    Contains("neither commands nor measured"));
  CHECK_THROWS_AS(load_manoeuvre("replay-measured:/no/such/file.csv"), runs::RunFileError);
}
