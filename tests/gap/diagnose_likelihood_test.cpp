// The likelihood of residuals against dense algebra: the covariance of all bins of all groups as one matrix.
#include "gap/diagnose/likelihood.hpp"

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/gap/linear_world.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::LinearWorld;
using test::Whole;

namespace {

constexpr std::size_t kX = 15, kYaw = 18;  // of diagnosis_channels()

// Two series of two kinds, at irregular times, with two local shapes and two shared ones.
StageGroup small_group(int seed) {
  std::srand(static_cast<unsigned>(seed));
  StageGroup group;
  group.t_s = {0.125, 0.375, 0.875, 1.125, 0.125, 0.625, 2.125};
  group.series = {{0, 4, kX, kind_of(kX)}, {4, 3, kYaw, kind_of(kYaw)}};
  group.variance = VectorXd::Random(7).array().square() + 0.5;
  group.residual = 3 * VectorXd::Random(7);
  group.local_shapes = MatrixXd::Random(7, 2);
  group.shared_shapes = 2 * MatrixXd::Random(7, 2);
  return group;
}

StageData small_data() {
  return {Passage::drive_to_body, {small_group(1), small_group(2)}};
}

Discrepancies small_discrepancies() {
  Discrepancies result = no_discrepancy();
  result[kind_of(kX)] = {1.5, 0.7};
  result[kind_of(kYaw)] = {0.4, 2};
  return result;
}

// Of one group, but for shared shapes.
MatrixXd dense_covariance(const StageGroup& group, const Discrepancies& discrepancies) {
  MatrixXd covariance = group.local_shapes * group.local_shapes.transpose();
  covariance.diagonal() += group.variance;
  for (const Series& series : group.series)
    for (Index i = series.first; i < series.first + series.count; ++i)
      for (Index j = series.first; j < series.first + series.count; ++j) {
        const Discrepancy& d = discrepancies[series.kind];
        const double apart_s =
            std::abs(group.t_s[static_cast<std::size_t>(i)] - group.t_s[static_cast<std::size_t>(j)]);
        covariance(i, j) += d.sigma * d.sigma * std::exp(-apart_s / d.memory_s);
      }
  return covariance;
}

MatrixXd stacked(const std::vector<MatrixXd>& parts) {
  MatrixXd result(0, parts.front().cols());
  for (const MatrixXd& part : parts) {
    result.conservativeResize(result.rows() + part.rows(), Eigen::NoChange);
    result.bottomRows(part.rows()) = part;
  }
  return result;
}

// Of all groups together.
MatrixXd dense_covariance(const StageData& data, const Discrepancies& discrepancies) {
  std::vector<MatrixXd> shared;
  for (const StageGroup& group : data.groups) shared.push_back(group.shared_shapes);
  const MatrixXd all = stacked(shared);
  MatrixXd covariance = all * all.transpose();
  Index first = 0;
  for (const StageGroup& group : data.groups) {
    const MatrixXd own = dense_covariance(group, discrepancies);
    covariance.block(first, first, own.rows(), own.rows()) += own;
    first += own.rows();
  }
  return covariance;
}

double log_determinant(const MatrixXd& matrix) {
  const MatrixXd factor = matrix.llt().matrixL();
  return 2 * factor.diagonal().array().log().sum();
}

GroupVectors residuals_in(const StageData& data) {
  GroupVectors residuals;
  for (const StageGroup& group : data.groups) residuals.push_back(group.residual);
  return residuals;
}

}  // namespace

TEST_CASE("The deviance is that of a Gaussian with noise, discrepancies, local and shared shapes") {
  const StageData data = small_data();
  for (const Discrepancies& discrepancies : {small_discrepancies(), no_discrepancy()}) {
    const Likelihood found = likelihood_with(data, residuals_in(data), discrepancies);
    const MatrixXd covariance = dense_covariance(data, discrepancies);
    const VectorXd residual = stacked({data.groups[0].residual, data.groups[1].residual});
    const double chi_squared = residual.dot(covariance.llt().solve(residual));
    CHECK(found.chi_squared == Approx(chi_squared));
    CHECK(found.deviance == Approx(chi_squared + log_determinant(covariance)));
  }
}

