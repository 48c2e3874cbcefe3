// What changed since another dataset: what both have in common is gone, and both count as noisy.
#include "gap/diagnose/baseline.hpp"

#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>
#include <string>

#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/stage_data.hpp"
#include "tests/gap/kenaf_gap.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::diagnose;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::kenaf_gap;
using test::TemporaryFolder;

namespace {

constexpr auto kBody = static_cast<std::size_t>(Passage::drive_to_body);

std::size_t x_m() {
  std::size_t channel = 0;
  while (diagnosis_channels()[channel].column != "x_m") ++channel;
  return channel;
}

VectorXd numbers(std::initializer_list<double> values) {
  VectorXd result(std::ssize(values));
  std::ranges::copy(values, result.begin());
  return result;
}

// x_m in spans 0, 1, ... of 0.25 s.
StageFeatures run_of(const VectorXd& measured) {
  StageFeatures run{{}, 0.25, measured, {}};
  for (Eigen::Index b = 0; b < measured.size(); ++b) {
    run.bins.push_back({x_m(), static_cast<std::size_t>(b), 5});
    run.rows.push_back(b);
  }
  return run;
}

ComparedFeatures of_body(std::vector<StageFeatures> runs) {
  ComparedFeatures features;
  features.of_stage[kBody] = std::move(runs);
  return features;
}

// Leaves out every candidate but these.
std::string only(const TemporaryFolder& folder, const std::vector<std::string>& kept) {
  std::string left_out;
  for (const auto& effect : nlohmann::json::parse(kenaf_gap(folder, "effects --robot kenaf --json").out)) {
    const auto name = effect["name"].get<std::string>();
    // of two that do the same the second goes with the first
    if (std::ranges::count(kept, name) == 0 && name != "body.mass_kg") left_out += (left_out.empty() ? "" : ",") + name;
  }
  return left_out;
}

}  // namespace

TEST_CASE("Less what the runs of before differ from the simulation by, bin by bin") {
  ComparedFeatures now = of_body({run_of(numbers({1, 2, 3, 4}))});
  const ComparedFeatures before = of_body({run_of(numbers({0, 0, 0})), run_of(numbers({0, 0}))});
  std::array<std::vector<VectorXd>, kPassages.size()> residuals;
  residuals[kBody] = {numbers({0.1, 0.2, 0.3}), numbers({0.3, 0.6})};
  compare_against(now, {{}, {{0, 1}}}, before, residuals);

  const StageFeatures& run = now.of_stage[kBody][0];
  REQUIRE(run.bins.size() == 3);  // of the fourth the baseline knows nothing
  // means of the baseline: 0.2, 0.4, and 0.3 of one run alone
  CHECK((run.measured - numbers({0.8, 1.6, 2.7})).norm() < 1e-12);
  CHECK(run.baseline_runs == numbers({2, 2, 1}));
  CHECK(run.rows == std::vector<Eigen::Index>{0, 1, 2});
}

TEST_CASE("After an obstacle, other start poses lead another way: rough where it happens, unknown from then on") {
  // x in counts of the channel: 3 further on at the start, so 3 all along; from the third bin on 40 more
  const double count = diagnosis_channels()[x_m()].resolution;
  StageFeatures run = run_of(count * numbers({0, 0, 0, 0, 0}));
  run.baseline_runs = numbers({1, 1, 1, 1, 1});
  run.baseline_simulated = count * numbers({0, 10, 20, 30, 40});
  OpenShapes shapes{MatrixXd::Zero(5, kShapesOfStart), MatrixXd::Zero(5, 0), numbers({0, 0, 0, 0, 0})};
  shapes.local.col(0) = count * numbers({1, 1, 1, 1, 1});
  std::vector<OpenShapes> open{shapes};
  add_other_ways(open, {run}, {count * numbers({3, 13, 23, 33, 43})});
  CHECK(open[0].roughness.norm() < 1e-9 * count);
  CHECK(open[0].ways.norm() < 1e-9 * count);

  // the start's 3 remain 3, as they fit the first value and no change. With the real difference 2 x 40, of each of the
  // two runs sqrt(2) 40
  add_other_ways(open, {run}, {count * numbers({3, 13, 63, 73, 83})});
  const VectorXd rough = numbers({0, 40, 40, 40, 0});
  CHECK((open[0].roughness / count / std::sqrt(2.0) - rough).norm() < 1e-9);
  const VectorXd way = numbers({0, 0, 40, 40, 40});
  CHECK((open[0].ways.rowwise().sum() / count / std::sqrt(2.0) - way).norm() < 1e-9);
  CHECK(open[0].ways.colwise().norm().maxCoeff() == Approx(open[0].ways.norm()));  // one column has it all
  // with what was rough before, in squares
  add_other_ways(open, {run}, {count * numbers({3, 13, 63, 73, 83})});
  CHECK((open[0].roughness / count / 2 - rough).norm() < 1e-9);

  // without a baseline nothing
  std::vector<OpenShapes> alone{shapes};
  add_other_ways(alone, {run_of(count * numbers({0, 0, 0, 0, 0}))}, {count * numbers({3, 13, 63, 73, 83})});
  CHECK(alone[0].roughness.norm() == 0);
  CHECK(alone[0].ways.cols() == 0);
}

TEST_CASE("What the ground brings back is rough, and no way on") {
  const double count = diagnosis_channels()[x_m() + 2].resolution;  // z
  StageFeatures run = run_of(numbers({0, 0, 0, 0}));
  for (Bin& bin : run.bins) bin.channel = x_m() + 2;
  run.baseline_runs = numbers({1, 1, 1, 1});
  run.baseline_simulated = numbers({0, 0, 0, 0});
  std::vector<OpenShapes> open{{MatrixXd::Zero(4, kShapesOfStart), MatrixXd::Zero(4, 0), numbers({0, 0, 0, 0})}};
  add_other_ways(open, {run}, {count * numbers({0, 0, 0, 7})});
  CHECK((open[0].roughness / count / std::sqrt(2.0) - numbers({0, 0, 7, 7})).norm() < 1e-9);
  CHECK(open[0].ways.norm() == 0);
}

