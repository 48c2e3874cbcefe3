// Motion capture's pose in a recorded run: the clocks' offset, the frame, the times.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "gap/logs/merge_pose.hpp"
#include "gap/logs/plausibility.hpp"
#include "tests/gap/kenaf_gap.hpp"
#include "tests/gap/recorded_drive.hpp"

using namespace kenaf;
using test::captured;
using test::CaptureOptions;
using test::Drive;
using test::DrivenPath;
using test::robot_log;
using test::winding_drive;

namespace {

constexpr double kDegree = std::numbers::pi / 180;

gap::logs::ClockOffset offset_of(const runs::Run& run, const gap::logs::MotionCapture& capture) {
  return gap::logs::estimate_clock_offset(gap::logs::courses_seen_twice(run, capture));
}

std::string why_no_offset(const runs::Run& run, const gap::logs::MotionCapture& capture) {
  try {
    const auto offset = offset_of(run, capture);
    return "estimated: " + std::to_string(offset.offset_s) + " +- " + std::to_string(offset.standard_error_s);
  } catch (const gap::logs::NoOffset& error) {
    return error.what();
  }
}

// The same with one column multiplied.
runs::Run with_scaled_column(runs::Run run, const std::string& column, double factor) {
  for (std::size_t i = 0; i < run.columns.size(); ++i)
    if (run.columns[i] == column)
      for (double& value : run.values[i]) value *= factor;
  return run;
}

const gap::logs::QuantityOffset& quantity(const gap::logs::ClockOffset& offset, const std::string& beginning) {
  for (const auto& each : offset.quantities)
    if (each.name.starts_with(beginning)) return each;
  throw std::runtime_error("no quantity " + beginning);
}

}  // namespace

TEST_CASE("An offset of the clocks is found within three times its standard error, whatever the noise") {
  const Drive drive = winding_drive();
  for (const bool gyro : {true, false}) {
    double sum_of_squares = 0;
    constexpr int kSeeds = 12;
    for (unsigned seed = 1; seed <= kSeeds; ++seed) {
      const auto offset = offset_of(robot_log(drive, seed, gyro), captured(drive, seed, {.offset_s = 1.2345}));
      INFO("gyro " << gyro << ", seed " << seed << ": " << offset.offset_s << " +- " << offset.standard_error_s);
      const double in_errors = (offset.offset_s - 1.2345) / offset.standard_error_s;
      CHECK(std::abs(in_errors) < 3);
      // A yaw noise of 2 mrad over a window of 0.2 s is 0.014 rad/s a sample; 0.5 rad/s that change about once a second
      // are 0.5 rad/s^2: 0.028 s for one sample, with the 2000 of them (2 windows' worth of which are one) far below 4
      // ms.
      CHECK(offset.standard_error_s < 0.004);
      CHECK(offset.from_tracks == !gyro);
      sum_of_squares += in_errors * in_errors;
    }
    // Were the error stated right, the mean is 1, and with 12 seeds within 0.4 of it nineteen times of twenty; it may
    // be stated too large, as the larger of two estimates is taken, but not by a factor.
    CHECK(std::sqrt(sum_of_squares / kSeeds) < 1.5);
    CHECK(std::sqrt(sum_of_squares / kSeeds) > 0.2);
  }
}

TEST_CASE("Offsets of any size are found: clocks that count from another day, captures that begin later or earlier") {
  const Drive drive = winding_drive();
  for (const CaptureOptions& options : {CaptureOptions{.offset_s = -1.7e9},
                                        {.offset_s = 3.21, .from_s = 6},
                                        {.offset_s = -2, .to_s = 12},
                                        {.offset_s = 0.5, .period_s = 0.1}}) {
    const auto offset = offset_of(robot_log(drive, 5), captured(drive, 5, options));
    INFO(options.offset_s << ": " << offset.offset_s << " +- " << offset.standard_error_s);
    CHECK(std::abs(offset.offset_s - options.offset_s) < 4 * offset.standard_error_s + 1e-6);
    CHECK(offset.standard_error_s < 0.01);
  }
}

