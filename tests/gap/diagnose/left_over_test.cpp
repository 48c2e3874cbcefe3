// What is left of a gap, in words: made runs whose left-over is known.
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <random>
#include <set>

#include "gap/candidates/robot_numbers.hpp"
#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/left_over.hpp"
#include "gap/diagnose/left_over_words.hpp"
#include "gap/diagnose/page/left_over_section.hpp"
#include "tests/gap/candidates/robots.hpp"
#include "tests/gap/made_run.hpp"
#include "tests/gap/well_formed.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::candidates;
using namespace kenaf::gap::diagnose;
using Catch::Contains;
using test::ColumnOfTime;
using test::made_run;

namespace {

constexpr double kMadeBin_s = 0.25, kMadeRow_s = 0.05, kMadeDuration_s = 12, kMadeNoise = 0.01, kMadeHalfWidth_m = 0.25;

// Tracks that speed up, turn and come back, at their own times and speeds in each run.
struct Driven {
  double speed_mps, turn_radps, period_s;
  double forward(double t_s) const { return speed_mps * std::sin(2 * M_PI * t_s / period_s); }
  double turn(double t_s) const { return turn_radps * std::sin(2 * M_PI * t_s / (0.7 * period_s) + speed_mps); }
  double left(double t_s) const { return forward(t_s) - kMadeHalfWidth_m * turn(t_s); }
  double right(double t_s) const { return forward(t_s) + kMadeHalfWidth_m * turn(t_s); }
};

Driven driven_in(std::size_t run) {
  const auto r = static_cast<double>(run);
  return {0.5 + 0.1 * std::fmod(r, 4), 0.4 + 0.15 * std::fmod(r, 3), 5 + 0.4 * std::fmod(r, 5)};
}

// What the robot does of its drive; what the simulation says is the drive itself.
using Behaviour = std::function<double(std::size_t run, const Driven& drive, double t_s)>;

struct RunsLeft {
  std::vector<std::unique_ptr<Observation>> observations;
  std::vector<std::unique_ptr<FeatureMap>> features;
  std::vector<LeftOverRun> runs;
};

// The pose by the sum of its rates, at the rows' times.
std::function<double(double)> integral_of(std::function<double(double)> rate) {
  return [rate = std::move(rate)](double until_s) {
    double sum = 0;
    for (double t_s = 0; t_s < until_s - 1e-9; t_s += 0.01) sum += 0.01 * rate(t_s + 0.005);
    return sum;
  };
}

// Columns of both, then noise on the bins.
RunsLeft runs_left(std::size_t count, std::string_view column, bool pose, const Behaviour& simulated,
                   const Behaviour& measured, std::size_t runs_of_group = 1) {
  RunsLeft all;
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  for (std::size_t r = 0; r < count; ++r) {
    const Driven drive = driven_in(r);
    const auto columns = [&](const Behaviour& of) {
      const std::function<double(double)> value = [&, r](double t_s) { return of(r, drive, t_s); };
      return std::vector<ColumnOfTime>{{"cmd_track_left_mps", [&](double t_s) { return drive.left(t_s); }},
                                       {"cmd_track_right_mps", [&](double t_s) { return drive.right(t_s); }},
                                       {"track_left_mps", [&](double t_s) { return drive.left(t_s); }},
                                       {"track_right_mps", [&](double t_s) { return drive.right(t_s); }},
                                       {std::string(column), pose ? integral_of(value) : value}};
    };
    // a column that is made again is the later one
    const auto made_of = [&](const Behaviour& of) {
      std::vector<ColumnOfTime> wanted = columns(of);
      std::erase_if(wanted, [&](const ColumnOfTime& c) { return c.first == column && &c != &wanted.back(); });
      return made_run(kMadeDuration_s, kMadeRow_s, wanted);
    };
    all.observations.push_back(std::make_unique<Observation>());
    all.observations.back()->file = "run";
    all.observations.back()->run = made_of(measured);
    all.features.push_back(std::make_unique<FeatureMap>(all.observations.back()->run, kMadeBin_s));
    const FeatureMap& features = *all.features.back();
    const double sigma = pose ? kMadeNoise / 4 : kMadeNoise;  // of an angle a rate over half a second makes more
    const Eigen::VectorXd noise =
        Eigen::VectorXd::NullaryExpr(features.measured().size(), [&] { return sigma * normal(random); });
    all.runs.push_back({all.observations.back().get(), all.features.back().get(), features.measured() + noise,
                        features.of(made_of(simulated)), Eigen::VectorXd::Constant(noise.size(), sigma),
                        r / runs_of_group});
  }
  return all;
}

double turn_of(std::size_t, const Driven& drive, double t_s) {
  return drive.turn(t_s);
}

std::vector<Dependence> terms_of(const RunsLeft& made, const std::string& channel, bool of_drives = false) {
  std::vector<Dependence> found;
  for (const Dependence& d : describe_left_over(made.runs, of_drives)) {
    INFO(d.words);
    CHECK(d.share >= kLeastReported);
    CHECK(d.share <= 1);
    CHECK(d.points.size() <= 400);
    CHECK_FALSE(d.points.empty());
    if (d.channel == channel) found.push_back(d);
  }
  return found;
}

}  // namespace

