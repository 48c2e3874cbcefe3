// Which runs repeat each other, and how repeats differ.
#include "gap/diagnose/repeats.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "tests/gap/made_run.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::diagnose;

namespace {

using Groups = std::vector<std::vector<std::size_t>>;

// Commanded to go at `speed_mps` from `from_s` on, for 4 s in all.
Observation commanded(const std::string& manoeuvre, double speed_mps, double from_s = 0, double duration_s = 4) {
  Observation observation{};
  observation.manoeuvre = manoeuvre;
  for (int i = 0; i <= std::lround(duration_s / 0.1); ++i) {
    robot::Command command;
    if (i * 0.1 >= from_s) command.track_speed_mps = {speed_mps, speed_mps};
    observation.replay.timed.push_back({i * 0.1, command});
  }
  return observation;
}

Groups groups_of(std::vector<Observation> runs) {
  Observations observations;
  observations.runs = std::move(runs);
  return repeats_of(observations);
}

Groups same_command_sequence(std::vector<Observation> runs) {
  Observations observations;
  observations.runs = std::move(runs);
  return same_command_sequence_of(observations);
}

// Each order for a second.
Observation ordered(std::initializer_list<double> speeds_mps) {
  Observation observation{};
  observation.manoeuvre = "a";
  for (const double speed_mps : speeds_mps)
    for (int i = 0; i < 10; ++i)
      observation.replay.timed.push_back(
          {0.1 * static_cast<double>(observation.replay.timed.size()), {.track_speed_mps = {speed_mps, speed_mps}}});
  return observation;
}

std::vector<StageFeatures> lasting(std::initializer_list<double> durations_s) {
  std::vector<StageFeatures> features;
  for (const double duration_s : durations_s) {
    const runs::Run run = test::made_run(duration_s, 0.1, {{"x_m", [](double) { return 0.0; }}});
    features.push_back(stage_features(Passage::drive_to_body, FeatureMap(run, 0.25), run));
  }
  return features;
}

}  // namespace

TEST_CASE("Runs that begin in another motion do not repeat each other, whatever is commanded") {
  const auto begun = [](double left_mps, double right_mps) {
    Observation run = commanded("a", 0.8);
    run.replay.start.emplace();
    run.replay.start->motion.emplace().track_mps = {left_mps, right_mps};
    return run;
  };
  // as recorded: with the same commands, one comes out of driving backward, the other out of a turn
  CHECK(groups_of({begun(-0.59, -0.21), begun(0.58, -0.03)}) == Groups{{0}, {1}});
  CHECK(same_command_sequence({begun(-0.59, -0.21), begun(0.58, -0.03)}) == Groups{{0}, {1}});
  // 30 mm/s of noise in speeds at rest; and one that stands, to which nothing was added
  CHECK(groups_of({begun(0.03, -0.03), begun(-0.03, 0.03), commanded("a", 0.8)}) == Groups{{0, 1, 2}});
  CHECK(groups_of({begun(0.5, 0.5), commanded("a", 0.8)}) == Groups{{0}, {1}});
}

TEST_CASE("Runs of one name with the same commands repeat each other") {
  CHECK(groups_of({commanded("a", 0.3), commanded("b", 0.3), commanded("a", 0.3)}) == Groups{{0, 2}, {1}});
}

TEST_CASE("Runs of one name with other commands do not") {
  CHECK(groups_of({commanded("log", 0.3), commanded("log", -0.3), commanded("log", 0.1), commanded("log", 0.3)}) ==
        Groups{{0, 3}, {1}, {2}});
}

TEST_CASE("An order that comes a little later is the same order") {
  // 0.2 s of 4 s are 5 % of the commands; 2 s are half of them
  CHECK(groups_of({commanded("a", 0.3), commanded("a", 0.3, 0.2)}) == Groups{{0, 1}});
  CHECK(groups_of({commanded("a", 0.3), commanded("a", 0.3, 2)}) == Groups{{0}, {1}});
}

TEST_CASE("The same commands at other times, or one of them left out, are another outcome of the same manoeuvre") {
  CHECK(same_command_sequence({commanded("a", 0.3), commanded("a", 0.3, 2)}) == Groups{{0, 1}});
  CHECK(same_command_sequence({ordered({0, 0.2, 0.5, 0.1}), ordered({0, 0.5, 0.1}),
                               ordered({0, 0, 0, 0.2, 0.5, 0.1})}) == Groups{{0, 1, 2}});
  // in another order, or with an order that the other one never gave
  CHECK(same_command_sequence({ordered({0, 0.2, 0.5}), ordered({0, 0.5, 0.2})}) == Groups{{0}, {1}});
  CHECK(same_command_sequence({ordered({0, 0.2, 0.5}), ordered({0, 0.3, 0.5})}) == Groups{{0}, {1}});
  // a short log is not part of everything
  CHECK(same_command_sequence({ordered({0, 0.2, 0.5, 0.1, 0.4}), ordered({0, 0.4})}) == Groups{{0}, {1}});
}

