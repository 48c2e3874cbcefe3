// Features: the mean of each channel over spans of time.
#include "gap/diagnose/features.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "gap/diagnose/channels.hpp"
#include "tests/gap/made_run.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::diagnose;
using test::made_run;

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::string_view column_of(const Bin& bin) {
  return diagnosis_channels()[bin.channel].column;
}
double ramp(double t_s) {
  return 2 * t_s;
}

}  // namespace

TEST_CASE("A bin is the mean of its span") {
  // at 10 Hz the span from 0.5 s holds 0.5 .. 0.9 s: their mean is 0.7 s, twice that 1.4
  const FeatureMap map(made_run(1, 0.1, {{"x_m", ramp}, {"not_a_channel", ramp}, {"acc_x_mps2", ramp}}), 0.5);
  REQUIRE(map.bins().size() == 2);
  CHECK(map.measured()[0] == Approx(0.4));
  CHECK(map.measured()[1] == Approx(1.4));
  CHECK(map.bins()[1].span == 1);
  CHECK(map.bins()[1].samples == 5);
  CHECK(column_of(map.bins()[1]) == "x_m");
}

TEST_CASE("A time on a border belongs to the later span, whatever its last bit") {
  // 3 * 0.1 and 0.6 - 2^-53 are the border of spans of 0.3 s as rounding leaves it
  runs::Run run{{"t_s", "x_m"}, {{0, 0.3 - 1e-16, 3 * 0.1, std::nextafter(0.6, 0.0), 0.9}, {1, 2, 4, 5, 6}}};
  const FeatureMap map(run, 0.3);
  REQUIRE(map.bins().size() == 4);
  CHECK(map.measured()[0] == 1);
  CHECK(map.measured()[1] == 3);
  CHECK(map.measured()[2] == 5);
  CHECK(map.measured()[3] == 6);
}

TEST_CASE("Time counts from the first row, wherever a log's clock began") {
  runs::Run run = made_run(1, 0.1, {{"x_m", ramp}});
  for (double& t_s : run.values[0]) t_s += 1.6e9;
  const FeatureMap map(run, 0.5);
  REQUIRE(map.bins().size() == 2);
  CHECK(map.measured()[1] == Approx(1.4));
}

TEST_CASE("Roll and yaw say nothing while the nose points up, what else is measured then counts") {
  const auto rears = [](double t_s) { return t_s > 0.45 && t_s < 0.95 ? -1.5 : -0.2; };
  const FeatureMap map(made_run(1.5, 0.1, {{"pitch_rad", rears}, {"roll_rad", ramp}, {"z_m", ramp}}), 0.5);
  std::vector<std::size_t> roll, others;
  for (const Bin& bin : map.bins()) (column_of(bin) == "roll_rad" ? roll : others).push_back(bin.span);
  CHECK(roll == std::vector<std::size_t>{0, 2});
  CHECK(others == std::vector<std::size_t>{0, 1, 2, 0, 1, 2});
}

TEST_CASE("An angle goes on across half a turn, and a simulated one is taken on the same turn") {
  const auto turning = [](double t_s) { return std::remainder(3 + t_s, 2 * std::numbers::pi); };
  const FeatureMap map(made_run(1, 0.1, {{"yaw_rad", turning}}), 0.5);
  CHECK(map.measured()[0] == Approx(3.2));
  CHECK(map.measured()[1] == Approx(3.7));
  // 0.2 rad further, so it begins on the other side of the cut
  const auto further = [](double t_s) { return std::remainder(3.2 + t_s, 2 * std::numbers::pi); };
  const Eigen::VectorXd simulated = map.of(made_run(1, 0.1, {{"yaw_rad", further}}));
  CHECK(simulated[0] - map.measured()[0] == Approx(0.2));
  CHECK(simulated[1] - map.measured()[1] == Approx(0.2));
  // a position is no angle
  const FeatureMap position(made_run(1, 0.1, {{"x_m", turning}}), 0.5);
  CHECK(position.measured()[1] == Approx(3.7 - 2 * std::numbers::pi));
}

TEST_CASE("Empty cells are left out, and the simulated run is taken where something was measured") {
  // measured at 0.1 and 0.4 s alone, and in the second span nowhere
  const auto at_times = [](double t_s) {
    return std::abs(t_s - 0.1) < 1e-9 || std::abs(t_s - 0.4) < 1e-9 || t_s > 0.95 ? t_s : kNaN;
  };
  const FeatureMap map(made_run(1.5, 0.1, {{"x_m", at_times}, {"z_m", [](double) { return kNaN; }}}), 0.5);
  REQUIRE(map.bins().size() == 2);
  CHECK(map.bins()[0].samples == 2);
  CHECK(map.bins()[1].span == 2);
  CHECK(map.measured()[0] == Approx(0.25));
  CHECK(map.of(made_run(1.5, 0.1, {{"x_m", ramp}}))[0] == Approx(0.5));
  // a simulated run with gaps of its own is drawn straight across them
  const auto sparse = [](double t_s) { return std::fmod(t_s + 1e-9, 0.3) < 1e-6 ? 2 * t_s : kNaN; };
  CHECK(map.of(made_run(1.5, 0.1, {{"x_m", sparse}}))[0] == Approx(0.5));
  // a channel that it does not have is 0
  CHECK(map.of(made_run(1.5, 0.1, {{"y_m", ramp}}))[0] == 0);
}