TEST_CASE("Inner products are those of the inverse covariance, and a group that counts twice is there twice") {
  StageData data = small_data();
  std::vector<MatrixXd> columns{MatrixXd::Random(7, 3), MatrixXd::Random(7, 3)};
  const auto dense = [&] {
    const MatrixXd all = stacked(columns);
    return MatrixXd(all.transpose() * dense_covariance(data, small_discrepancies()).llt().solve(all));
  };
  const std::vector<GroupWhitener> whiteners = whiteners_of(data, small_discrepancies());
  CHECK((inner_products(data, whiteners, columns) - dense()).norm() < 1e-10);
  const std::vector<double> weights{2, 1};
  const MatrixXd twice = inner_products(data, whiteners, columns, weights);
  const std::vector<double> without_first{0, 1};
  const MatrixXd second_alone = inner_products(data, whiteners, columns, without_first);
  data.groups.push_back(data.groups[0]);
  columns.push_back(columns[0]);
  CHECK((twice - dense()).norm() < 1e-10);
  data.groups = {data.groups[1]};
  columns = {columns[1]};
  CHECK((second_alone - dense()).norm() < 1e-10);
}

TEST_CASE("By group the deviance has shared shapes at the amounts that all groups make most likely") {
  const StageData data = small_data();
  // amounts a minimise (r - N a)' A^-1 (r - N a) + a' a, A block by block
  MatrixXd normal = MatrixXd::Identity(2, 2);
  VectorXd along = VectorXd::Zero(2);
  std::vector<MatrixXd> own;
  for (const StageGroup& group : data.groups) {
    own.push_back(dense_covariance(group, small_discrepancies()));
    normal += group.shared_shapes.transpose() * own.back().llt().solve(group.shared_shapes);
    along += group.shared_shapes.transpose() * own.back().llt().solve(group.residual);
  }
  const VectorXd amounts = normal.llt().solve(along);
  const std::vector<double> found = deviance_of_groups(data, residuals_in(data), small_discrepancies());
  const std::vector<VectorXd> white = whitened_rest(data, residuals_in(data), small_discrepancies());
  REQUIRE(found.size() == 2);
  for (std::size_t g = 0; g < 2; ++g) {
    const VectorXd rest = data.groups[g].residual - data.groups[g].shared_shapes * amounts;
    const double squares = rest.dot(own[g].llt().solve(rest));
    CHECK(white[g].squaredNorm() == Approx(squares));
    CHECK(found[g] == Approx(squares + log_determinant(own[g])));
  }
}

TEST_CASE("Nothing need be left open by the simulation") {
  StageData data = small_data();
  for (StageGroup& group : data.groups) group.local_shapes.resize(7, 0), group.shared_shapes.resize(7, 0);
  double deviance = 0, squares = 0;
  for (const StageGroup& group : data.groups) {
    squares += group.residual.dot(group.residual.cwiseQuotient(group.variance));
    deviance += group.variance.array().log().sum();
  }
  CHECK(likelihood_with(data, residuals_in(data), no_discrepancy()).chi_squared == Approx(squares));
  CHECK(likelihood_with(data, residuals_in(data), no_discrepancy()).deviance == Approx(squares + deviance));
}

TEST_CASE("Of what wanders the discrepancy is found, in the channels where it wanders, and makes it likelier") {
  const LinearWorld world({4, 2, 20});
  Whole gap = world.noise(1);
  const Whole wander = world.wander(2, 2, 2);
  const Index bins = world.bins_of_channel(), x = static_cast<Index>(test::WorldChannel::x);
  for (std::size_t r = 0; r < world.runs(); ++r) {
    const Index first = static_cast<Index>(r) * world.bins_of_run() + x * bins;
    gap.segment(first, bins) += wander.segment(first, bins);
  }
  const StageData data = world.data(gap);
  const Likelihood found = likelihood_of(data, residuals_in(data), no_discrepancy());
  // 80 s of it are 20 numbers that are free: 16 % of sigma, of which three are allowed
  CHECK(found.discrepancies[kind_of(kX)].sigma == Approx(2).epsilon(0.48));
  for (std::size_t k = 0; k < kind_count(); ++k)
    if (k != kind_of(kX)) CHECK(found.discrepancies[k].sigma < 0.4);
  CHECK(found.deviance < likelihood_with(data, residuals_in(data), no_discrepancy()).deviance - 100);
}

