// The likelihood of residuals against dense algebra: the covariance of all bins of all groups as one matrix.
#include "gap/diagnose/likelihood.hpp"

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "tests/gap/diagnose/linear_world.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::diagnose;
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
  group.number_shapes = 30 * MatrixXd::Random(7, 2);
  return group;
}

StageData small_data() {
  return {Passage::drive_to_body, {small_group(1), small_group(2)}};
}

Discrepancies small_discrepancies() {
  Discrepancies result = no_discrepancy();
  result.of_kind[kind_of(kX)] = {1.5, 0.7};
  result.of_kind[kind_of(kYaw)] = {0.4, 2};
  result.numbers_off = 0.02;
  return result;
}

// Of one group, but for shared shapes.
MatrixXd dense_covariance(const StageGroup& group, const Discrepancies& discrepancies) {
  MatrixXd covariance = group.local_shapes * group.local_shapes.transpose();
  covariance.diagonal() += group.variance;
  for (const Series& series : group.series)
    for (Index i = series.first; i < series.first + series.count; ++i)
      for (Index j = series.first; j < series.first + series.count; ++j) {
        const Discrepancy& d = discrepancies.of_kind[series.kind];
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

MatrixXd all_shared(const StageGroup& group, const Discrepancies& discrepancies) {
  MatrixXd all(group.shared_shapes.rows(), group.shared_shapes.cols() + group.number_shapes.cols());
  all << group.shared_shapes, discrepancies.numbers_off * group.number_shapes;
  return all;
}

// Of all groups together.
MatrixXd dense_covariance(const StageData& data, const Discrepancies& discrepancies) {
  std::vector<MatrixXd> shared;
  for (const StageGroup& group : data.groups) shared.push_back(all_shared(group, discrepancies));
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
  CHECK((inner_products(whiteners, columns) - dense()).norm() < 1e-10);
  const std::vector<double> weights{2, 1};
  const MatrixXd twice = inner_products(whiteners, columns, weights);
  const std::vector<double> without_first{0, 1};
  const MatrixXd second_alone = inner_products(whiteners, columns, without_first);
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
  MatrixXd normal = MatrixXd::Identity(4, 4);
  VectorXd along = VectorXd::Zero(4);
  std::vector<MatrixXd> own;
  for (const StageGroup& group : data.groups) {
    const MatrixXd shapes = all_shared(group, small_discrepancies());
    own.push_back(dense_covariance(group, small_discrepancies()));
    normal += shapes.transpose() * own.back().llt().solve(shapes);
    along += shapes.transpose() * own.back().llt().solve(group.residual);
  }
  const VectorXd amounts = normal.llt().solve(along);
  const std::vector<double> found = deviance_of_groups(data, residuals_in(data), small_discrepancies());
  const std::vector<VectorXd> white = whitened_rest(data, residuals_in(data), small_discrepancies());
  REQUIRE(found.size() == 2);
  for (std::size_t g = 0; g < 2; ++g) {
    const VectorXd rest = data.groups[g].residual - all_shared(data.groups[g], small_discrepancies()) * amounts;
    const double squares = rest.dot(own[g].llt().solve(rest));
    CHECK(white[g].squaredNorm() == Approx(squares));
    CHECK(found[g] == Approx(squares + log_determinant(own[g])));
  }
}

TEST_CASE("Nothing need be left open by the simulation") {
  StageData data = small_data();
  for (StageGroup& group : data.groups)
    group.local_shapes.resize(7, 0), group.shared_shapes.resize(7, 0), group.number_shapes.resize(7, 0);
  double deviance = 0, squares = 0;
  for (const StageGroup& group : data.groups) {
    squares += group.residual.dot(group.residual.cwiseQuotient(group.variance));
    deviance += group.variance.array().log().sum();
  }
  CHECK(likelihood_with(data, residuals_in(data), no_discrepancy()).chi_squared == Approx(squares));
  CHECK(likelihood_with(data, residuals_in(data), no_discrepancy()).deviance == Approx(squares + deviance));
}

TEST_CASE("The discrepancy of a drift is found in the channels that drift, and makes the data more likely") {
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
  CHECK(found.discrepancies.of_kind[kind_of(kX)].sigma == Approx(2).epsilon(0.48));
  for (std::size_t k = 0; k < kind_count(); ++k)
    if (k != kind_of(kX)) CHECK(found.discrepancies.of_kind[k].sigma < 0.4);
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
  CHECK(likelihood_of(data, residuals_in(data), no_discrepancy()).discrepancies.of_kind[kind_of(kX)].sigma < 0.5);
  for (StageGroup& group : data.groups) group.local_shapes.setZero();
  CHECK(likelihood_of(data, residuals_in(data), no_discrepancy()).discrepancies.of_kind[kind_of(kX)].sigma > 2);
}

// `gap`, and 12 numbers, each of which shifts the stage by 1000 in noise where it is off by all of itself.
StageData with_numbers(const LinearWorld& world, const Whole& gap) {
  StageData data = world.data(gap);
  const std::size_t groups = data.groups.size();
  for (std::size_t g = 0; g < groups; ++g) data.groups[g].number_shapes.resize(data.groups[g].residual.size(), 12);
  for (Index i = 0; i < 12; ++i) {
    const std::vector<VectorXd> shape = mean_of_groups(data, world.by_run(1000 * world.direction(i)));
    for (std::size_t g = 0; g < groups; ++g) data.groups[g].number_shapes.col(i) = shape[g];
  }
  return data;
}

TEST_CASE("How far numbers are off is found, and takes what they do out of the discrepancy") {
  // off by 2 %, by 20 in noise
  const LinearWorld world({4, 2, 20});
  const auto data_with = [&](double off) {
    std::mt19937_64 random(3);
    std::normal_distribution<double> normal;
    Whole gap = world.noise(1);
    for (Index i = 0; i < 12; ++i) gap += 1000 * off * normal(random) * world.direction(i);
    return with_numbers(world, gap);
  };
  const StageData off = data_with(0.02), exact = data_with(0);
  const Likelihood found = likelihood_of(off, residuals_in(off), no_discrepancy());
  // a standard deviation from 12 numbers is known to 1 / sqrt(24) of it: three of these
  CHECK(found.discrepancies.numbers_off == Approx(0.02).epsilon(0.61));
  for (const Discrepancy& discrepancy : found.discrepancies.of_kind) CHECK(discrepancy.sigma < 0.3);
  // in noise a number that is right looks off by 1 in 1000
  CHECK(likelihood_of(exact, residuals_in(exact), no_discrepancy()).discrepancies.numbers_off < 0.002);
}

TEST_CASE("Intervals allow for a size of the numbers' errors that so few numbers tell badly") {
  // 12 numbers off by +-0.5 %, each known to 0.1 %: with S = 12 0.005^2 the likelihood of their sigma is
  // sigma^-12 exp(-S / (2 sigma^2)), largest at sigma^2 = S / 12. With a uniform prior its mean of sigma^2 is S / 9, as
  // the integral of sigma^-m exp(-S / (2 sigma^2)) goes as S^((1 - m) / 2) Gamma((m - 1) / 2).
  const LinearWorld world({4, 2, 20});
  Whole gap = world.noise(1);
  for (Index i = 0; i < 12; ++i) gap += 1000 * (i % 2 == 0 ? 0.005 : -0.005) * world.direction(i);
  const StageData data = with_numbers(world, gap);
  const GroupVectors residual = residuals_in(data);
  const Discrepancies found = likelihood_of(data, residual, no_discrepancy()).discrepancies;
  CHECK(found.numbers_off == Approx(0.005).epsilon(0.15));
  CHECK(numbers_off_of_intervals(data, residual, found) / found.numbers_off ==
        Approx(std::sqrt(12.0 / 9)).epsilon(0.05));

  // a number off by a half reaches the limit of small errors: no larger size is allowed for
  const StageData half = with_numbers(world, world.noise(1) + 1000 * 0.5 * world.direction(0));
  const Discrepancies limited = likelihood_of(half, residuals_in(half), no_discrepancy()).discrepancies;
  CHECK(numbers_off_of_intervals(half, residuals_in(half), limited) == Approx(limited.numbers_off).epsilon(0.2));
  CHECK(numbers_off_of_intervals(data, residual, no_discrepancy()) == 0);
}

TEST_CASE("A number that is off by a half is none of many that are a little off: it is left to the discrepancy") {
  // 500 in noise, all over 4 x 4 x 20 cells of 8 bins: 500 / sqrt(2560) = 10 in each bin. The numbers may take 14.3 %
  // off by 50 %, so 7 are left. A number then shifts by S = 1000 / 7 sigma, and takes rho^2 S^2 / (1 + rho^2 S^2) of
  // what it could, which is 14.3 / 50 where rho is 0.63 / S
  const LinearWorld world({4, 2, 20});
  const auto found_with = [&](double off) {
    const StageData data = with_numbers(world, world.noise(1) + 1000 * off * world.direction(0));
    return likelihood_of(data, residuals_in(data), no_discrepancy()).discrepancies;
  };
  const Discrepancies half = found_with(0.5);
  CHECK(half.numbers_off == Approx(0.63 * 7 / 1000).epsilon(0.6));
  for (const auto channel : {"track_left_mps", "battery_v", "x_m", "yaw_rad"}) {
    std::size_t c = 0;
    while (diagnosis_channels()[c].column != channel) ++c;
    CHECK(half.of_kind[kind_of(c)].sigma == Approx(7).epsilon(0.5));
  }
  // by 8 % it is one of them: with eleven that are right, the rms of all is 2.3 %
  const Discrepancies little = found_with(0.08);
  CHECK(little.numbers_off == Approx(0.08 / std::sqrt(12.0)).epsilon(0.2));
  for (const Discrepancy& discrepancy : little.of_kind) CHECK(discrepancy.sigma < 0.3);
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

  const StageData with = stage_data(Passage::drive_to_body, longer, {{0, 1}}, residuals, floor, UsedParts::of({0}));
  const StageData without = stage_data(Passage::drive_to_body, longer, {{0}}, residuals, floor);
  REQUIRE(with.groups[0].bins.size() == 64);
  REQUIRE(without.groups[0].bins.size() == 48);

  Discrepancies discrepancies = no_discrepancy();
  discrepancies.of_kind[kind_of(kX)] = {1, 2};
  const MatrixXd columns = MatrixXd::Random(64, 2);
  MatrixXd kept(48, 2);
  for (Index c = 0; c < 2; ++c) kept.col(c) = shortened(columns.col(c));
  CHECK((inner_products(whiteners_of(with, discrepancies), {columns}) -
         inner_products(whiteners_of(without, discrepancies), {kept}))
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
  CHECK(a.of_kind[kind_of(kX)].sigma == Approx(b.of_kind[kind_of(kX)].sigma).epsilon(0.05));
}