TEST_CASE("Noise told by a difference from a baseline is that of one run") {
  // runs without repeats whose differences from two baselines jump by 30 sqrt(1 + 1 / 2) times a noise of 1: second
  // differences of +-a, alternating, are 4 a, and sqrt(6) of the noise
  constexpr double kResolutions = 30;
  const double count = diagnosis_channels()[x_m()].resolution;
  const double a = kResolutions * count * std::sqrt(6.0) / 4 / 1.4826 * std::sqrt(1.5);
  StageFeatures run = run_of(numbers({a, -a, a, -a, a, -a}));
  run.baseline_runs = numbers({2, 2, 2, 2, 2, 2});
  const OpenShapes none{MatrixXd::Zero(6, 0), MatrixXd::Zero(6, 0), VectorXd::Zero(6)};
  const NoiseFloor floor = noise_floor({run}, {run.measured}, {{0}}, {none});
  CHECK(floor.sigma[x_m()] == Approx(kResolutions * count));
}

TEST_CASE("The noise of a change is that of both means, and the simulator's numbers cancel") {
  std::vector<StageFeatures> runs{run_of(numbers({0, 0})), run_of(numbers({0, 0}))};
  for (StageFeatures& run : runs) run.baseline_runs = numbers({4, 1});
  NoiseFloor floor;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    floor.sigma_of_bin.push_back(numbers({2, 2}));
    floor.open.push_back({MatrixXd::Zero(2, 0), MatrixXd::Ones(2, 1), VectorXd::Zero(2)});
  }
  const StageData data = stage_data(Passage::drive_to_body, runs, {{0, 1}}, {numbers({0, 0}), numbers({0, 0})}, floor);
  REQUIRE(data.groups.size() == 1);
  // a variance of 4: over two runs 2, over four 1, over one 4
  CHECK((data.groups[0].variance - numbers({2 + 1, 2 + 4})).norm() < 1e-12);
  CHECK(data.groups[0].shared_shapes.norm() == 0);
  CHECK(data.groups[0].local_shapes.norm() > 0);  // what of them is not linear
}

TEST_CASE("Of a robot that no model fits, what changed is named with its value, and without a change there is none") {
  const TemporaryFolder folder;
  // what no candidate below explains is there before and after
  const std::string robot =
      "simulate --manoeuvre straight-fast --manoeuvre turn-in-place --repeats 2 "
      "--effect friction_across:scale=0.9 --effect drive_viscous:damping_nspm=8 ";
  REQUIRE(kenaf_gap(folder, robot + "--seed 1 --out before").status == 0);
  REQUIRE(kenaf_gap(folder, robot + "--seed 2 --out same").status == 0);
  REQUIRE(kenaf_gap(folder, robot + "--seed 3 --effect mass:scale=1.2 --out loaded").status == 0);
  const std::string options = " --against before --no-next --without " +
                              only(folder, {"mass", "drive_lag", "friction_along", "com_up", "command_gain"});
  const auto report = [&](const std::string& dataset) {
    const test::Outcome outcome =
        kenaf_gap(folder, fmt::format("diagnose {} --out out-{}{}", dataset, dataset, options));
    INFO(outcome.error);
    REQUIRE(outcome.status == 0);
    CHECK_THAT(outcome.out, Catch::Contains("The gap is the change since before, of which 4 runs repeat these"));
    return nlohmann::json::parse(test::read_file(folder / ("out-" + dataset + "/report.json")));
  };
  CHECK(report("same")["verdict"] == "none");
  const auto loaded = report("loaded");
  CHECK(loaded["named"] == nlohmann::json::array({"mass"}));
  CHECK(loaded["effects"][0]["parameters"]["scale"]["value"].get<double>() == Approx(1.2).margin(0.03));
  CHECK(loaded["against"]["runs"] == 4);
  CHECK_THAT(test::read_file(folder / "out-loaded/robot.toml"),
             Catch::Contains("the diagnosis covered only the change since then"));
}

TEST_CASE("A baseline of other manoeuvres is refused, runs that it does not repeat are left out") {
  const TemporaryFolder folder;
  REQUIRE(kenaf_gap(folder, "simulate --manoeuvre straight-fast --out now").status == 0);
  REQUIRE(kenaf_gap(folder, "simulate --manoeuvre drop --out other").status == 0);
  const test::Outcome outcome = kenaf_gap(folder, "diagnose now --against other --out out");
  CHECK(outcome.status == 2);
  CHECK_THAT(outcome.error, Catch::Contains("other: none of its runs repeats a run of the diagnosis"));
  CHECK_FALSE(std::filesystem::exists(folder / "out"));
  CHECK(kenaf_gap(folder, "diagnose now --against other --out other").status == 2);
  CHECK(kenaf_gap(folder, "diagnose now --against nowhere --out out").status == 2);

  REQUIRE(kenaf_gap(folder, "simulate --manoeuvre straight-fast --manoeuvre drop --out more").status == 0);
  Observations observed = observe((folder / "more").string(), {}, {}, 24);
  const Baseline baseline = observe_baseline(folder / "other", observed, {});
  REQUIRE(observed.runs.size() == 1);
  CHECK(observed.runs[0].manoeuvre == "drop");
  CHECK(baseline.of_run == std::vector<std::vector<std::size_t>>{{0}});
  CHECK_THAT(observed.warnings.back(), Catch::Contains("no run of") && Catch::Contains("left out"));
}
