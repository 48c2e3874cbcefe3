// Phases of a run that was made by hand.
#include "gap/diagnose/phases.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/gap/made_run.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::diagnose;

namespace {

std::vector<std::string> names(const std::vector<PhaseSpan>& spans) {
  std::vector<std::string> names;
  for (const PhaseSpan& span : spans) names.emplace_back(span.name);
  return names;
}

std::vector<PhaseSpan> phases(double duration_s, const std::vector<test::ColumnOfTime>& columns) {
  Observation observation{};
  observation.run = test::made_run(duration_s, 0.01, columns);
  return phases_of(observation);
}

test::ColumnOfTime constant(const std::string& name, double value) {
  return {name, [value](double) { return value; }};
}

// Straight lines between corners, the ends holding.
std::function<double(double)> polyline(std::vector<std::pair<double, double>> corners) {
  return [corners](double t_s) {
    if (t_s <= corners.front().first) return corners.front().second;
    for (std::size_t i = 1; i < corners.size(); ++i)
      if (t_s < corners[i].first)
        return std::lerp(corners[i - 1].second, corners[i].second,
                         (t_s - corners[i - 1].first) / (corners[i].first - corners[i - 1].first));
    return corners.back().second;
  };
}

}  // namespace

TEST_CASE("Stands, speeds up, cruises, touches, climbs, tips over the edge, lands, cruises and stops") {
  const auto command = [](double t_s) { return t_s > 0.995 && t_s < 7.995 ? 0.3 : 0.0; };
  // nose up by 0.4 rad between 3 and 4 s, down to level in 0.2 s from 5 s on: 2 rad/s
  const auto pitch = polyline({{3, 0}, {4, -0.4}, {5, -0.4}, {5.2, 0}});
  const auto x = polyline({{1, 0}, {8, 2.1}});
  const std::vector<PhaseSpan> spans = phases(9, {{"cmd_track_left_mps", command},
                                                  {"cmd_track_right_mps", command},
                                                  {"x_m", x},
                                                  constant("y_m", 0.5),
                                                  constant("z_m", 0.1),
                                                  {"pitch_rad", pitch}});
  CHECK(names(spans) == std::vector<std::string>{"stand", "speed change", "cruise", "contact", "climb", "tip", "land",
                                                 "cruise", "slow down", "stand"});
  REQUIRE(spans.size() == 10);
  // 0.06 rad, where an incline counts, is reached at 3.15 s; the rate, seen over 0.2 s, is 0.6 rad/s at 5 s - 0.1 s +
  // 0.06 s
  const double began_s[] = {0, 1, 1.3, 3.05, 3.25, 4.95, 5.25, 5.65, 8, 8.3};
  for (std::size_t i = 0; i < spans.size(); ++i) {
    INFO(spans[i].name);
    CHECK(spans[i].from_s == Approx(began_s[i]).margin(0.101));  // two steps of the grid
    CHECK(spans[i].to_s == Approx(i + 1 < spans.size() ? spans[i + 1].from_s : 8.99));
  }
  CHECK(spans[2].x_m == Approx(x((spans[2].from_s + spans[2].to_s) / 2)).margin(0.016));  // a step at 0.3 m/s
  CHECK(spans[2].y_m == 0.5);
}

TEST_CASE("One belt faster than the other by a third is a turn, backwards is a cruise") {
  const auto tracks = [](double left, double right) {
    return phases(2, {constant("cmd_track_left_mps", left), constant("cmd_track_right_mps", right)}).back().name;
  };
  CHECK(tracks(-0.2, 0.2) == "turn");
  CHECK(tracks(0.2, 0.3) == "turn");
  CHECK(tracks(0.27, 0.3) == "cruise");
  CHECK(tracks(-0.3, -0.3) == "cruise");
  CHECK(tracks(0, 0) == "stand");
}

TEST_CASE("A robot that rolls on after a stop does not stand yet") {
  // told to stop at 2 s; from 0.4 m/s at 0.2 m/s2 the belts are at a tenth of it 1.8 s later
  const auto asked = [](double t_s) { return t_s < 1.995 ? 0.4 : 0.0; };
  const auto belts = polyline({{2, 0.4}, {4, 0}});
  const std::vector<PhaseSpan> spans = phases(6, {{"cmd_track_left_mps", asked},
                                                  {"cmd_track_right_mps", asked},
                                                  {"track_left_mps", belts},
                                                  {"track_right_mps", belts}});
  CHECK(names(spans) == std::vector<std::string>{"cruise", "slow down", "stand"});
  CHECK(spans[1].from_s == Approx(2).margin(0.051));
  CHECK(spans[1].to_s == Approx(3.8).margin(0.051));
}