TEST_CASE("A yaw rate of about half of the simulated is said with its share and where it holds") {
  const RunsLeft runs = runs_left(8, "yaw_rad", true, turn_of,
                                  [](std::size_t, const Driven& drive, double t_s) { return 0.52 * drive.turn(t_s); });
  const std::vector<Dependence> terms = describe_left_over(runs.runs, false);
  REQUIRE(terms.size() == 1);
  CHECK(terms[0].channel == "yaw rate");
  CHECK(terms[0].on == "simulated yaw rate");
  CHECK(terms[0].words ==
        "yaw rate: measured 0.52 of the simulated, in every turn, at all speeds (100 % of what is left)");
  CHECK(terms[0].share > 0.97);
  CHECK(terms[0].slope == Approx(-0.48).margin(0.01));
  CHECK(terms[0].intercept == 0);
  CHECK(terms[0].look_at.front() == "track.separation_m");
  // it is nothing that drives do, nor do drives act between their belts and the body
  CHECK(describe_left_over(runs.runs, true).empty());
  const auto left = [](std::size_t, const Driven& drive, double t_s) { return drive.turn(t_s); };
  const auto slower = [](std::size_t, const Driven& drive, double t_s) { return 0.5 * drive.turn(t_s); };
  CHECK(describe_left_over(runs_left(8, "track_left_mps", false, left, slower).runs, false).empty());
}

TEST_CASE("Noise correlates with nothing") {
  for (const char* column : {"yaw_rad", "gyro_z_radps", "track_left_a", "battery_v", "pitch_rad"}) {
    INFO(column);
    for (const bool of_drives : {false, true})
      CHECK(describe_left_over(runs_left(8, column, false, turn_of, turn_of).runs, of_drives).empty());
  }
  CHECK(describe_left_over({}, false).empty());
}

TEST_CASE("Noise that is stated too small correlates with nothing either") {
  RunsLeft runs = runs_left(8, "gyro_z_radps", false, turn_of, turn_of);
  for (LeftOverRun& run : runs.runs) run.sigma /= 3;
  CHECK(describe_left_over(runs.runs, false).empty());
}

TEST_CASE("A delay is said in seconds") {
  const auto late = [](std::size_t, const Driven& drive, double t_s) { return drive.turn(std::max(0.0, t_s - 0.2)); };
  // two runs are too few to hold runs out: stretches of time are
  for (const std::size_t count : {std::size_t{8}, std::size_t{2}}) {
    const std::vector<Dependence> terms =
        terms_of(runs_left(count, "gyro_z_radps", false, turn_of, late), "yaw rate by gyro");
    REQUIRE_FALSE(terms.empty());
    CHECK(terms[0].on == "change of the simulated yaw rate by gyro");
    CHECK_THAT(terms[0].words, Contains("measured 0.2 s late behind the simulated, whenever it changes"));
    CHECK(terms[0].share > 0.9);
    CHECK(terms[0].slope == Approx(-0.2).margin(0.02));
  }
}

