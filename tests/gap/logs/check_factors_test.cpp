// Columns that are wrong by a factor between 1/20 and 20: named with the factor, and with the unit that it fits.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <memory>

#include "gap/logs/plausibility.hpp"
#include "gap/logs/scale_factor.hpp"
#include "gap/logs/unit_names.hpp"
#include "tests/gap/made_run.hpp"
#include "tests/gap/recorded_drive.hpp"

using namespace kenaf;
using gap::logs::Measure;

namespace {

const physics::RobotDescription& kenaf_robot() {
  static const physics::RobotDescription kenaf = physics::load_robot("kenaf");
  return kenaf;
}

// 12 s at 0.05 to 0.25 m/s on curves of up to 0.4 rad/s; the robot turns by 0.6 of what its belts differ by. Belts are
// commanded as they go. All but x and y have antiderivatives.
runs::Run curves() {
  const double gauge_m = kenaf_robot().track_gauge_m();
  const auto speed = [](double t) { return 0.15 + 0.1 * std::sin(0.8 * t); };
  const auto way = [](double t) { return 0.15 * t + 0.1 / 0.8 * (1 - std::cos(0.8 * t)); };
  const auto turn = [](double t) { return 0.4 * std::sin(1.1 * t); };
  const auto yaw = [](double t) { return 0.4 / 1.1 * (1 - std::cos(1.1 * t)); };
  const auto belt = [=](double side) { return [=](double t) { return speed(t) + side * gauge_m / 1.2 * turn(t); }; };
  const auto travel = [=](double side) { return [=](double t) { return way(t) + side * gauge_m / 1.2 * yaw(t); }; };
  const auto path = std::make_shared<test::DrivenPath>(test::Drive{speed, turn, 12});
  return test::made_run(12, 0.01,
                        {{"cmd_track_left_mps", belt(-1)},
                         {"cmd_track_right_mps", belt(1)},
                         {"track_left_mps", belt(-1)},
                         {"track_right_mps", belt(1)},
                         {"track_left_m", travel(-1)},
                         {"track_right_m", travel(1)},
                         {"x_m", [=](double t) { return path->at(t).x_m; }},
                         {"y_m", [=](double t) { return path->at(t).y_m; }},
                         {"yaw_rad", yaw},
                         {"gyro_z_radps", turn}});
}

const std::vector<std::string> kCommandColumns = {"cmd_track_left_mps", "cmd_track_right_mps"},
                               kSpeedColumns = {"track_left_mps", "track_right_mps"},
                               kTravelColumns = {"track_left_m", "track_right_m"}, kPlaceColumns = {"x_m", "y_m"},
                               kGyroColumn = {"gyro_z_radps"}, kYawColumn = {"yaw_rad"},
                               kTrackColumns = {"cmd_track_left_mps", "cmd_track_right_mps", "track_left_mps",
                                                "track_right_mps",    "track_left_m",        "track_right_m"};

runs::Run with_factor(runs::Run run, const std::vector<std::string>& names, double factor) {
  for (const std::string& name : names)
    for (double& value :
         run.values[static_cast<std::size_t>(std::ranges::find(run.columns, name) - run.columns.begin())])
      value *= factor;
  return run;
}

runs::Run without_columns(runs::Run run, const std::vector<std::string>& names) {
  return with_factor(std::move(run), names, std::nan(""));
}

std::string findings_in(const runs::Run& run, const physics::RobotDescription* robot = &kenaf_robot()) {
  std::string text;
  for (const auto& finding : gap::logs::check_run(run, "run.csv", robot))
    text += (finding.severity == gap::logs::Finding::Severity::refuse ? "" : "warning: ") +
            gap::logs::in_words(finding) + "\n";
  return text;
}

}  // namespace

TEST_CASE("A column in another unit is named with its factor, between a twentieth and twenty") {
  CHECK(findings_in(curves()) == "");
  struct Case {
    std::vector<std::string> columns;
    const char* named;
  };
  for (const Case& each : {Case{kSpeedColumns, "track_left_mps"},
                           {kTravelColumns, "track_left_m"},
                           {kCommandColumns, "cmd_track_left_mps"},
                           {kTrackColumns, "track_left_mps"},
                           {kPlaceColumns, "x_m"},
                           {kGyroColumn, "gyro_z_radps"},
                           {kYawColumn, "yaw_rad"}})
    for (const double factor : {0.0526, 0.1, 0.2, 0.33, 3.0, 4.5, 7.0, 12.0, 14.9}) {
      const std::string text = findings_in(with_factor(curves(), each.columns, factor));
      INFO(each.named << " times " << factor << ": " << text);
      CHECK_THAT(text, Catch::Contains(std::string("run.csv: ") + each.named + ": is "));
      CHECK_THAT(text, Catch::Contains(fmt::format("is {:.3g} (standard error", factor)));
      // belts that slip all the time carry a robot a third or a fifth of their way
      const bool may_slip = (each.columns == kTrackColumns && factor > 1 && factor < 5) ||
                            (each.columns == kPlaceColumns && factor < 1 && factor > 0.2);
      CHECK_THAT(text, Catch::StartsWith(may_slip ? "warning" : "run.csv"));
    }
}

