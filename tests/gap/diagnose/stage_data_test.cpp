// Means over repeats, and what is known of them.
#include "gap/diagnose/stage_data.hpp"

#include <catch2/catch.hpp>
#include <string_view>

#include "gap/diagnose/channels.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::diagnose;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

namespace {

std::size_t number_of(std::string_view column) {
  std::size_t channel = 0;
  while (diagnosis_channels()[channel].column != column) ++channel;
  return channel;
}

// Bins of 0.5 s of one channel each, at these spans.
StageFeatures in_spans(std::initializer_list<std::pair<const char*, std::size_t>> bins) {
  StageFeatures features{{}, 0.5, VectorXd::Zero(std::ssize(bins)), {}};
  for (const auto& [column, span] : bins) features.bins.push_back({number_of(column), span, 4});
  return features;
}

// Noise of 2 in all bins of all runs, and shapes as given.
NoiseFloor floor_of_two(const std::vector<StageFeatures>& features, const std::vector<OpenShapes>& open = {}) {
  NoiseFloor floor;
  for (const StageFeatures& run : features) {
    const auto bins = std::ssize(run.bins);
    floor.sigma_of_bin.push_back(VectorXd::Constant(bins, 2));
    floor.open.push_back({MatrixXd(bins, 0), MatrixXd(bins, 0), VectorXd::Zero(bins)});
  }
  if (!open.empty()) floor.open = open;
  return floor;
}

VectorXd numbers(std::initializer_list<double> values) {
  VectorXd result(std::ssize(values));
  std::ranges::copy(values, result.begin());
  return result;
}

}  // namespace

TEST_CASE("A manoeuvre is the mean of its repeats, where each goes as far as it does") {
  const std::vector<StageFeatures> features{in_spans({{"x_m", 0}, {"x_m", 1}}), in_spans({{"x_m", 0}}),
                                            in_spans({{"x_m", 0}, {"x_m", 1}, {"x_m", 2}})};
  const StageData data = stage_data(Passage::drive_to_body, features, {{0, 1, 2}},
                                    {numbers({1, 5}), numbers({2}), numbers({6, 7, -1})}, floor_of_two(features));
  REQUIRE(data.groups.size() == 1);
  const StageGroup& group = data.groups[0];
  CHECK(group.count == numbers({3, 2, 1}));
  CHECK(group.residual == numbers({3, 6, -1}));
  CHECK((group.variance - numbers({4.0 / 3, 2, 4})).norm() < 1e-12);  // a variance of 4 over n
  CHECK(bin_count(data) == 3);
}

TEST_CASE("A run that is not used is not in the mean, its bins stay where they are") {
  const std::vector<StageFeatures> features{in_spans({{"x_m", 0}, {"x_m", 1}}), in_spans({{"x_m", 0}}),
                                            in_spans({{"x_m", 0}, {"x_m", 1}, {"x_m", 2}})};
  const std::vector<VectorXd> residuals{numbers({1, 5}), numbers({2}), numbers({6, 7, -1})};
  const StageData data = stage_data(Passage::drive_to_body, features, {{0, 1, 2}}, residuals, floor_of_two(features),
                                    UsedParts::without({2}));
  const StageGroup& group = data.groups[0];
  CHECK(group.bins.size() == 3);
  CHECK(group.count == numbers({2, 1, 0}));
  CHECK(group.residual == numbers({1.5, 5, 0}));
  CHECK(group.variance[0] == Approx(2));
  CHECK(group.variance[1] == Approx(4));
  CHECK(group.variance[2] > 1e9);
  // what was simulated of all runs fits all the same
  CHECK(mean_of_groups(data, residuals)[0] == numbers({3, 6, -1}));
}

TEST_CASE("Bins are channel by channel in the order of time, each a series") {
  // the second run measured another channel, and x not in span 1; the first one nothing in span 2
  const std::vector<StageFeatures> features{in_spans({{"x_m", 0}, {"x_m", 1}, {"x_m", 3}}),
                                            in_spans({{"x_m", 0}, {"x_m", 2}, {"yaw_rad", 1}})};
  const StageData data = stage_data(Passage::drive_to_body, features, {{0, 1}},
                                    {numbers({1, 2, 3}), numbers({5, 6, 7})}, floor_of_two(features));
  const StageGroup& group = data.groups[0];
  CHECK(group.residual == numbers({3, 2, 6, 3, 7}));
  CHECK(group.t_s == std::vector<double>{0.25, 0.75, 1.25, 1.75, 0.75});
  REQUIRE(group.series.size() == 2);
  CHECK(group.series[0].first == 0);
  CHECK(group.series[0].count == 4);
  CHECK(group.series[0].channel == number_of("x_m"));
  CHECK(group.series[0].kind == kind_of(number_of("x_m")));
  CHECK(group.series[1].first == 4);
  CHECK(group.series[1].count == 1);
  CHECK(group.bin_of[1] == std::vector<Eigen::Index>{0, 2, 4});
  CHECK(group.bins[0].samples == 8);
}

TEST_CASE("What is open in each run by itself averages out, what is open in all of them does not") {
  const std::vector<StageFeatures> features(4, in_spans({{"x_m", 0}, {"x_m", 1}}));
  const OpenShapes one{Vector2d(2, 6), Vector2d(10, 0), Vector2d::Zero()},
      other{Vector2d(4, 0), Vector2d(20, 20), Vector2d::Zero()};
  const std::vector<VectorXd> none(4, VectorXd::Zero(2));
  const StageData data = stage_data(Passage::drive_to_body, features, {{0, 1, 2, 3}}, none,
                                    floor_of_two(features, {one, one, other, other}));
  const StageGroup& group = data.groups[0];
  REQUIRE(group.shared_shapes.cols() == 1);
  CHECK((group.shared_shapes.col(0) - Vector2d(15, 10)).norm() < 1e-12);
  // the mean of four independent amounts has half of the sigma of one
  REQUIRE(group.local_shapes.cols() == 2);
  CHECK((group.local_shapes.col(0) - Vector2d(3, 3) / 2).norm() < 1e-12);
  // the numerics of a group may differ from those of the others by a part of them
  CHECK(group.local_shapes(0, 1) / group.local_shapes(1, 1) == Approx(1.5));
  CHECK(group.local_shapes(0, 1) < 15.0 / 2);
}

TEST_CASE("Runs that do not measure a stage are in no group") {
  const std::vector<StageFeatures> features{in_spans({}), in_spans({{"x_m", 0}}), in_spans({})};
  const StageData data = stage_data(Passage::drive_to_body, features, {{0}, {1, 2}},
                                    {VectorXd(), numbers({3}), VectorXd()}, floor_of_two(features));
  REQUIRE(data.groups.size() == 1);
  CHECK(data.groups[0].runs == std::vector<std::size_t>{1});
  CHECK(data.groups[0].residual == numbers({3}));
}