TEST_CASE(
    "What a quantity's gain is: one for a gyro, one for travel without slip, and an effective gauge for the tracks") {
  const Drive drive = winding_drive();
  const auto with = offset_of(robot_log(drive, 2), captured(drive, 2, {}));
  CHECK(quantity(with, "turn about z").gain == Approx(1).margin(0.01));
  CHECK(quantity(with, "travel").gain == Approx(1).margin(0.01));
  CHECK_FALSE(quantity(with, "travel").used);
  // right less left is 0.8 m times the turn rate
  const auto without = offset_of(robot_log(drive, 2, false), captured(drive, 2, {}));
  CHECK(quantity(without, "turn by the tracks").gain == Approx(0.8).margin(0.01));
}

TEST_CASE("A course that both logs have to the last digit has an offset and an error of it") {
  const Drive drive = winding_drive();
  gap::logs::Course turned{{}, {}, 0.1};
  double yaw_rad = 0;
  for (int i = 0; i <= 2000; ++i) {
    turned.t_s.push_back(0.01 * i);
    turned.value.push_back(yaw_rad += 0.01 * drive.turn_radps(0.01 * i));
  }
  const auto offset = gap::logs::estimate_clock_offset({{"turn", turned, turned, 0.5, 2, 0.1, false}});
  CHECK(std::abs(offset.offset_s) < 1e-6);
  CHECK(offset.standard_error_s < 1e-6);  // no residual is left to estimate it from
}

TEST_CASE("A run whose times are beyond those of robots is refused") {
  const Drive drive = winding_drive();
  runs::Run run = robot_log(drive, 1);
  REQUIRE(run.columns.front() == "t_s");
  run.values.front().front() = -1.7e308;
  run.values.front().back() = 1.7e308;
  CHECK_THROWS_WITH(gap::logs::merge_pose(run, captured(drive, 1, {}), {}), Catch::Contains("which is implausible"));
}

TEST_CASE("No offset is made up: standstill, other drives, drives that repeat themselves") {
  const Drive drive = winding_drive();
  const Drive still{[](double) { return 0.0; }, [](double) { return 0.0; }, 20};
  CHECK_THAT(why_no_offset(robot_log(still, 1), captured(drive, 1, {})), Catch::Contains("does not move in the run"));
  CHECK_THAT(why_no_offset(robot_log(drive, 1), captured(still, 1, {})),
             Catch::Contains("does not move in the motion capture"));
  // Other frequencies throughout.
  const Drive other{[](double t) { return 0.2 + 0.1 * std::sin(3.1 * t); },
                    [](double t) { return 0.5 * std::cos(4.7 * t); }, 20};
  CHECK_THAT(why_no_offset(robot_log(drive, 1), captured(other, 1, {})), !Catch::StartsWith("estimated"));
  // One that is the same every 4 s, and goes on beyond both ends.
  const double w = 2 * std::numbers::pi / 4;
  const Drive again{[w](double t) { return 0.2 + 0.1 * std::sin(w * t); },
                    [w](double t) { return 0.4 * std::cos(w * t); }, 20};
  CHECK_THAT(why_no_offset(robot_log(again, 1), captured(again, 1, {})), Catch::Contains("repeats itself"));
  // One speed all the time.
  const Drive steady{[](double) { return 0.2; }, [](double) { return 0.0; }, 20};
  CHECK_THAT(why_no_offset(robot_log(steady, 1), captured(steady, 1, {.from_s = 2})),
             Catch::Contains("hardly changes its speed"));
}

TEST_CASE("The same drive that repeats itself tells its offset where it begins and ends at rest") {
  const double w = 2 * std::numbers::pi / 4;
  const auto share = [](double t) { return t > 2 && t < 18 ? 1.0 : 0.0; };
  const Drive drive{[=](double t) { return share(t) * (0.2 + 0.1 * std::sin(w * t)); },
                    [=](double t) { return share(t) * 0.4 * std::cos(w * t); }, 20};
  const auto offset = offset_of(robot_log(drive, 1), captured(drive, 1, {.offset_s = -0.777}));
  CHECK(std::abs(offset.offset_s + 0.777) < 4 * offset.standard_error_s);
}