TEST_CASE("The same commands on another world are another group") {
  Observation elsewhere = commanded("a", 0.3);
  elsewhere.world = 1;
  CHECK(groups_of({commanded("a", 0.3), elsewhere}) == Groups{{0}, {1}});
}

TEST_CASE("Other flipper commands make another group") {
  Observation folded = commanded("a", 0.3), flat = commanded("a", 0.3);
  for (auto& timed : folded.replay.timed)
    for (auto& flipper : timed.command.flipper) flipper.value = 1;
  CHECK(groups_of({folded, flat, folded}) == Groups{{0, 2}, {1}});
}

TEST_CASE("A run that was cut short repeats as far as it goes") {
  CHECK(groups_of({commanded("a", 0.3, 0, 4), commanded("a", 0.3, 0, 2)}) == Groups{{0, 1}});
}

TEST_CASE("Deviations are from the mean of the repeats, with the variance of one run") {
  const auto features = lasting({0.5, 0.5, 0.5});
  const std::vector<Eigen::VectorXd> residuals{Eigen::Vector2d(1, 5), Eigen::Vector2d(3, 5), Eigen::Vector2d(7, 7)};
  // of 1 and 3: mean 2, deviations -1 and 1, their variance 1; that of one run is n / (n - 1) = 2 times it
  const auto of_two = deviations_from_repeats(features, residuals, {{0, 1}, {2}});
  CHECK(of_two.of_runs[0][0] == Approx(-std::sqrt(2.0)));
  CHECK(of_two.of_runs[1][0] == Approx(std::sqrt(2.0)));
  CHECK(of_two.of_runs[1][1] == 0);
  CHECK(of_two.of_runs[2].size() == 0);
  const auto of_three = deviations_from_repeats(features, residuals, {{0, 1, 2}});
  CHECK(of_three.of_runs[2][0] == Approx((7 - 11.0 / 3) * std::sqrt(1.5)));
}

TEST_CASE("Deviations of noise have the noise's variance, for any number of repeats") {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal(0, 2);
  for (const std::size_t count : {2u, 3u, 5u}) {
    std::vector<StageFeatures> features;
    std::vector<Eigen::VectorXd> residuals;
    Groups group(1);
    double square = 0, bins = 0;
    for (std::size_t r = 0; r < count; ++r) {
      features.push_back(lasting({250}).front());
      residuals.push_back(Eigen::VectorXd::NullaryExpr(1000, [&] { return normal(random); }));
      group[0].push_back(r);
    }
    for (const Eigen::VectorXd& run : deviations_from_repeats(features, residuals, group).of_runs) {
      square += run.squaredNorm();
      bins += static_cast<double>(run.size());
    }
    // at least 1000 numbers that are free: sigma of a variance sqrt(2 / 1000) = 4.5 %, three of them
    CHECK(square / bins == Approx(4).epsilon(0.135));
  }
}

TEST_CASE("Where one repeat alone goes on there is no deviation") {
  const auto deviations =
      deviations_from_repeats(lasting({0.5, 1}), {Eigen::Vector2d(1, 1), Eigen::Vector4d(3, 3, 9, 9)}, {{0, 1}});
  CHECK(deviations.of_runs[1][0] == Approx(std::sqrt(2.0)));
  CHECK(deviations.of_runs[1][3] == 0);
  CHECK(deviations.shared[1] == std::vector<bool>{true, true, false, false});
}

TEST_CASE("A group is represented by the run of middle duration") {
  Observations observations;
  observations.runs = {commanded("a", 0.3, 0, 1), commanded("a", 0.3, 0, 9), commanded("a", 0.3, 0, 4)};
  CHECK(representative(observations, {0, 1, 2}) == 2);
}

TEST_CASE("Bins are shared where more than one repeat has them") {
  const std::vector<std::vector<bool>> shared = shared_bins(lasting({0.5, 1, 1}), {{0, 1}, {2}});
  CHECK(shared[0] == std::vector<bool>{true, true});
  CHECK(shared[1] == std::vector<bool>{true, true, false, false});
  CHECK(shared[2] == std::vector<bool>(4, false));
}
