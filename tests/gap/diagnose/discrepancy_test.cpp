// A discrepancy that is coherent in time: the Kalman filter against dense algebra, and what is found of drawn series.
#include "gap/diagnose/discrepancy.hpp"

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::diagnose;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// In noise of variance `noise` a process of `sigma` and `memory_s`, bins of 0.25 s.
SeriesOfKind drawn_series(Index count, double noise, double sigma, double memory_s, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  SeriesOfKind series{{}, VectorXd::Constant(count, noise), VectorXd(count)};
  const double decay = std::exp(-0.25 / memory_s);
  double state = sigma * normal(random);
  for (Index i = 0; i < count; ++i) {
    series.t_s.push_back(0.25 * static_cast<double>(i));
    series.value[i] = state + std::sqrt(noise) * normal(random);
    state = decay * state + sigma * std::sqrt(1 - decay * decay) * normal(random);
  }
  return series;
}

std::vector<SeriesOfKind> drawn_kind(double noise, double sigma, double memory_s, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<SeriesOfKind> kind;
  for (int i = 0; i < 8; ++i) kind.push_back(drawn_series(200, noise, sigma, memory_s, random));
  return kind;
}

}  // namespace

TEST_CASE("Whitening a series is the inverse of a Cholesky factor of its covariance, at any times") {
  const std::vector<double> t_s{0.125, 0.375, 0.625, 1.875, 1.9, 6, 6.25, 30};
  const VectorXd variance = (VectorXd(8) << 1, 2, 0.5, 1, 4, 0.01, 1, 3).finished();
  for (const Discrepancy discrepancy : {Discrepancy{0.7, 1.3}, Discrepancy{5, 0.1}, Discrepancy{2, 40}}) {
    MatrixXd covariance = variance.asDiagonal();
    for (Index i = 0; i < 8; ++i)
      for (Index j = 0; j < 8; ++j)
        covariance(i, j) += discrepancy.sigma * discrepancy.sigma *
                            std::exp(-std::abs(t_s[static_cast<std::size_t>(i)] - t_s[static_cast<std::size_t>(j)]) /
                                     discrepancy.memory_s);
    const MatrixXd factor = covariance.llt().matrixL();
    const SeriesWhitener whitener(t_s, variance, discrepancy);
    MatrixXd white = MatrixXd::Identity(8, 8);
    whitener.whiten(white);
    CHECK((white * factor - MatrixXd::Identity(8, 8)).norm() < 1e-10);
    CHECK(whitener.log_determinant() == Approx(2 * factor.diagonal().array().log().sum()).margin(1e-10));
    MatrixXd value = VectorXd::LinSpaced(8, -3, 5);
    const double quadratic_form = value.col(0).dot(covariance.llt().solve(value.col(0)));
    whitener.whiten(value);
    CHECK(value.squaredNorm() == Approx(quadratic_form));
  }
}

TEST_CASE("Without a discrepancy whitening divides by sigma") {
  const std::vector<double> t_s{0, 1, 1.5};
  const VectorXd variance = (VectorXd(3) << 4, 0.25, 9).finished();
  const SeriesWhitener whitener(t_s, variance, {0, 2});
  MatrixXd value = (VectorXd(3) << 1, 1, 6).finished();
  whitener.whiten(value);
  CHECK((value - (VectorXd(3) << 0.5, 2, 2).finished()).norm() < 1e-15);
  CHECK(whitener.log_determinant() == Approx(std::log(9.0)));  // 4 x 1/4 x 9
}

// 8 series of 50 s hold about 8 x 50 / (2 x memory) numbers that are free: at 2 s 100, of which sigma is known to
// 1 / sqrt(200) = 7 %, at 6 s to 12 %. Allowed are three to four times that.
TEST_CASE("Size and memory of a discrepancy are found again") {
  struct Truth {
    double sigma, memory_s, bound;
  };
  for (const Truth truth : {Truth{2, 2, 0.25}, Truth{1, 0.7, 0.25}, Truth{3, 6, 0.4}})
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      const Discrepancy found = most_likely_discrepancy(drawn_kind(1, truth.sigma, truth.memory_s, seed));
      INFO(truth.sigma << " with " << truth.memory_s << " s, seed " << seed);
      CHECK(found.sigma == Approx(truth.sigma).epsilon(truth.bound));
      CHECK(found.memory_s == truth.memory_s);  // of those that are tried, neighbours are a factor of three apart
    }
}

TEST_CASE("The unit of a discrepancy is that of its series") {
  std::vector<SeriesOfKind> series = drawn_kind(1, 2, 2, 7);
  const Discrepancy metres = most_likely_discrepancy(series);
  for (SeriesOfKind& one : series) one.value *= 1000, one.variance *= 1e6;
  const Discrepancy millimetres = most_likely_discrepancy(series);
  CHECK(millimetres.sigma == Approx(1000 * metres.sigma));
  CHECK(millimetres.memory_s == metres.memory_s);
}

// Of 1600 bins the variance is known to sqrt(2 / 1600) = 3.5 %, and neighbours' covariance to 2.5 %; a process that
// adds more than four times that would be seen: sigma^2 of 0.1, and 0.3 of noise's sigma.
TEST_CASE("In white noise there is no discrepancy to speak of") {
  int none = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Discrepancy found = most_likely_discrepancy(drawn_kind(1, 0, 1, 100 + seed));
    CHECK(found.sigma < 0.32);
    none += found.sigma == 0;
  }
  CHECK(none >= 2);  // more often than not something is a little more likely than nothing
  CHECK(most_likely_discrepancy({}).sigma == 0);
}

TEST_CASE("A series that counts twice is one that is there twice") {
  std::vector<SeriesOfKind> twice = drawn_kind(1, 1, 2, 3), weighted = twice;
  twice.push_back(twice.front());
  weighted.front().weight = 2;
  const Discrepancy a = most_likely_discrepancy(twice), b = most_likely_discrepancy(weighted);
  CHECK(a.sigma == Approx(b.sigma).epsilon(0.04));
  CHECK(a.memory_s == b.memory_s);
}