TEST_CASE("Units and signs that are wrong are named, not fitted") {
  const Drive drive = winding_drive();
  const runs::Run run = robot_log(drive, 1);
  gap::logs::MotionCapture millimetres = captured(drive, 1, {});
  for (auto& pose : millimetres.poses) pose.p_m *= 1000;
  Drive straight = drive;
  straight.turn_radps = [](double) { return 0.0; };
  gap::logs::MotionCapture ahead = captured(straight, 1, {});
  for (auto& pose : ahead.poses) pose.p_m *= 1000;
  CHECK_THAT(why_no_offset(robot_log(straight, 1, false), ahead),
             Catch::Contains("millimetres; give --mocap-units mm"));
  CHECK_THAT(why_no_offset(with_scaled_column(run, "gyro_z_radps", 180 / std::numbers::pi), captured(drive, 1, {})),
             Catch::Contains("the run looks like degrees"));
  CHECK_THAT(why_no_offset(with_scaled_column(run, "gyro_z_radps", -1), captured(drive, 1, {})),
             Catch::Contains("wrong sign"));
  CHECK_THAT(why_no_offset(run, millimetres), Catch::Contains("millimetres"));
}

TEST_CASE("Merged poses are the true ones at the run's times, as far as straight lines between captured poses are") {
  const Drive drive = winding_drive();
  const runs::Run run = robot_log(drive, 3);
  const gap::logs::MotionCapture capture = captured(drive, 3, {.offset_s = 1.2345, .noise = 0});
  const auto merged = gap::logs::merge_pose(run, capture, {.keep_frame = true, .offset_s = 1.2345});
  const test::DrivenPath path(drive);
  const auto t = merged.run.column("t_s"), x = merged.run.column("x_m"), y = merged.run.column("y_m"),
             yaw = merged.run.column("yaw_rad"), z = merged.run.column("z_m");
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (std::isnan(x[i])) continue;
    const auto pose = path.at(t[i]);
    // The error of a straight line is at most h^2 / 8 of the second derivative: (1/120 s)^2 / 8 times below 1 m/s^2 and
    // below 2 rad/s^2 is 9 um and 17 urad.
    REQUIRE(std::hypot(x[i] - pose.x_m, y[i] - pose.y_m) < 9e-6);
    REQUIRE(std::abs(yaw[i] - pose.yaw_rad) < 17e-6);
    REQUIRE(z[i] == Approx(0.09));
  }
  // The capture's last pose is up to 1/120 s before the run's last row.
  CHECK(merged.rows_with_pose >= t.size() - 1);
  CHECK(merged.run.column("gyro_z_radps").size() == t.size());
}

TEST_CASE("Clocks that drift apart are found within three times the standard error, others are not") {
  const Drive drive = winding_drive(120);
  for (const double drift : {200e-6, -1000e-6}) {
    for (const bool gyro : {true, false}) {
      const auto merged =
          gap::logs::merge_pose(robot_log(drive, 7, gyro), captured(drive, 7, {.offset_s = 1.5, .drift = drift}), {});
      INFO("drift " << drift << ": " << merged.drift.rate << " +- " << merged.drift.standard_error);
      CHECK(std::abs(merged.drift.rate - drift) < 3 * merged.drift.standard_error);
      // 200 ppm over 120 s are 24 ms
      CHECK(merged.drift.standard_error < 0.2 * std::abs(drift));
      CHECK(std::abs(merged.drift.offset_s - (1.5 + drift * merged.drift.at_s)) < 0.003);
    }
  }
  for (unsigned seed = 1; seed <= 6; ++seed)
    CHECK(gap::logs::merge_pose(robot_log(drive, seed), captured(drive, seed, {.offset_s = 1.5}), {}).drift.rate == 0);
}