TEST_CASE("A lag of both tracks is said once") {
  RunsLeft runs = runs_left(8, "gyro_z_radps", false, turn_of, turn_of);
  // what a first-order lag makes of the tracks' speeds: the simulated ones are quick
  for (LeftOverRun& run : runs.runs) {
    double lagged = 0;
    for (std::size_t b = 0; b < run.features->bins().size(); ++b) {
      const Bin& bin = run.features->bins()[b];
      const auto i = static_cast<Eigen::Index>(b);
      if (!diagnosis_channels()[bin.channel].column.starts_with("track_")) continue;
      lagged =
          bin.span == 0 ? run.simulated[i] : lagged + (run.simulated[i] - lagged) * (1 - std::exp(-kMadeBin_s / 1.1));
      run.measured[i] = lagged;
    }
  }
  const std::vector<Dependence> terms = describe_left_over(runs.runs, true);
  REQUIRE(terms.size() == 1);
  CHECK(terms[0].channel == "speed of each track");
  CHECK_THAT(terms[0].words, Contains("s late behind the simulated, as by a lag, whenever it changes"));
  CHECK(terms[0].slope == Approx(-1.1).margin(0.15));
  CHECK(std::ranges::count(terms[0].look_at, "drive_lag") == 1);
}

TEST_CASE("A factor that differs from run to run is said so, with its middle") {
  const auto differs = [](std::size_t run, const Driven& drive, double t_s) {
    return (1 + 0.3 * (run % 2 == 0 ? 1 : -1) * (0.5 + 0.05 * static_cast<double>(run))) * drive.turn(t_s);
  };
  const std::vector<Dependence> terms =
      terms_of(runs_left(10, "gyro_z_radps", false, turn_of, differs), "yaw rate by gyro");
  REQUIRE_FALSE(terms.empty());
  CHECK(terms[0].on == "run");
  CHECK_THAT(terms[0].words, Contains("most of it differs from run to run: 0.") && Contains("in the middle 80 %"));
  CHECK(terms[0].share > 0.8);
  CHECK(terms[0].points.size() == 10);
}

TEST_CASE("A common factor is reported in addition to the differences between runs") {
  const auto differs = [](std::size_t run, const Driven& drive, double t_s) {
    return (0.7 + 0.1 * (run % 2 == 0 ? 1 : -1)) * drive.turn(t_s);
  };
  const std::vector<Dependence> terms =
      terms_of(runs_left(10, "gyro_z_radps", false, turn_of, differs), "yaw rate by gyro");
  REQUIRE(terms.size() == 2);
  CHECK(terms[0].on == "simulated yaw rate by gyro");
  CHECK_THAT(terms[1].words, Contains("differs from run to run: 0.60 to 0.80 of the simulated was measured"));
  CHECK(terms[0].share + terms[1].share == Approx(1).margin(0.05));
}

TEST_CASE("One run with other trouble makes no dependence") {
  const auto with_outlier = [](std::size_t run, const Driven& drive, double t_s) {
    return (run == 3 ? -2 : 1) * drive.turn(t_s);
  };
  CHECK(terms_of(runs_left(10, "gyro_z_radps", false, turn_of, with_outlier), "yaw rate by gyro").empty());
  // nor does it spoil what the others have
  const auto also = [](std::size_t run, const Driven& drive, double t_s) {
    return (run == 3 ? -2 : 0.8) * drive.turn(t_s);
  };
  const std::vector<Dependence> terms =
      terms_of(runs_left(10, "gyro_z_radps", false, turn_of, also), "yaw rate by gyro");
  REQUIRE_FALSE(terms.empty());
  CHECK(terms[0].slope == Approx(-0.2).margin(0.06));
}

TEST_CASE("Offsets are said with their unit") {
  const auto amperes = [](std::size_t, const Driven& drive, double t_s) { return 3 + std::abs(drive.left(t_s)); };
  const auto more = [&](std::size_t run, const Driven& drive, double t_s) { return amperes(run, drive, t_s) + 1.25; };
  const std::vector<Dependence> terms = terms_of(runs_left(6, "battery_v", false, amperes, more), "voltage", true);
  REQUIRE(terms.size() == 1);
  CHECK(terms[0].words == "voltage: measured 1.2 V more than the simulated, in every run (100 % of what is left)");
  CHECK(terms[0].look_at == std::vector<std::string>{"battery.open_circuit_v"});
  CHECK(terms[0].slope == 0);
  CHECK(terms[0].intercept == Approx(1.25).margin(0.01));
}

