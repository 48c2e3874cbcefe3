// Which manoeuvre to drive next: the gentlest and shortest that suffices, and what it risks.
#include "gap/diagnose/next_manoeuvre.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <numbers>

#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/prediction.hpp"
#include "gap/diagnose/separation.hpp"
#include "tests/gap/made_run.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::diagnose;
using Catch::Contains;

namespace {

physics::RobotDescription kenaf_with(std::string_view effect) {
  physics::RobotDescription robot = physics::load_robot("kenaf");
  physics::set_effect(robot.effects, effect);
  return robot;
}

RivalModel rival(std::string_view effect, std::string_view moved) {
  return {kenaf_with(effect), {kenaf_with(moved)}};
}

// Twice the resolution of each channel.
ProposalOptions options(double suffices_at = kSuffices) {
  ProposalOptions options{.sigma_of_channel = {}, .span_s = 0.1, .suffices_at = suffices_at, .threads = 0};
  for (const Channel& channel : diagnosis_channels()) options.sigma_of_channel.push_back(2 * channel.resolution);
  return options;
}

// The robot drives ahead at `speed_mps` with its nose at `pitch_rad`, its height a function of time.
rollout::RollOut made(double speed_mps, double pitch_rad, const std::function<double(double)>& z_m) {
  rollout::RollOut out;
  out.run = test::made_run(2, 0.01,
                           {{"x_m", [=](double t_s) { return speed_mps * t_s; }},
                            {"y_m", [](double) { return 0; }},
                            {"z_m", z_m},
                            {"yaw_rad", [](double) { return 0; }},
                            {"roll_rad", [](double) { return 0; }},
                            {"pitch_rad", [=](double) { return pitch_rad; }}});
  return out;
}

}  // namespace

TEST_CASE(
    "Separation: what directions cannot take up, and that a bin far out counts as three and pulls nothing along") {
  Eigen::VectorXd difference(4);
  difference << 2, 2, 1, 0;
  CHECK(separation(difference, Eigen::MatrixXd(4, 0)) == Approx(3));  // sqrt(4 + 4 + 1)
  Eigen::MatrixXd along(4, 1);
  along << 5, 5, 0, 0;
  CHECK(separation(difference, along) == Approx(1));
  Eigen::MatrixXd twice(4, 3);
  twice << along, 2 * along, Eigen::VectorXd::Zero(4);
  CHECK(separation(difference, twice) == Approx(1));

  difference << 54740, 0, 0, 0;
  CHECK(separation(difference, Eigen::MatrixXd(4, 0)) == Approx(kOfOneBin));

  // A change that takes up 100 standard deviations in each of 100 bins is no separation, whatever the cap. With one bin
  // far off it: Huber's loss pulls by at most 3 there, so 99 bins are left with 3 / 99 each, 0.30 together.
  Eigen::VectorXd shifted = Eigen::VectorXd::Constant(100, 100);
  const Eigen::MatrixXd level = Eigen::VectorXd::Ones(100);
  CHECK(separation(shifted, level) == Approx(0).margin(1e-6));
  shifted[7] = 54740;
  CHECK(separation(shifted, level) == Approx(std::sqrt(9 + 9.0 / 99)).margin(1e-4));
}

TEST_CASE("Risk: down a slope on its tracks nothing falls, off an edge it does") {
  const physics::RobotDescription robot = physics::load_robot("kenaf");
  const rollout::Manoeuvre manoeuvre;
  const double slope_rad = 20 * std::numbers::pi / 180;
  const Risk down =
      risk_of(made(0.2, slope_rad, [=](double t_s) { return 1 - 0.2 * t_s * std::tan(slope_rad); }), manoeuvre, robot);
  CHECK(down.largest_tilt_rad == Approx(slope_rad));
  CHECK(down.fall_m == Approx(0).margin(1e-9));
  CHECK(down.impact_mps2 == Approx(0).margin(1e-6));
  CHECK_FALSE(down.fails);

  // Free fall over 50 mm takes 0.101 s and ends at 0.990 m/s: stopped within a row, that is a mean of 0.99 / 0.02
  // = 49.5 m/s^2 over 40 ms at the most, and rows of 10 ms around it see most of it.
  const Risk falls = risk_of(made(0.2, 0, [](double t_s) { return std::max(0.0, 0.05 - 0.5 * 9.80665 * t_s * t_s); }),
                             manoeuvre, robot);
  CHECK(falls.fall_m == Approx(0.05));
  CHECK(falls.impact_mps2 > 35);
  CHECK(falls.impact_mps2 < 49.5);

  const Risk over = risk_of(made(0, std::numbers::pi * 0.6, [](double) { return 0.1; }), manoeuvre, robot);
  CHECK(over.fails);
  rollout::RollOut broken = made(0, 0, [](double) { return 0.1; });
  broken.fault = "it fell out of the world";
  CHECK(risk_of(broken, manoeuvre, robot).fails);
}