TEST_CASE("The pose follows the drift of the clocks to both ends of the run") {
  // 1000 ppm: at 110 s the capture is 0.11 s off; at up to 0.8 rad/s one offset for all would be wrong by 44 mrad there
  const Drive drive = winding_drive(120);
  const DrivenPath path(drive);
  const auto merged = gap::logs::merge_pose(robot_log(drive, 3),
                                            captured(drive, 3, {.offset_s = -2, .noise = 0, .drift = 1000e-6}), {});
  const auto t = merged.run.column("t_s"), yaw = merged.run.column("yaw_rad");
  double worst_rad = 0;
  for (std::size_t i = 0; i < t.size(); ++i)
    if (!std::isnan(yaw[i]))
      worst_rad = std::max(worst_rad, std::abs(std::remainder(yaw[i] - path.at(t[i]).yaw_rad, 2 * std::numbers::pi)));
  CHECK(worst_rad < 0.004);
}

TEST_CASE("A run whose pose was merged by one offset, although the clocks drift, is warned of") {
  const Drive drive = winding_drive(60);
  const auto warnings = [&](double rate) {
    // merged as if both clocks had the same speed: at both ends the pose is 30 s of drift off
    const auto run =
        gap::logs::merge_pose(robot_log(drive, 3), captured(drive, 3, {.drift = rate}), {.drift = 0.0}).run;
    std::vector<std::string> found;
    for (const auto& finding : gap::logs::check_run(run, "run.csv", nullptr))
      if (finding.text.find("clock drifts") != std::string::npos) found.push_back(finding.text);
    return found;
  };
  CHECK(warnings(0).empty());
  const auto found = warnings(1000e-6);  // 60 ms over the run
  REQUIRE(found.size() == 1);
  CHECK_THAT(found[0], Catch::Contains("ppm") && Catch::Contains("merge the pose again"));
}

TEST_CASE("A given drift is taken as it is, from the run's first row on if the offset is given too") {
  const Drive drive = winding_drive(30);
  const auto run = robot_log(drive, 2);
  const auto capture = captured(drive, 2, {.offset_s = 1, .drift = 500e-6});
  const auto none = gap::logs::merge_pose(run, capture, {.drift = 0.0});
  CHECK(none.drift.rate == 0);
  CHECK(none.drift.offset_s == none.offset.offset_s);
  const auto both = gap::logs::merge_pose(run, capture, {.offset_s = 1.0, .drift = 500e-6});
  CHECK(both.drift.rate == 500e-6);
  CHECK(both.drift.at_s == 0);
  CHECK(both.drift.offset_s == 1);
}

TEST_CASE("A capture whose frame is turned by 40 degrees and shifted gives the same columns") {
  const Drive drive = winding_drive();
  const runs::Run run = robot_log(drive, 4);
  const auto plain = gap::logs::merge_pose(run, captured(drive, 4, {.offset_s = 2}), {});
  const auto turned = gap::logs::merge_pose(
      run, captured(drive, 4, {.offset_s = 2, .frame_yaw_rad = 40 * kDegree, .frame_x_m = 5, .frame_y_m = -3}), {});
  CHECK(turned.offset.offset_s == Approx(plain.offset.offset_s).margin(1e-9));
  for (const char* name : {"x_m", "y_m", "z_m", "roll_rad", "pitch_rad", "yaw_rad"}) {
    const auto a = plain.run.column(name), b = turned.run.column(name);
    INFO(name);
    for (std::size_t i = 0; i < a.size(); ++i)
      REQUIRE((std::isnan(a[i]) ? std::isnan(b[i]) : a[i] == Approx(b[i]).margin(1e-7)));
  }
  const auto x = plain.run.column("x_m");
  const auto first =
      static_cast<std::size_t>(std::ranges::find_if(x, [](double v) { return !std::isnan(v); }) - x.begin());
  CHECK(x[first] == Approx(0).margin(1e-12));
  CHECK(plain.run.column("y_m")[first] == Approx(0).margin(1e-12));
  CHECK(plain.run.column("yaw_rad")[first] == Approx(0).margin(1e-12));
  CHECK(plain.run.column("z_m")[first] == Approx(0.09));
}

