// What each stage between command and sensor sees, on runs whose flaw is known.
#include "gap/diagnose/stage_features.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "gap/diagnose/channels.hpp"
#include "tests/gap/made_run.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::diagnose;

namespace {

// A robot that weaves: yaw = 0.5 sin t, its rate 0.5 cos t.
struct Flaw {
  double gyro_scale = 1, drift_mps = 0, pitch_rad = 0;
};

runs::Run weaving(const Flaw& flaw) {
  const auto zero = [](double) { return 0.0; };
  return test::made_run(10, 0.05,
                        {{"track_left_mps", [](double) { return 0.3; }},
                         {"battery_v", [](double) { return 24.0; }},
                         {"x_m", [&](double t_s) { return (0.3 + flaw.drift_mps) * t_s; }},
                         {"yaw_rad", [](double t_s) { return 0.5 * std::sin(t_s); }},
                         {"pitch_rad", [&](double) { return flaw.pitch_rad; }},
                         {"roll_rad", zero},
                         {"gyro_x_radps", zero},
                         {"gyro_z_radps", [&](double t_s) { return flaw.gyro_scale * 0.5 * std::cos(t_s); }}});
}

struct Seen {
  FeatureMap map;
  StageFeatures stage;
  Seen(Passage passage, const runs::Run& run) : map(run, 0.25), stage(stage_features(passage, map, run)) {}
  std::set<std::string> columns() const {
    std::set<std::string> result;
    for (const Bin& bin : stage.bins) result.emplace(diagnosis_channels()[bin.channel].column);
    return result;
  }
};

// Measured minus simulated without a flaw.
Eigen::VectorXd gap_of(Passage passage, const Flaw& flaw) {
  const Seen measured(passage, weaving(flaw));
  const runs::Run simulated = weaving({});
  return measured.stage.measured -
         stage_values(passage, measured.stage, measured.map, measured.map.of(simulated), simulated);
}

}  // namespace

TEST_CASE("Each stage has channels of its own") {
  CHECK(Seen(Passage::command_to_drive, weaving({})).columns() == std::set<std::string>{"battery_v", "track_left_mps"});
  CHECK(Seen(Passage::drive_to_body, weaving({})).columns() ==
        std::set<std::string>{"gyro_x_radps", "gyro_z_radps", "pitch_rad", "roll_rad", "x_m", "yaw_rad"});
  CHECK(Seen(Passage::body_to_sensor, weaving({})).columns() == std::set<std::string>{"gyro_x_radps", "gyro_z_radps"});
}

TEST_CASE("A stage's values are those of its bins") {
  const Seen seen(Passage::drive_to_body, weaving({}));
  REQUIRE(std::ssize(seen.stage.rows) == seen.stage.measured.size());
  for (std::size_t b = 0; b < seen.stage.bins.size(); ++b) {
    const auto row = static_cast<std::size_t>(seen.stage.rows[b]);
    CHECK(seen.stage.bins[b].channel == seen.map.bins()[row].channel);
    CHECK(seen.stage.measured[static_cast<Eigen::Index>(b)] == seen.map.measured()[seen.stage.rows[b]]);
  }
  CHECK(seen.stage.span_s == 0.25);
}

TEST_CASE("A body that drifts is a gap of the body alone") {
  const Flaw drifts{.drift_mps = 0.03};
  CHECK(gap_of(Passage::command_to_drive, drifts).norm() < 1e-12);
  CHECK(gap_of(Passage::drive_to_body, drifts).maxCoeff() == Approx(0.03 * 9.875).epsilon(0.01));  // of the last bin
  CHECK(gap_of(Passage::body_to_sensor, drifts).norm() < 1e-12);
}

TEST_CASE("A gyro that agrees with the angles says nothing between body and sensor") {
  // trapezoids of 0.05 s are off by 0.05^2 / 12 of the rate
  CHECK(Seen(Passage::body_to_sensor, weaving({})).stage.measured.cwiseAbs().maxCoeff() < 2e-4);
}

TEST_CASE("A gyro whose scale is wrong by 5 % shows as 5 % of the rate, at each time") {
  const Seen seen(Passage::body_to_sensor, weaving({.gyro_scale = 1.05}));
  for (std::size_t b = 0; b < seen.stage.bins.size(); ++b) {
    const bool of_yaw = diagnosis_channels()[seen.stage.bins[b].channel].column == "gyro_z_radps";
    const double middle_s = (static_cast<double>(seen.stage.bins[b].span) + 0.5) * 0.25;
    // Rows at 0, 0.05 ... 0.2 s have their middle at 0.1 s. A slope over half a second is 1 - 0.25^2 / 6 of the rate, a
    // mean of five rows 0.9975 of it; trapezoids of 0.05 s lack 0.05^2 / 12 of the rate, which is 0.4 % of a
    // twentieth: 1.7 %.
    const double rate = of_yaw ? 0.5 * std::cos(middle_s - 0.025) : 0;
    CHECK(seen.stage.measured[static_cast<Eigen::Index>(b)] == Approx(0.05 * rate).margin(0.05 * 0.5 * 0.018));
  }
}

TEST_CASE("Where the robot is not level its angles do not tell the gyro's rates") {
  CHECK(Seen(Passage::body_to_sensor, weaving({.pitch_rad = 0.1})).stage.bins.size() > 50);
  CHECK(Seen(Passage::body_to_sensor, weaving({.pitch_rad = 0.3})).stage.bins.empty());
}

TEST_CASE("A rate follows from the angles before and after it: not at the ends, nor next to a gap") {
  // 40 bins of 0.25 s; yaw is missing in the one from 5 s on
  runs::Run run = weaving({});
  for (std::size_t c = 0; c < run.columns.size(); ++c)
    if (run.columns[c] == "yaw_rad")
      for (std::size_t i = 100; i < 105; ++i) run.values[c][i] = std::numeric_limits<double>::quiet_NaN();
  std::set<std::size_t> spans;
  for (const Bin& bin : Seen(Passage::body_to_sensor, run).stage.bins)
    if (diagnosis_channels()[bin.channel].column == "gyro_z_radps") spans.insert(bin.span);
  CHECK(spans.size() == 36);
  for (const std::size_t missing : {0u, 19u, 21u, 39u}) CHECK(spans.count(missing) == 0);
}

TEST_CASE("A stage that was not measured has no bins") {
  const auto run = test::made_run(1, 0.05, {{"x_m", [](double) { return 0.0; }}});
  for (const Passage passage : {Passage::command_to_drive, Passage::body_to_sensor}) {
    const Seen seen(passage, run);
    CHECK(seen.stage.bins.empty());
    CHECK(seen.stage.measured.size() == 0);
    CHECK(stage_values(passage, seen.stage, seen.map, seen.map.of(run), run).size() == 0);
  }
}