TEST_CASE("Risk: how gentle a manoeuvre is goes by ground, flippers and what may happen") {
  const rollout::Manoeuvre square = rollout::load_manoeuvre("square"), sweep = rollout::load_manoeuvre("flipper-sweep");
  const rollout::Manoeuvre drop = rollout::load_manoeuvre("drop");
  CHECK_FALSE(moves_flippers(square));
  CHECK(moves_flippers(sweep));
  CHECK_FALSE(moves_flippers(drop));  // they are set before it begins
  CHECK(gentleness(square, true, {}) == Gentleness::flat_driving);
  CHECK(gentleness(sweep, true, {}) == Gentleness::flat_flippers);
  CHECK(gentleness(square, false, {}) == Gentleness::low_obstacle);
  CHECK(gentleness(drop, true, {}) == Gentleness::falls_or_tilts);
  CHECK(gentleness(square, true, {.largest_tilt_rad = 0.5}) == Gentleness::falls_or_tilts);
  CHECK(gentleness(square, false, {.fall_m = 0.04}) == Gentleness::falls_or_tilts);
  CHECK(gentleness(square, true, {.stuck = true}) == Gentleness::flat_driving);
  CHECK(gentleness(square, false, {.stuck = true}) == Gentleness::falls_or_tilts);
  CHECK(gentleness(square, true, {.fails = true}) == Gentleness::fails);
  std::vector<std::string> ignored;
  CHECK(is_level(physics::load_world("flat", ignored)));
  CHECK_FALSE(is_level(physics::load_world("ramp-10", ignored)));
  CHECK_FALSE(is_level(physics::load_world("step-50", ignored)));
}

TEST_CASE("Two frictions are distinguished on flat ground, the shortest first, the same on any number of threads") {
  const std::vector<RivalModel> rivals{rival("friction_along:scale=0.8", "friction_along:scale=0.84"),
                                       rival("friction_across:scale=0.8", "friction_across:scale=0.84")};
  // Straight ahead neither friction is used up, so the shortest two manoeuvres that ship say nothing.
  const auto proposed = propose_manoeuvres(physics::load_robot("kenaf"), rivals, options());
  REQUIRE(proposed.size() >= 3);
  for (std::size_t i = 0; i < 3; ++i) {
    CAPTURE(in_words(proposed[i]));
    CHECK(proposed[i].suffices);
    CHECK(proposed[i].is_flat);
    CHECK(proposed[i].gentleness == Gentleness::flat_driving);
    CHECK(proposed[i].expected_score >= kSuffices);
    CHECK(proposed[i].risk.largest_tilt_rad < 0.02);
    CHECK(proposed[i].risk.current_share > 0.1);
    CHECK((i == 0 || proposed[i].duration_s >= proposed[i - 1].duration_s));
  }
  // No rougher class was tried.
  for (const ProposedManoeuvre& one : proposed) CHECK(one.gentleness == Gentleness::flat_driving);
  const auto straight = std::ranges::find(proposed, "straight", &ProposedManoeuvre::manoeuvre);
  REQUIRE(straight != proposed.end());
  CHECK_FALSE(straight->suffices);
  CHECK(straight->expected_score < 1);
  CHECK_THAT(advice_in_words(proposed), Catch::StartsWith("drive next: " + proposed.front().manoeuvre + " (") &&
                                            Contains("flat ground): separates them by") && Contains("no fall"));

  ProposalOptions one_thread = options();
  one_thread.threads = 1;
  const auto again = propose_manoeuvres(physics::load_robot("kenaf"), rivals, one_thread);
  REQUIRE(again.size() == proposed.size());
  for (std::size_t i = 0; i < again.size(); ++i) {
    CHECK(again[i].manoeuvre == proposed[i].manoeuvre);
    CHECK(again[i].expected_score == proposed[i].expected_score);
    CHECK(again[i].risk == proposed[i].risk);
  }
}

TEST_CASE("Rivals that are the same: no manoeuvre suffices, and it says so") {
  const std::vector<RivalModel> rivals{rival("friction_along:scale=0.8", "friction_along:scale=0.84"),
                                       {kenaf_with("friction_along:scale=0.8")}};
  const auto proposed = propose_manoeuvres(physics::load_robot("kenaf"), rivals, options());
  REQUIRE_FALSE(proposed.empty());
  for (const ProposedManoeuvre& one : proposed) {
    CHECK(one.expected_score == 0);
    CHECK_FALSE(one.suffices);
    // On the steps of 200 to 300 mm, on belts alone, the nominal robot falls on its back.
    CHECK(one.manoeuvre != "step-250");
  }
  CHECK_THAT(advice_in_words(proposed),
             Catch::StartsWith("none of the ") && Contains("none of them distinguishes these effects"));
  CHECK(propose_manoeuvres(physics::load_robot("kenaf"), std::span(rivals).first(1), options()).empty());
}