TEST_CASE("An offset that the simulation leaves open is no discrepancy") {
  LinearWorld world({4, 2, 5});
  StageData data = world.data(world.noise(1) + world.in_channel(test::WorldChannel::x, 0));
  Index sign = 1;
  for (StageGroup& group : data.groups) {
    group.local_shapes = MatrixXd::Zero(group.residual.size(), 1);
    for (const Series& series : group.series)
      if (series.channel == kX) {
        group.local_shapes.col(0).segment(series.first, series.count).setConstant(5);
        group.residual.segment(series.first, series.count).array() += 5 * static_cast<double>(sign);
      }
    sign = -sign;
  }
  CHECK(likelihood_of(data, residuals_in(data), no_discrepancy()).discrepancies[kind_of(kX)].sigma < 0.5);
  for (StageGroup& group : data.groups) group.local_shapes.setZero();
  CHECK(likelihood_of(data, residuals_in(data), no_discrepancy()).discrepancies[kind_of(kX)].sigma > 2);
}

TEST_CASE("A bin that no used run has changes nothing") {
  // the second run of a manoeuvre goes on for a second, and is not used
  LinearWorld world({1, 2, 4});
  std::vector<StageFeatures> longer = world.features;
  std::erase_if(longer[0].bins, [](const Bin& bin) { return bin.span >= 12; });
  const Whole noise = world.noise(1);
  std::vector<VectorXd> residuals = world.by_run(noise);
  const auto shortened = [&](const VectorXd& run) {
    VectorXd result(48);
    for (Index c = 0; c < 4; ++c) result.segment(12 * c, 12) = run.segment(16 * c, 12);
    return result;
  };
  residuals[0] = shortened(residuals[0]);
  NoiseFloor floor = world.floor();
  floor.sigma_of_bin[0].setOnes(48);
  for (OpenShapes& open : floor.open) open.local = open.numerics = MatrixXd::Zero(64, 0);
  floor.open[0].local = floor.open[0].numerics = MatrixXd::Zero(48, 0);

  const std::vector<bool> first_alone{true, false};
  const StageData with = stage_data(Passage::drive_to_body, longer, {{0, 1}}, residuals, floor, first_alone);
  const StageData without = stage_data(Passage::drive_to_body, longer, {{0}}, residuals, floor);
  REQUIRE(with.groups[0].bins.size() == 64);
  REQUIRE(without.groups[0].bins.size() == 48);

  Discrepancies discrepancies = no_discrepancy();
  discrepancies[kind_of(kX)] = {1, 2};
  const MatrixXd columns = MatrixXd::Random(64, 2);
  MatrixXd kept(48, 2);
  for (Index c = 0; c < 2; ++c) kept.col(c) = shortened(columns.col(c));
  CHECK((inner_products(with, whiteners_of(with, discrepancies), {columns}) -
         inner_products(without, whiteners_of(without, discrepancies), {kept}))
            .norm() < 1e-6);
  const auto chi_squared = [&](const StageData& data, const VectorXd& shift) {
    return likelihood_with(data, {data.groups[0].residual - shift}, discrepancies).chi_squared;
  };
  CHECK(chi_squared(with, columns.col(0)) == Approx(chi_squared(without, kept.col(0))));
  // deviances have another constant, which no comparison of models sees
  const auto gained = [&](const StageData& data, const VectorXd& shift) {
    return likelihood_with(data, {data.groups[0].residual}, discrepancies).deviance -
           likelihood_with(data, {data.groups[0].residual - shift}, discrepancies).deviance;
  };
  CHECK(gained(with, columns.col(0)) == Approx(gained(without, kept.col(0))));
  const Whole wander = world.wander(3, 2, 5);
  const VectorXd more = world.by_run(wander)[0];
  const Discrepancies a = likelihood_of(with, {with.groups[0].residual - more}, no_discrepancy()).discrepancies;
  const Discrepancies b =
      likelihood_of(without, {without.groups[0].residual - shortened(more)}, no_discrepancy()).discrepancies;
  CHECK(a[kind_of(kX)].sigma == Approx(b[kind_of(kX)].sigma).epsilon(0.05));
}