TEST_CASE("Nothing is made up where the capture has a gap, nor before and after it") {
  const Drive drive = winding_drive();
  const runs::Run run = robot_log(drive, 1);
  gap::logs::MotionCapture capture = captured(drive, 1, {.from_s = 2, .to_s = 18});
  std::erase_if(capture.poses, [](const gap::logs::CapturedPose& pose) { return pose.t_s > 7 && pose.t_s < 8; });
  for (const auto& [max_gap_s, filled] : {std::pair{0.02, false}, {1.5, true}}) {
    const auto merged = gap::logs::merge_pose(run, capture, {.offset_s = 0, .max_gap_s = max_gap_s});
    const auto t = merged.run.column("t_s"), x = merged.run.column("x_m");
    for (std::size_t i = 0; i < t.size(); ++i) {
      if (t[i] < 1.99 || t[i] > 18.01) REQUIRE(std::isnan(x[i]));
      if (t[i] > 7.01 && t[i] < 7.99) REQUIRE(std::isnan(x[i]) == !filled);
    }
  }
}

TEST_CASE("A pose that the run has is kept under another name, what the capture did not measure stays") {
  const Drive drive = winding_drive();
  runs::Run run = robot_log(drive, 1);
  run.columns.insert(run.columns.end(), {"x_m", "y_m", "pitch_rad"});
  const std::size_t rows = run.row_count();
  run.values.insert(run.values.end(), {std::vector<double>(rows, 7.0),
                                       std::vector<double>(rows, std::numeric_limits<double>::quiet_NaN()),
                                       std::vector<double>(rows, 0.25)});
  gap::logs::MotionCapture capture = captured(drive, 1, {});
  capture.has_tilt = false;
  const auto merged = gap::logs::merge_pose(run, capture, {});
  CHECK(merged.renamed == std::vector<std::pair<std::string, std::string>>{{"x_m", "recorded_x_m"}});
  CHECK(merged.run.column("recorded_x_m")[9] == 7.0);
  CHECK(merged.run.column("recorded_y_m").empty());
  CHECK(merged.run.column("pitch_rad")[9] == 0.25);
  CHECK(std::abs(merged.run.column("x_m")[9]) < 0.1);
  CHECK_THROWS_WITH(gap::logs::merge_pose(merged.run, capture, {}), Catch::Contains("merged before"));
}

TEST_CASE("A motion capture's columns: angles, quaternions in any order, millimetres, degrees") {
  const auto read = [](const std::string& text, gap::logs::LengthUnit unit = gap::logs::LengthUnit::metres) {
    return gap::logs::parse_motion_capture(text, "m.csv", unit);
  };
  // Half a turn to the left is yaw 90 degrees: qw = qz = sqrt(1/2).
  const auto angles =
      read("t_s,x_m,y_m,z_m,roll_rad,pitch_rad,yaw_rad\n0,1,2,3,0,0,1.5707963267948966\n1,1,2,3,0,0,0\n");
  for (const auto& same : {read("t_s,qw,qx,qy,qz,x_m,y_m,z_m\n0,0.70710678,0,0,0.70710678,1,2,3\n1,1,0,0,0,1,2,3\n"),
                           read("z_mm,y_mm,x_mm,qx,qy,qz,qw,t_s\n3000,2000,1000,0,0,0.70710678,0.70710678,0\n"
                                "3000,2000,1000,0,0,0,1,1\n"),
                           read("t_s,x_m,y_m,z_m,roll_deg,pitch_deg,yaw_deg\n0,1000,2000,3000,0,0,90\n1,1,2,3,0,0,0\n",
                                gap::logs::LengthUnit::millimetres)}) {
    REQUIRE(same.poses.size() == 2);
    CHECK((same.poses[0].p_m - Eigen::Vector3d(1, 2, 3)).norm() < 1e-12);
    CHECK(same.poses[0].q.angularDistance(angles.poses[0].q) < 1e-7);
    CHECK((same.has_z && same.has_tilt));
  }
  // A row that lacks a part is no measurement.
  CHECK(read("t_s,x_m,y_m,yaw_rad\n0,0,0,0\n1,,0,0\n2,1,1,1\n3,1,1,\n").poses.size() == 2);

  CHECK_THROWS_WITH(read("t_s,x_m,y_m\n0,0,0\n1,1,1\n"), Catch::Contains("m.csv:1:1: contains neither yaw_rad nor qx"));
  CHECK_THROWS_WITH(read("t_s,x_m,yaw_rad\n0,0,0\n1,1,1\n"), Catch::Contains("no column y_m"));
  CHECK_THROWS_WITH(read("t_s,x_m,x_mm,y_m,yaw_rad\n0,0,0,0,0\n"), Catch::Contains("both x_m and x_mm"));
  CHECK_THROWS_WITH(read("t_s,x_m,y_m,qx,qy,qz,qw\n0,0,0,0,0,0,1\n1,0,0,0,0,0,0\n"),
                    Catch::Contains("m.csv:3:1: qx, qy, qz, qw are not a rotation"));
  CHECK_THROWS_WITH(read("t_s,x_m,y_m,yaw_rad\n0,0,0,0\n"), Catch::Contains("fewer than two rows"));
}