TEST_CASE("Obstacles come where flat ground tells nothing, and never one at which a rival falls over") {
  // On flat ground the height of obstacles plays no part at all. On a step it does, and the lower step is gentler.
  const std::vector<RivalModel> rivals{{kenaf_with("obstacle_height:offset_m=0.03")}, {kenaf_with("mass:scale=1")}};
  const auto proposed = propose_manoeuvres(physics::load_robot("kenaf"), rivals, options());
  REQUIRE_FALSE(proposed.empty());
  CHECK(proposed.front().suffices);
  CHECK_FALSE(proposed.front().is_flat);
  CHECK(proposed.front().gentleness == Gentleness::low_obstacle);
  CHECK_FALSE(proposed.front().risk.fails);
  for (const ProposedManoeuvre& one : proposed) {
    CAPTURE(in_words(one));
    if (one.is_flat) CHECK(one.expected_score == 0);
    if (one.risk.fails) CHECK_FALSE(one.suffices);
    CHECK(one.gentleness <= Gentleness::falls_or_tilts);
  }
  // Gentler goes before more separating.
  for (std::size_t i = 1; i < proposed.size() && proposed[i].suffices; ++i)
    CHECK(proposed[i].gentleness >= proposed[i - 1].gentleness);
}

TEST_CASE("What a rival falls over at is not sufficient, and what is gentler goes before what is further apart") {
  // 15 of its 20 kg lie 0.1 m further back and higher, so that its centre of mass is 0.115 m above the belly and 0.15 m
  // ahead of the rear axle: beyond atan(0.15 / 0.115) = 53 degrees it turns over backwards. In one rival the step of 50
  // mm has 70 mm and does that to it. Nothing sets the rivals further apart, and it is no reason to go there.
  RivalModel higher{kenaf_with("obstacle_height:offset_m=0.02")}, as_thought{kenaf_with("mass:scale=1")};
  for (RivalModel* one : {&higher, &as_thought})
    for (const char* effect : {"com_up:offset_m=0.1", "com_forward:offset_m=-0.1"})
      physics::set_effect(one->fitted.effects, effect);
  const std::vector<RivalModel> rivals{higher, as_thought};
  const auto proposed = propose_manoeuvres(physics::load_robot("kenaf"), rivals, options());
  REQUIRE_FALSE(proposed.empty());
  CHECK(proposed.front().suffices);
  CHECK(proposed.front().gentleness == Gentleness::low_obstacle);
  CHECK(std::ranges::any_of(proposed, [&](const ProposedManoeuvre& one) {
    return one.suffices && one.gentleness > proposed.front().gentleness &&
           one.expected_score > proposed.front().expected_score;
  }));
  const auto step = std::ranges::find(proposed, "step-50", &ProposedManoeuvre::manoeuvre);
  REQUIRE(step != proposed.end());
  CHECK(step->risk.fails);
  CHECK(step->expected_score > kSuffices);
  CHECK_FALSE(step->suffices);
  CHECK(step->gentleness == Gentleness::fails);
  CHECK_THAT(in_words(*step), Contains("may turn over: do not drive it"));
  CHECK(std::all_of(step, proposed.end(), [](const ProposedManoeuvre& one) { return !one.suffices; }));
}

TEST_CASE("A proposal in words, and what it refuses") {
  const ProposedManoeuvre square{.manoeuvre = "square",
                                 .world = "flat",
                                 .duration_s = 20.4,
                                 .expected_score = 40.2,
                                 .suffices = true,
                                 .is_flat = true,
                                 .gentleness = Gentleness::flat_driving,
                                 .risk = {.largest_tilt_rad = 0.035, .current_share = 0.31}};
  CHECK(in_words(square) ==
        "square (20 s, flat ground): separates them by 40 standard deviations; tilts by 2 degrees, no fall, "
        "31 % of the stall current");
  ProposedManoeuvre step = square;
  step.manoeuvre = step.world = "step-150";
  step.is_flat = step.suffices = false;
  step.expected_score = 3.14;
  step.risk = {.largest_tilt_rad = 1.08, .fall_m = 0.123, .impact_mps2 = 69};
  CHECK(in_words(step) ==
        "step-150 (20 s, world step-150): separates them by 3.1 standard deviations, too little; tilts by 62 degrees, "
        "falls by 123 mm, lands with 69 m/s^2");
  CHECK(advice_in_words(std::span(&step, 1)) ==
        "none of the 1 shipped manoeuvres that this robot can drive suffices; the best of them: " + in_words(step));
  CHECK_THAT(advice_in_words({}), Contains("no effects to distinguish"));

  const std::vector<RivalModel> rivals{{kenaf_with("mass:scale=1.1")}, {kenaf_with("mass:scale=1")}};
  ProposalOptions wrong = options();
  wrong.sigma_of_channel.pop_back();
  CHECK_THROWS_WITH(propose_manoeuvres(rivals[0].fitted, rivals, wrong), Contains("sigma_of_channel"));
  wrong = options();
  wrong.span_s = 0;
  CHECK_THROWS_WITH(propose_manoeuvres(rivals[0].fitted, rivals, wrong), Contains("span_s"));
  const std::atomic<bool> stop = true;
  ProposalOptions stopped = options();
  stopped.stop = &stop;
  CHECK_THROWS_AS(propose_manoeuvres(rivals[0].fitted, rivals, stopped), Stopped);
}