TEST_CASE("A factor that fits a unit is named with it and with what to do") {
  struct Case {
    std::vector<std::string> columns;
    double factor;
    const char* words;
  };
  const double sprocket_m = kenaf_robot().drive.sprocket_radius_m;
  REQUIRE(sprocket_m == 0.065);
  for (const Case& each :
       {Case{kTrackColumns, 1 / sprocket_m, "rad/s of the sprocket, whose radius is 0.065 m: multiply by 0.065"},
        {kSpeedColumns, 1 / sprocket_m, "rad/s of the sprocket, whose radius is 0.065 m: multiply by 0.065"},
        {kCommandColumns, 1 / sprocket_m, "rad/s of the sprocket"},
        {kTravelColumns, 1 / sprocket_m, "rad of the sprocket"},
        {kTrackColumns, 3.6, "km/h: divide by 3.6"},
        {kCommandColumns, 3.6, "km/h: divide by 3.6"},
        {kSpeedColumns, 1 / 3.6, "a conversion from km/h that was made twice: multiply by 3.6"},
        {kTravelColumns, 3.28084, "feet: divide by 3.2808"},
        {kPlaceColumns, 10, "decimetres: divide by 10"},
        {kGyroColumn, 9.54930, "rpm: divide by 9.5493"},
        {kYawColumn, 0.159155, "turns: divide by 0.15915"}}) {
    INFO(each.words);
    CHECK_THAT(findings_in(with_factor(curves(), each.columns, each.factor)), Catch::Contains(each.words));
  }
}

TEST_CASE("One track alone in another unit is named, the other one not") {
  const std::string text = findings_in(with_factor(curves(), {"track_right_mps"}, 3.6));
  CHECK_THAT(text, Catch::StartsWith("run.csv: track_right_mps: is 3.6 ") && !Catch::Contains("track_left"));
}

TEST_CASE("Without a robot's description a factor is found too, and a sprocket only supposed") {
  CHECK(findings_in(curves(), nullptr) == "");
  CHECK_THAT(findings_in(with_factor(curves(), kTrackColumns, 10), nullptr), Catch::Contains("track_left_mps: is 10 "));
  CHECK_THAT(findings_in(with_factor(curves(), kSpeedColumns, 8), nullptr),
             Catch::Contains("rad/s of a sprocket with a radius of 0.125 m: multiply by its radius"));
  // without a pose nothing tells which of two is right
  const runs::Run no_pose =
      without_columns(without_columns(with_factor(curves(), kTravelColumns, 4), kPlaceColumns), kCommandColumns);
  CHECK_THAT(findings_in(no_pose, nullptr),
             Catch::Contains("track_left_m: is 4 ") && Catch::Contains("one of the two has a wrong unit or scale"));
}

TEST_CASE("Slip, lag, gains of drives and limits are no wrong units") {
  // the robot goes 0.6 and turns 0.5 of what it did
  CHECK(findings_in(with_factor(curves(), kPlaceColumns, 0.6)) == "");
  CHECK(findings_in(with_factor(curves(), {"yaw_rad", "gyro_z_radps"}, 0.5)) == "");
  // a gyro of 0.8, drives that do 0.6 of what is commanded or 1.4
  CHECK(findings_in(with_factor(curves(), kGyroColumn, 0.8)) == "");
  CHECK(findings_in(with_factor(curves(), kCommandColumns, 1 / 0.6)) == "");
  CHECK(findings_in(with_factor(curves(), kCommandColumns, 1 / 1.4)) == "");
  // commands of 0.5 m/s for drives that do 0.1 at most
  runs::Run limited = curves();
  for (const std::string& name : kCommandColumns)
    for (double& value :
         limited.values[static_cast<std::size_t>(std::ranges::find(limited.columns, name) - limited.columns.begin())])
      value = 0.5;
  CHECK(findings_in(limited) == "");
}

TEST_CASE("A scale factor withstands false samples, and its standard error is that of the noise") {
  // second: 1 to 3 units/s; first: 2.5 times that, but each tenth second it is 40 for two rows.
  gap::logs::Course first{{}, {}, 1}, second{{}, {}, 1};
  double a = 0, b = 0;
  for (int i = 0; i < 2000; ++i) {
    const double rate = 2 + std::sin(0.01 * i);
    a += 0.01 * (i % 1000 < 2 ? 40 : 2.5 * rate), b += 0.01 * rate;
    first.t_s.push_back(0.01 * i), second.t_s.push_back(0.01 * i);
    first.value.push_back(a), second.value.push_back(b);
  }
  const auto factor = gap::logs::scale_factor(first, second);
  REQUIRE(factor);
  CHECK(factor->factor == Approx(2.5).epsilon(0.001));
  CHECK(is_certain(factor));
  CHECK_FALSE(gap::logs::scale_factor(first, {second.t_s, std::vector<double>(2000, 1.0), 1}));

  // with opposite signs there is none
  for (double& value : second.value) value = -value;
  CHECK_FALSE(gap::logs::scale_factor(first, second));
}

TEST_CASE("Names of units: the nearest within the tolerance, else a sprocket that would fit, else none") {
  const auto words = [](Measure measure, double factor, double tolerance) {
    const auto name = gap::logs::unit_name(measure, factor, tolerance, std::nullopt);
    return name ? (name->is_known ? "" : "perhaps ") + name->words : "";
  };
  CHECK(words(Measure::belt_speed, 3.58, 0) == "km/h: divide by 3.6");
  CHECK(words(Measure::belt_speed, 3.3, 0) == "ft/s: divide by 3.2808");
  CHECK(words(Measure::belt_speed, 8, 0) ==
        "perhaps rad/s of a sprocket with a radius of 0.125 m: multiply by its radius");
  CHECK(words(Measure::angle, 57, 0) == "degrees: divide by 57.296");
  CHECK(words(Measure::angle, 5, 0) == "");
  CHECK(words(Measure::place, 1.5, 0) == "");
}