TEST_CASE("Channels that are left out have no bins") {
  const auto run = made_run(1, 0.1, {{"x_m", ramp}, {"gyro_z_radps", ramp}});
  CHECK(FeatureMap(run, 0.5).bins().size() == 4);
  const std::vector<std::string> left_out{"gyro_z_radps"};
  const FeatureMap map(run, 0.5, left_out);
  REQUIRE(map.bins().size() == 2);
  CHECK(map.measured() == FeatureMap(made_run(1, 0.1, {{"x_m", ramp}}), 0.5).measured());
}

TEST_CASE("Samples that are late are taken from the simulation as much earlier, in parts of their own interval") {
  // x at 2 m/s each 0.05 s, a fifth of that as often the gyro; half an interval late they are 0.05 and 0.25 behind, but
  // in the first span, whose first sample cannot be earlier than the run
  const FeatureMap map(
      made_run(
          2, 0.05,
          {{"x_m", ramp},
           {"gyro_z_radps", [](double t_s) { return std::abs(std::remainder(t_s, 0.25)) < 1e-9 ? ramp(t_s) : kNaN; }}}),
      0.5);
  const runs::Run simulated = made_run(2, 0.01, {{"x_m", ramp}, {"gyro_z_radps", ramp}});
  const Eigen::VectorXd behind = map.of(simulated) - map.of(simulated, 0.5);
  for (std::size_t b = 0; b < map.bins().size(); ++b) {
    const Bin& bin = map.bins()[b];
    if (bin.span > 0) CHECK(behind[static_cast<Eigen::Index>(b)] == Approx(column_of(bin) == "x_m" ? 0.05 : 0.25));
  }
}

TEST_CASE("A simulated run that ends early holds its last value") {
  const FeatureMap map(made_run(2, 0.1, {{"x_m", ramp}}), 0.5);
  const Eigen::VectorXd simulated = map.of(made_run(1, 0.1, {{"x_m", ramp}}));
  CHECK(simulated[1] == Approx(map.measured()[1]));
  CHECK(simulated[2] == Approx(1.8));
  CHECK(simulated[3] == Approx(1.8));
}

TEST_CASE("Robot and simulation need not be sampled alike") {
  // a straight line is interpolated exactly
  const FeatureMap map(made_run(2, 0.07, {{"x_m", ramp}, {"gyro_z_radps", ramp}}), 0.25);
  for (const double period_s : {0.01, 0.1, 0.23}) {
    const Eigen::VectorXd simulated = map.of(made_run(2.3, period_s, {{"gyro_z_radps", ramp}, {"x_m", ramp}}));
    CHECK((simulated - map.measured()).norm() < 1e-12);
  }
}

TEST_CASE("Over a gap of the pose yaw goes on by the whole turns of the gyro, or else of the tracks") {
  // 2 rad/s to the left; the pose is lost after 0.9 s until 4.1 s, in which the robot turns by 6.4 rad: the shorter way
  // is 0.12 rad
  const auto yaw = [](double t_s) {
    return t_s > 0.95 && t_s < 4.05 ? kNaN : std::remainder(2 * t_s, 2 * std::numbers::pi);
  };
  const auto rate = [](double) { return 2.0; };
  const auto left = [](double) { return -0.3; };
  const auto right = [](double) { return 0.3; };
  const auto last_yaw = [&](const std::vector<test::ColumnOfTime>& others) {
    std::vector<test::ColumnOfTime> columns{{"yaw_rad", yaw}};
    columns.insert(columns.end(), others.begin(), others.end());
    const FeatureMap map(made_run(5, 0.1, columns), 0.5);
    double last = 0;
    for (std::size_t i = 0; i < map.bins().size(); ++i)
      if (column_of(map.bins()[i]) == "yaw_rad") last = map.measured()[static_cast<Eigen::Index>(i)];
    return last;
  };
  // the last bin has the times from 4.5 to 4.9 s, 4.7 s in the mean
  CHECK(last_yaw({{"gyro_z_radps", rate}}) == Approx(9.4));
  CHECK(last_yaw({{"track_left_mps", left}, {"track_right_mps", right}}) == Approx(9.4));
  CHECK(last_yaw({}) == Approx(9.4 - 2 * std::numbers::pi));
  // a gyro that is lost with the pose says nothing
  const auto lost = [](double t_s) { return t_s > 0.95 && t_s < 4.05 ? kNaN : 2.0; };
  CHECK(last_yaw({{"gyro_z_radps", lost}}) == Approx(9.4 - 2 * std::numbers::pi));
}