TEST_CASE("What holds only while it speeds up, or to one side, is said so") {
  const auto slow_to_start = [](std::size_t, const Driven& drive, double t_s) {
    const double now = drive.turn(t_s), before = drive.turn(t_s - 0.2);
    return std::abs(now) > std::abs(before) ? before : now;
  };
  const auto delayed = terms_of(runs_left(8, "gyro_z_radps", false, turn_of, slow_to_start), "yaw rate by gyro");
  REQUIRE_FALSE(delayed.empty());
  CHECK_THAT(delayed[0].words, Contains("only while it grows"));

  const auto to_the_left = [](std::size_t, const Driven& drive, double t_s) {
    return (drive.turn(t_s) > 0 ? 0.5 : 0.8) * drive.turn(t_s);
  };
  const auto sided = terms_of(runs_left(8, "gyro_z_radps", false, turn_of, to_the_left), "yaw rate by gyro");
  REQUIRE_FALSE(sided.empty());
  CHECK_THAT(sided[0].words, Contains("0.50 to the left and 0.80 to the right"));
}

TEST_CASE("One track that is slower is reported as that track's") {
  const auto left = [](std::size_t, const Driven& drive, double t_s) { return drive.left(t_s); };
  const auto slower = [](std::size_t, const Driven& drive, double t_s) { return 0.8 * drive.left(t_s); };
  const std::vector<Dependence> terms =
      describe_left_over(runs_left(8, "track_left_mps", false, left, slower).runs, true);
  REQUIRE_FALSE(terms.empty());
  CHECK_THAT(terms[0].words, Contains("left track speed: measured 0.80 of the simulated, in every run"));
  for (const Dependence& d : terms) CHECK(d.channel != "right track speed");
}

TEST_CASE(
    "What a dependence says to look at is an effect of the catalogue that is looked for, or a key of a description") {
  std::set<std::string> effects, keys;
  for (const char* name : {"kenaf", "marmotte", "p2at", "p2dx"}) {
    const physics::RobotDescription robot = test::robot_of(name);
    for (const Candidate& candidate : catalogue_candidates(robot, true)) effects.insert(candidate.effect);
    for (const Candidate& candidate : description_candidates(robot)) keys.insert(candidate.name);
  }
  // no run shows it, as tracks are in metres; whoever makes runs of a log may have used a wrong one
  REQUIRE(find_robot_number(test::robot_of("kenaf"), "drive.sprocket_radius_m").has_value());
  keys.insert("drive.sprocket_radius_m");

  std::size_t terms = 0;
  const auto check = [&](const std::vector<std::string>& names) {
    CHECK(std::set(names.begin(), names.end()).size() == names.size());
    for (const std::string& name : names) {
      INFO(name);
      CHECK((effects.contains(name) || keys.contains(name)));
      ++terms;
    }
  };
  for (const QuantityInfo& quantity : left_over_quantities()) {
    INFO(quantity.name);
    for (auto on = 0; on <= static_cast<int>(Regressor::place_y); ++on)
      check(look_at(quantity.quantity, static_cast<Regressor>(on)));
    check(look_at_for_runs(quantity.quantity));
  }
  CHECK(terms > 100);
}

TEST_CASE("The same runs are described the same twice, and sizes are checked") {
  RunsLeft runs = runs_left(4, "gyro_z_radps", false, turn_of,
                            [](std::size_t, const Driven& drive, double t_s) { return 0.9 * drive.turn(t_s) + 0.02; });
  const auto first = describe_left_over(runs.runs, false), second = describe_left_over(runs.runs, false);
  REQUIRE(first.size() == second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    CHECK(first[i].words == second[i].words);
    CHECK(first[i].slope == second[i].slope);
  }
  runs.runs[0].sigma.conservativeResize(3);
  CHECK_THROWS_AS(describe_left_over(runs.runs, false), std::invalid_argument);
}

TEST_CASE("The page's section has every sentence and a well-formed plot") {
  const RunsLeft runs = runs_left(8, "yaw_rad", true, turn_of,
                                  [](std::size_t, const Driven& drive, double t_s) { return 0.52 * drive.turn(t_s); });
  const std::vector<Dependence> terms = describe_left_over(runs.runs, false);
  REQUIRE(terms.size() == 1);
  CHECK(test::fault_of_xml(left_over_plot(terms[0])) == "");
  const std::string html = left_over_section(terms);
  CHECK(test::fault_of_xml("<div>" + html + "</div>") == "");
  CHECK_THAT(html, Contains(terms[0].words + ".") && Contains("track.separation_m, track.contact_length_m"));
  CHECK_THAT(left_over_section({}), Contains("correlates with no measured quantity"));
}