TEST_CASE("The command merge writes a whole run, says the offset and its error, and replaces nothing unasked") {
  const test::TemporaryFolder folder;
  const Drive drive = winding_drive();
  const auto write = [&](const std::string& name, const runs::Run& run) {
    runs::RunWriter writer(folder / name, run.columns);
    for (std::size_t i = 0; i < run.row_count(); ++i) {
      std::vector<double> row;
      for (const auto& column : run.values) row.push_back(column[i]);
      writer.add_row(row);
    }
    writer.finish();
  };
  write("run.csv", robot_log(drive, 1));
  runs::Run table{{"t_s", "x_m", "y_m", "qx", "qy", "qz", "qw"}, {}};
  table.values.resize(7);
  for (const auto& pose : captured(drive, 1, {.offset_s = 1.2345}).poses) {
    const double cells[] = {pose.t_s,   1000 * pose.p_m.x(), 1000 * pose.p_m.y(), pose.q.x(),
                            pose.q.y(), pose.q.z(),          pose.q.w()};
    for (std::size_t i = 0; i < 7; ++i) table.values[i].push_back(cells[i]);
  }
  write("mocap.csv", table);

  auto outcome = test::kenaf_gap(folder, "merge run.csv mocap.csv --out merged.csv");
  CHECK(outcome.status == 2);
  CHECK_THAT(outcome.error, Catch::Contains("give --mocap-units mm"));
  CHECK_FALSE(std::filesystem::exists(folder / "merged.csv"));

  outcome = test::kenaf_gap(folder, "merge run.csv mocap.csv --mocap-units mm --out merged.csv");
  INFO(outcome.error);
  REQUIRE(outcome.status == 0);
  CHECK_THAT(outcome.out, Catch::Matches("time offset: 1\\.23[0-9]+ s, standard error 0\\.00[0-9]+ s; (.|\n)*"));
  const runs::Run merged = runs::read_run(folder / "merged.csv");
  CHECK(merged.row_count() == 2001);
  CHECK(merged.column("z_m").empty());  // not captured
  const auto x = merged.column("x_m");
  // 18 s at 0.25 m/s on curves: metres, not millimetres
  CHECK(*std::ranges::max_element(x, [](double a, double b) { return !(a >= b) && !std::isnan(b); }) < 6);

  const std::string before = test::read_file(folder / "merged.csv");
  outcome = test::kenaf_gap(folder, "merge run.csv mocap.csv --offset 0 --mocap-units mm --out merged.csv");
  CHECK(outcome.status == 2);
  CHECK_THAT(outcome.error, Catch::Contains("merged.csv: exists already"));
  CHECK(test::read_file(folder / "merged.csv") == before);
  CHECK(
      test::kenaf_gap(folder, "merge run.csv mocap.csv --offset 0 --mocap-units mm --out merged.csv --force").status ==
      0);
  CHECK(test::read_file(folder / "merged.csv") != before);
  CHECK_FALSE(std::filesystem::exists(folder / "merged.csv.part"));
}
