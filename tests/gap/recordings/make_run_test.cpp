// Rows, rules of sampling, track speeds from v and w, poses in other frames.
#include "gap/recordings/make_run.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "gap/recordings/pose_of_samples.hpp"
#include "gap/recordings/recording_error.hpp"

using namespace kenaf::gap::recordings;

namespace make_run_test {
namespace {

constexpr double kPi = std::numbers::pi;

std::vector<double> values(const MadeRun& made, const std::string& column) {
  const auto found = made.run.column(column);
  return {found.begin(), found.end()};
}

// NaN is written as -99.
std::vector<double> seen(std::vector<double> numbers) {
  for (double& number : numbers)
    if (std::isnan(number)) number = -99;
  return numbers;
}

const std::vector<double> kRows = {1, 1.1, 1.2, 1.3};

// A body that stands at x = 2, y = 3 and turns to the left, seen at 0, 1 and 2 s.
Collected standing(const std::string& order) {
  Collected collected;
  const std::vector<double> times = {0, 1, 2};
  const auto put = [&](const std::string& name, std::vector<double> numbers) {
    collected.samples[{name, TimeFrom::header}] = {times, std::move(numbers)};
  };
  put("x", {2000, 2000, 2000});
  put("y", {3000, 3000, 3000});
  put("z", {90, 90, 90});
  if (order == "quaternion") {
    put("qx", {0, 0, 0});
    put("qy", {0, 0, 0});
    put("qz", {0, std::sin(kPi / 8), std::sin(kPi / 4)});
    put("qw", {1, std::cos(kPi / 8), std::cos(kPi / 4)});
  } else {
    put("yaw", {0, 45, 90});
  }
  return collected;
}

PoseMapping pose_mapping() {
  PoseMapping pose{};
  pose.position = {"x", "y", "z"};
  pose.rotation = {"qx", "qy", "qz", "qw"};
  pose.order = "quaternion";
  pose.length_factor = 1e-3;
  pose.angle_factor = kPi / 180;
  return pose;
}

}  // namespace

TEST_CASE("hold: the newest value before, for so long as it says") {
  const Samples samples{{0.95, 1.15}, {5, 6}};
  CHECK(seen(sampled(samples, kRows, {TimeFrom::header, 0, Sampling::hold, {}}, false)) ==
        std::vector<double>{5, 5, 6, 6});
  // 1.1 is 0.15 after 0.95, and 1.3 is 0.15 after 1.15
  CHECK(seen(sampled(samples, kRows, {TimeFrom::header, 0, Sampling::hold, 0.12}, false)) ==
        std::vector<double>{5, -99, 6, -99});
  CHECK(seen(sampled({{1.05}, {7}}, kRows, {TimeFrom::header, 0, Sampling::hold, {}}, false)) ==
        std::vector<double>{-99, 7, 7, 7});
}

TEST_CASE("linear: between two values, not beyond them and not in a gap") {
  const Samples samples{{1.05, 1.15, 1.25}, {0, 1, 3}};
  const auto made = seen(sampled(samples, kRows, {}, false));
  CHECK(made[0] == -99);
  CHECK(made[1] == Approx(0.5));
  CHECK(made[2] == Approx(2));
  CHECK(made[3] == -99);
  // The gap from 1.05 to 1.25 is more than 2.5 times the median step of 0.01.
  CHECK(seen(sampled({{1.03, 1.04, 1.05, 1.25, 1.26}, {0, 0, 0, 9, 9}}, kRows, {}, false))[2] == -99);
  CHECK(seen(sampled({{1.03, 1.04, 1.05, 1.25, 1.26}, {0, 0, 0, 9, 9}}, kRows,
                     {TimeFrom::header, 0, Sampling::linear, 0.5}, false))[2] == Approx(6.75));
}

TEST_CASE("linear: an angle that jumps at pi goes the short way") {
  // from 3.1 to -3.1: over pi, by 2 pi - 6.2
  const auto made = sampled({{1, 1.2}, {3.1, -3.1}}, std::vector<double>{1, 1.1, 1.2}, {}, true);
  CHECK(std::abs(made[1]) == Approx(kPi));
  CHECK(made[2] == Approx(-3.1));
}

TEST_CASE("nearest: each value once, in the row nearest to it") {
  const Samples slow{{1.04, 1.26}, {4, 8}};
  CHECK(seen(sampled(slow, kRows, {TimeFrom::header, 0, Sampling::nearest, {}}, false)) ==
        std::vector<double>{4, -99, -99, 8});
  // of two values for one row the nearer one; beyond half a step there is no row
  CHECK(seen(sampled({{1.09, 1.11, 1.105, 2}, {1, 2, 3, 4}}, kRows, {TimeFrom::header, 0, Sampling::nearest, {}},
                     false)) == std::vector<double>{-99, 3, -99, -99});
}

TEST_CASE("v and w become the speeds of the tracks, and rows begin at 0") {
  Collected collected;
  collected.samples[{"v", TimeFrom::header}] = {{10, 10.1}, {500, 500}};
  collected.samples[{"w", TimeFrom::header}] = {{10, 10.1}, {0, 90}};
  Mapping mapping;
  mapping.rows = "track_left_mps";
  mapping.drives = {{false, "v", "w", 1e-3, kPi / 180, {}, {}}};
  const MadeRun made = make_run(mapping, collected, 0.4);
  CHECK(values(made, "t_s")[0] == 0);
  CHECK(values(made, "t_s")[1] == Approx(0.1));
  // 0.5 m/s; turning to the left by pi / 2 rad/s, left is 0.2 m times that slower
  CHECK(values(made, "track_left_mps")[0] == 0.5);
  CHECK(values(made, "track_left_mps")[1] == Approx(0.5 - 0.1 * kPi));
  CHECK(values(made, "track_right_mps")[1] == Approx(0.5 + 0.1 * kPi));
  CHECK_THROWS_WITH(make_run(mapping, collected, {}), Catch::Contains("gauge_m"));
}

TEST_CASE("A delay moves values to when they were measured") {
  Collected collected;
  collected.samples[{"a", TimeFrom::header}] = {{1, 2, 3}, {1, 2, 3}};
  collected.samples[{"b", TimeFrom::header}] = {{1, 2, 3}, {10, 20, 30}};
  Mapping mapping;
  mapping.rows = "track_left_mps";
  mapping.columns = {{"track_left_mps", "a", 1, {}},
                     {"track_right_mps", "b", 1, {TimeFrom::header, 0.5, Sampling::linear, {}}}};
  // b's value 20 of the stamp 2 is that of 1.5: at 2 it is between 20 and 30
  CHECK(seen(values(make_run(mapping, collected, {}), "track_right_mps")) == std::vector<double>{15, 25, -99});
}

TEST_CASE("Rows every so often, from the first value to the last") {
  Collected collected;
  collected.samples[{"a", TimeFrom::header}] = {{5, 6}, {0, 1}};
  Mapping mapping;
  mapping.every_s = 0.25;
  mapping.columns = {{"battery_v", "a", 1, {}}, {"mine", "a", 2, {}}, {"track_left_a", "a", 3, {}}};
  const MadeRun made = make_run(mapping, collected, {});
  CHECK(values(made, "t_s") == std::vector<double>{0, 0.25, 0.5, 0.75, 1});
  CHECK(values(made, "battery_v") == std::vector<double>{0, 0.25, 0.5, 0.75, 1});
  CHECK(made.run.columns ==
        std::vector<std::string>{"t_s", "track_left_a", "battery_v", "mine"});  // in the order of the format
}

TEST_CASE("A pose in millimetres from the start: x forward, y left") {
  Mapping mapping;
  mapping.rows = "pose";
  mapping.pose = pose_mapping();
  const MadeRun made = make_run(mapping, standing("quaternion"), {});
  CHECK(values(made, "x_m")[2] == Approx(0).margin(1e-12));
  CHECK(values(made, "z_m")[0] == Approx(0.09));
  CHECK(values(made, "yaw_rad")[1] == Approx(kPi / 4));

  mapping.pose->keep_frame = true;
  CHECK(values(make_run(mapping, standing("quaternion"), {}), "y_m")[0] == Approx(3));

  mapping.pose->rotation = {"yaw"};
  mapping.pose->order = "z";
  const MadeRun flat = make_run(mapping, standing("z"), {});
  CHECK(values(flat, "yaw_rad")[2] == Approx(kPi / 2));
  CHECK(flat.run.column("pitch_rad").empty());
}

TEST_CASE("A world whose y axis points up becomes one whose z axis does") {
  // Motive: x to the right, y up, z back. The body goes to -z there, which is y, to the left of x.
  Collected collected = standing("quaternion");
  const auto put = [&](const std::string& name, std::vector<double> numbers) {
    collected.samples[{name, TimeFrom::header}] = {{0, 1, 2}, std::move(numbers)};
  };
  put("x", {0, 0, 0});
  put("y", {90, 90, 90});
  put("z", {0, -1000, -2000});
  put("qz", {0, 0, 0});
  put("qy", {0, std::sin(kPi / 8), std::sin(kPi / 4)});  // turns about the axis that points up
  Mapping mapping;
  mapping.rows = "pose";
  mapping.pose = pose_mapping();
  mapping.pose->up = kenaf::gap::logs::Up::y;
  const MadeRun made = make_run(mapping, collected, {});
  CHECK(values(made, "y_m")[2] == Approx(2));
  CHECK(values(made, "z_m")[2] == Approx(0.09));
  CHECK(values(made, "yaw_rad")[2] == Approx(kPi / 2));
  // Without a word on it the axis is seen, and the mapping is to name it.
  mapping.pose->up.reset();
  CHECK_THROWS_WITH(make_run(mapping, collected, {}), Catch::Contains("up = \"y\""));
}

TEST_CASE("Rotations of each order") {
  const double h = std::sqrt(0.5);
  const auto turned_x = [](const std::string& order, std::vector<double> numbers) {
    return Eigen::Vector3d(rotation_of(order, numbers) * Eigen::Vector3d::UnitX());
  };
  CHECK(turned_x("quaternion", {0, 0, h, h}).isApprox(Eigen::Vector3d::UnitY(), 1e-12));
  CHECK(turned_x("vector", {0, 0, kPi / 2}).isApprox(Eigen::Vector3d::UnitY(), 1e-12));
  CHECK(turned_x("vector", {0, 0, 0}).isApprox(Eigen::Vector3d::UnitX(), 1e-12));
  // About x first, then about y as turned, which points up then: x goes to the left... about z_0 by 90 degrees.
  CHECK(turned_x("xyz", {kPi / 2, kPi / 2, 0}).isApprox(Eigen::Vector3d::UnitY(), 1e-12));
  // Yaw first, then pitch, nose down.
  CHECK(turned_x("zyx", {kPi / 2, kPi / 2, 0}).isApprox(-Eigen::Vector3d::UnitZ(), 1e-12));
}

TEST_CASE("Quaternions that are none are left out and counted") {
  Collected collected = standing("quaternion");
  collected.samples[{"qw", TimeFrom::header}].value[1] = 0;
  const PoseOfSamples found = pose_of_samples(pose_mapping(), collected);
  CHECK(found.capture.poses.size() == 2);
  REQUIRE(found.remarks.size() == 1);
  CHECK(found.remarks[0].starts_with("1 poses are left out"));
}

TEST_CASE("A command that ended stops the tracks after the time that the mapping gives it, and a flipper stays") {
  // The last command comes at 0.15 s: with 0.25 s in force there is none at 0.5 s and 0.75 s.
  Collected collected;
  collected.samples[{"v", TimeFrom::header}] = {{0.05, 0.15}, {0.2, 0.3}};
  collected.samples[{"w", TimeFrom::header}] = {{0.05, 0.15}, {0, 0}};
  collected.samples[{"i", TimeFrom::header}] = {{0, 0.25, 0.5, 0.75}, {1, 1, 1, 1}};
  Mapping mapping;
  mapping.rows = "track_left_a";
  mapping.drives = {{true, "v", "w", 1, 1, 0.4, {TimeFrom::header, 0, Sampling::hold, 0.25}}};
  mapping.columns = {{"track_left_a", "i", 1, {}},
                     {"cmd_flipper_fl_rad", "v", 1, {TimeFrom::header, 0, Sampling::hold, 0.25}}};
  const MadeRun made = make_run(mapping, collected, {});
  CHECK(seen(values(made, "cmd_track_left_mps")) == std::vector<double>{-99, 0.3, 0, 0});
  CHECK(seen(values(made, "cmd_track_right_mps")) == std::vector<double>{-99, 0.3, 0, 0});
  CHECK(seen(values(made, "cmd_flipper_fl_rad")) == std::vector<double>{-99, 0.3, -99, -99});
  CHECK(
      made.remarks.at(0) ==
      "cmd_track_left_mps: 0, to stop, in 2 rows that are more than max_gap_s = 0.25 s after the command before them");
  // without one given, cells stay empty, and a replay repeats the command
  mapping.drives[0].timing.max_gap_s.reset();
  collected.samples[{"i", TimeFrom::header}] = {{0.25, 2}, {1, 1}};
  CHECK(seen(values(make_run(mapping, collected, {}), "cmd_track_left_mps")) == std::vector<double>{0.3, -99});
}

}  // namespace make_run_test
