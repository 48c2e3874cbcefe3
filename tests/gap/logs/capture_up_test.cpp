// Captures whose y axis points up, or whose z axis points down: seen, and turned so that z is up.
#include "gap/logs/capture_up.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "gap/logs/merge_pose.hpp"
#include "tests/gap/kenaf_gap.hpp"
#include "tests/gap/recorded_drive.hpp"

using namespace kenaf;
using gap::logs::MotionCapture;
using gap::logs::Up;

namespace {

// A z-up capture as a y-up system writes it, by hand: its x stays, its y is the height, its z points to the right,
// where -y was. The vector part of a quaternion changes as places do.
MotionCapture as_y_up(MotionCapture capture) {
  for (auto& pose : capture.poses) {
    pose.p_m = {pose.p_m.x(), pose.p_m.z(), -pose.p_m.y()};
    pose.q = {pose.q.w(), pose.q.x(), pose.q.z(), -pose.q.y()};
  }
  return capture;
}
// z down, y right
MotionCapture as_z_down(MotionCapture capture) {
  for (auto& pose : capture.poses) {
    pose.p_m = {pose.p_m.x(), -pose.p_m.y(), -pose.p_m.z()};
    pose.q = {pose.q.w(), pose.q.x(), -pose.q.y(), -pose.q.z()};
  }
  return capture;
}

std::string seen(const runs::Run& run, const MotionCapture& capture) {
  const auto up = gap::logs::up_seen(run, capture);
  return up ? name_of(up->up) : "z";
}

void check_same(const MotionCapture& a, const MotionCapture& b) {
  REQUIRE(a.poses.size() == b.poses.size());
  for (std::size_t i = 0; i < a.poses.size(); ++i) {
    CHECK((a.poses[i].p_m - b.poses[i].p_m).norm() < 1e-9);
    CHECK(a.poses[i].q.angularDistance(b.poses[i].q) < 1e-7);
  }
}

}  // namespace

TEST_CASE("A y-up pose becomes a z-up one: (x, y, z) is (x, -z, y), and a turn about y one about z") {
  // At (1, 0.09, -2), turned by 90 degrees about y, which takes x to -z: in z-up at (1, 2, 0.09), and x goes to y.
  const double half = std::sqrt(0.5);
  const MotionCapture y_up{{{0, {1, 0.09, -2}, {half, 0, half, 0}}, {1, {1, 0.09, -2}, {1, 0, 0, 0}}}, true, true};
  const MotionCapture z_up = gap::logs::with_z_up(y_up, Up::y, "m.csv");
  CHECK((z_up.poses[0].p_m - Eigen::Vector3d(1, 2, 0.09)).norm() < 1e-12);
  CHECK((z_up.poses[0].q * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm() < 1e-12);
  CHECK((z_up.poses[0].q * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitZ()).norm() < 1e-12);
  // A body whose own z axis points up: at rest y of the capture is z of the body, that is -90 degrees about x.
  const MotionCapture own_axes{{{0, {1, 0.09, -2}, {half, -half, 0, 0}}}, true, true};
  const MotionCapture kept = gap::logs::with_z_up(own_axes, Up::y, "m.csv");
  CHECK(kept.poses[0].q.angularDistance(Eigen::Quaterniond::Identity()) < 1e-7);

  MotionCapture planar = y_up;
  planar.has_tilt = false;
  CHECK_THROWS_WITH(gap::logs::with_z_up(planar, Up::y, "m.csv"),
                    Catch::StartsWith("m.csv:1:1: y up needs z and a quaternion"));
}

TEST_CASE("The axis that points up is seen by the robot's turns, with a gyro or by its tracks, and turned back") {
  const test::Drive drive = test::winding_drive();
  const MotionCapture capture = test::captured(drive, 3, {});
  for (const bool gyro : {true, false}) {
    const runs::Run run = test::robot_log(drive, 3, gyro);
    CHECK(seen(run, capture) == "z");
    CHECK(seen(run, as_y_up(capture)) == "y");
    check_same(gap::logs::with_z_up(as_y_up(capture), Up::y, "m.csv"), capture);
  }
  const runs::Run run = test::robot_log(drive, 3);
  // z down with the body's z up: half a turn about x
  MotionCapture down = as_z_down(capture);
  for (auto& pose : down.poses) pose.q = pose.q * Eigen::Quaterniond(0, 1, 0, 0);
  CHECK(seen(run, down) == "-z");
  check_same(gap::logs::with_z_up(down, Up::minus_z, "m.csv"), capture);
  check_same(gap::logs::with_z_up(as_z_down(capture), Up::minus_z, "m.csv"), capture);
}

TEST_CASE("A robot that goes straight along the capture's z axis does not rise, one that climbs does") {
  runs::Run run{{"t_s", "gyro_z_radps"}, {{}, {}}};
  MotionCapture along_z{{}, true, true}, climbs{{}, true, true};
  for (int i = 0; i < 100; ++i) {
    run.values[0].push_back(0.1 * i);
    run.values[1].push_back(0.001 * (i % 2));
    along_z.poses.push_back({0.1 * i, {0.001 * i, 0.09, -0.02 * i}, Eigen::Quaterniond::Identity()});
    // 45 degrees, nose up
    climbs.poses.push_back(
        {0.1 * i, {0.02 * i, 0, 0.02 * i}, Eigen::Quaterniond(Eigen::AngleAxisd(-0.785, Eigen::Vector3d::UnitY()))});
  }
  CHECK(seen(run, along_z) == "y");
  CHECK(seen(run, climbs) == "z");
}

TEST_CASE("The command merge refuses a y-up capture by name, reads it with --up y, and takes --up z at its word") {
  const test::TemporaryFolder folder;
  const test::Drive drive = test::winding_drive();
  runs::write_run(folder / "run.csv", test::robot_log(drive, 1));
  runs::Run table{{"t_s", "x_m", "y_m", "z_m", "qx", "qy", "qz", "qw"}, std::vector<std::vector<double>>(8)};
  for (const auto& pose : as_y_up(test::captured(drive, 1, {.offset_s = 1.2345})).poses) {
    const double cells[] = {pose.t_s,   pose.p_m.x(), pose.p_m.y(), pose.p_m.z(),
                            pose.q.x(), pose.q.y(),   pose.q.z(),   pose.q.w()};
    for (std::size_t i = 0; i < 8; ++i) table.values[i].push_back(cells[i]);
  }
  runs::write_run(folder / "mocap.csv", table);

  const test::Outcome refused = test::kenaf_gap(folder, "merge run.csv mocap.csv --out merged.csv");
  CHECK(refused.status == 2);
  CHECK_THAT(refused.error, Catch::Contains("mocap.csv: its y axis points up, not z") && Catch::Contains("--up y"));
  CHECK_FALSE(std::filesystem::exists(folder / "merged.csv"));
  const test::Outcome outcome = test::kenaf_gap(folder, "merge run.csv mocap.csv --up y --out merged.csv");
  INFO(outcome.error);
  REQUIRE(outcome.status == 0);
  // the robot stays at a height of 0.09 m and level
  const runs::Run merged = runs::read_run(folder / "merged.csv");
  for (const double z_m : merged.column("z_m")) CHECK((std::isnan(z_m) || std::abs(z_m - 0.09) < 1e-9));
  for (const double rad : merged.column("pitch_rad")) CHECK((std::isnan(rad) || std::abs(rad) < 1e-9));
  CHECK_THAT(test::kenaf_gap(folder, "merge run.csv mocap.csv --up z --offset 1.2345 --out z.csv").out,
             Catch::StartsWith("time offset: 1.2345 s, as given"));
}