TEST_CASE("A robot pushed while it stands stands") {
  const auto pushed = [](double t_s) { return t_s > 2 && t_s < 3 ? 0.1 : 0.0; };
  const std::vector<PhaseSpan> spans = phases(4, {constant("cmd_track_left_mps", 0),
                                                  constant("cmd_track_right_mps", 0),
                                                  {"track_left_mps", pushed},
                                                  {"track_right_mps", pushed}});
  CHECK(names(spans) == std::vector<std::string>{"stand"});
}

TEST_CASE("A run that begins with an order to go begins by speeding up, unless its belts run already") {
  const auto first = [](double measured_mps) {
    return phases(2, {constant("cmd_track_left_mps", 0.3),
                      constant("cmd_track_right_mps", 0.3),
                      {"track_left_mps", [=](double t_s) { return t_s < 0.1 ? measured_mps : 0.3; }},
                      {"track_right_mps", [=](double t_s) { return t_s < 0.1 ? measured_mps : 0.3; }}});
  };
  CHECK(names(first(0)) == std::vector<std::string>{"speed change", "cruise"});
  CHECK(first(0)[1].from_s == Approx(0.3).margin(0.051));
  CHECK(names(first(0.3)) == std::vector<std::string>{"cruise"});
}

TEST_CASE("Flippers that are on their way while the robot stands") {
  const auto asked = [](double t_s) { return t_s > 0.495 ? 1.0 : 0.0; };
  const auto is = polyline({{0.5, 0}, {1.5, 1}});
  const std::vector<PhaseSpan> spans = phases(3, {constant("cmd_track_left_mps", 0),
                                                  constant("cmd_track_right_mps", 0),
                                                  {"cmd_flipper_fl_rad", asked},
                                                  {"flipper_fl_rad", is}});
  CHECK(names(spans) == std::vector<std::string>{"stand", "flippers", "stand"});
  CHECK(spans[1].from_s == Approx(0.5).margin(0.051));
  CHECK(spans[1].to_s == Approx(1.48).margin(0.051));
  CHECK(std::isnan(spans[1].x_m));
}

TEST_CASE("A fall, and the landing after it") {
  // 0.2 m at 0.5 m/s
  const std::vector<PhaseSpan> spans = phases(3, {constant("cmd_track_left_mps", 0),
                                                  constant("cmd_track_right_mps", 0),
                                                  {"z_m", polyline({{1, 0.3}, {1.4, 0.1}})}});
  CHECK(names(spans) == std::vector<std::string>{"stand", "fall", "land", "stand"});
  CHECK(spans[1].from_s == Approx(1).margin(0.101));
  CHECK(spans[2].from_s == Approx(1.4).margin(0.101));
  CHECK(spans[3].from_s == Approx(1.8).margin(0.101));
}

TEST_CASE("Nose down is a descent, what stood on a slope at the start is level to it") {
  const auto going = constant("cmd_track_left_mps", 0.3), too = constant("cmd_track_right_mps", 0.3);
  CHECK(phases(3, {going, too, {"pitch_rad", polyline({{1, 0}, {2, 0.3}})}}).back().name == "descend");
  CHECK(phases(3, {going, too, constant("pitch_rad", -0.2)}).back().name == "cruise");
}

TEST_CASE("Phases follow each other without gaps, none shorter than a tenth of a second") {
  const auto jerky = [](double t_s) { return 0.3 * std::sin(9 * t_s); };
  const auto pitch = [](double t_s) { return 0.1 * std::sin(7 * t_s) + 0.05 * std::sin(31 * t_s); };
  const std::vector<PhaseSpan> spans =
      phases(10, {{"cmd_track_left_mps", jerky}, {"cmd_track_right_mps", jerky}, {"pitch_rad", pitch}});
  CHECK(spans.front().from_s == 0);
  CHECK(spans.back().to_s == Approx(9.99));
  for (std::size_t i = 0; i < spans.size(); ++i) {
    if (i > 0) CHECK(spans[i].from_s == Approx(spans[i - 1].to_s));
    CHECK(spans[i].to_s - spans[i].from_s > 0.1 - 1e-9);
  }
}
