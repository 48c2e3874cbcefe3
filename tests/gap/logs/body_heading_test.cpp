// A pose in another frame than the heading, seen over all runs of a log.
#include "gap/logs/body_heading.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <numbers>

#include "formats/runs/dataset.hpp"
#include "tests/gap/recorded_drive.hpp"

using namespace kenaf;
using Severity = gap::logs::Finding::Severity;

namespace {

// A drive of 20 s on curves to the left, by 10 rad, as the robot and a pose of 100 Hz measured it.
runs::Run seen_drive(unsigned seed) {
  const test::Drive drive{[](double t) { return 0.25 + 0.1 * std::sin(0.7 * t); },
                          [](double t) { return 0.5 + 0.3 * std::sin(0.9 * t); }, 20};
  const test::DrivenPath path(drive);
  runs::Run run = test::robot_log(drive, seed, false);
  for (const char* name : {"x_m", "y_m", "yaw_rad"}) run.columns.emplace_back(name), run.values.emplace_back();
  for (const double t_s : run.values[0]) {
    const test::PlanarPose pose = path.at(t_s);
    run.values[3].push_back(pose.x_m);
    run.values[4].push_back(pose.y_m);
    run.values[5].push_back(pose.yaw_rad);
  }
  return run;
}

std::vector<gap::logs::Finding> findings(double y_sign, double off_rad, const std::vector<runs::Run>& runs) {
  gap::logs::BodyHeading heading;
  for (runs::Run run : runs) {
    const auto values = [&run](std::string_view name) -> std::vector<double>& {
      return run.values[static_cast<std::size_t>(std::ranges::find(run.columns, name) - run.columns.begin())];
    };
    for (double& y : values("y_m")) y *= y_sign;
    for (double& yaw : values("yaw_rad")) yaw += off_rad;
    heading.look_at(run);
  }
  return heading.findings();
}

}  // namespace

TEST_CASE("A y that is mirrored against the heading is refused, a heading beside the front by its angle") {
  const std::vector<runs::Run> drives{seen_drive(1), seen_drive(2)};
  CHECK(findings(1, 0, drives).empty());
  const auto mirrored = findings(-1, 0, drives);
  REQUIRE(mirrored.size() == 1);
  CHECK(mirrored[0].severity == Severity::refuse);
  CHECK_THAT(in_words(mirrored[0]), Catch::StartsWith("dataset.toml: y_m: is mirrored against yaw_rad"));

  // a yaw that is 0.5 rad, 29 degrees, further left than the front: the way goes as much further right
  const auto odd = findings(1, 0.5, drives);
  REQUIRE(odd.size() == 1);
  CHECK(odd[0].severity == Severity::warn);
  CHECK_THAT(odd[0].text, Catch::Contains("29 degrees further right") && Catch::Contains("add -0.5 rad"));
  const auto wrong = findings(1, -std::numbers::pi / 2, drives);
  REQUIRE(wrong.size() == 1);
  CHECK(wrong[0].severity == Severity::refuse);
  CHECK_THAT(wrong[0].text, Catch::Contains("90 degrees further left") && Catch::Contains("add 1.57 rad"));
  CHECK(findings(1, 0.2, drives).empty());  // 11 degrees
}

TEST_CASE("A pose of a point ahead of the one about which the robot turns has the right heading nevertheless") {
  // 0.3 m ahead the pose goes sideways with 0.3 m times the turn rate: on these curves 31 degrees from ahead
  std::vector<runs::Run> drives{seen_drive(1), seen_drive(2)};
  for (runs::Run& run : drives)
    for (std::size_t i = 0; i < run.row_count(); ++i) {
      run.values[3][i] += 0.3 * std::cos(run.values[5][i]);
      run.values[4][i] += 0.3 * std::sin(run.values[5][i]);
    }
  CHECK(findings(1, 0, drives).empty());
  CHECK(findings(1, 0.5, drives).size() == 1);
}

TEST_CASE("A single short run, a robot in the air and a drive straight on tell nothing of frames") {
  runs::Run brief = seen_drive(1);
  for (auto& values : brief.values) values.resize(600);
  CHECK(findings(1, 1, {brief}).empty());
  runs::Run lifted = seen_drive(1);
  for (std::size_t c = 3; c < 6; ++c)
    for (std::size_t i = 0; i < lifted.row_count(); ++i) lifted.values[c][i] = 0.002 * std::sin(0.3 * double(i * c));
  CHECK(findings(1, 1, {lifted, lifted}).empty());
  runs::Run straight = seen_drive(1);
  for (std::size_t i = 0; i < straight.row_count(); ++i) {
    straight.values[3][i] = 0.2 * straight.values[0][i];
    straight.values[1][i] = straight.values[2][i] = 0.2;
    straight.values[4][i] = straight.values[5][i] = 0;
  }
  CHECK(findings(-1, 0, {straight, straight}).empty());
}

TEST_CASE("Runs of a real robot in a forest are mirrored where their y is, and right as they are") {
  const char* folder = std::getenv("KENAF_MARMOTTE_DATA");
  if (folder == nullptr) {
    WARN("skipped: KENAF_MARMOTTE_DATA does not name the folder of the recorded runs");
    return;
  }
  std::vector<runs::Run> recorded;
  for (const auto& run : runs::read_dataset(folder).runs)
    recorded.push_back(runs::read_run(std::filesystem::path(folder) / run.file));
  CHECK(findings(1, 0, recorded).empty());
  const auto mirrored = findings(-1, 0, recorded);
  REQUIRE(mirrored.size() == 1);
  CHECK(gap::logs::any_refused(mirrored));
  const auto wrong = findings(1, 1, recorded);
  REQUIRE(wrong.size() == 1);
  CHECK(gap::logs::any_refused(wrong));
}
