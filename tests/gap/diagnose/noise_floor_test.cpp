// The noise floor: what the data say of noise, and numbers that are standard normal where there is no gap.
#include "gap/diagnose/noise_floor.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "gap/diagnose/channels.hpp"
#include "tests/gap/made_run.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::diagnose;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// A run of x alone, 1000 bins of 0.25 s with two samples each.
constexpr std::size_t kBins = 1000;
StageFeatures features_of(const runs::Run& run) {
  return stage_features(Passage::drive_to_body, FeatureMap(run, 0.25), run);
}
const StageFeatures& long_run() {
  static const StageFeatures features = features_of(test::made_run(250, 0.125, {{"x_m", [](double) { return 0.0; }}}));
  return features;
}

// With nothing left open by the simulation.
OpenShapes closed(Eigen::Index bins = kBins) {
  return {MatrixXd(bins, 0), MatrixXd(bins, 0), VectorXd::Zero(bins)};
}
OpenShapes rough(const VectorXd& roughness) {
  OpenShapes open = closed(roughness.size());
  open.roughness = roughness;
  return open;
}

VectorXd white(double sigma, std::mt19937_64& random) {
  std::normal_distribution<double> normal(0, sigma);
  return VectorXd::NullaryExpr(kBins, [&] { return normal(random); });
}

NoiseFloor floor_of(const std::vector<VectorXd>& residuals, const std::vector<std::vector<std::size_t>>& repeats) {
  const std::vector<StageFeatures> features(residuals.size(), long_run());
  return noise_floor(features, residuals, repeats, std::vector<OpenShapes>(residuals.size(), closed()));
}
double sigma_of_x(const NoiseFloor& floor) {
  return floor.sigma[long_run().bins[0].channel];
}

MatrixXd as_matrix(const Whitener& whitener, Eigen::Index size) {
  MatrixXd result(size, size);
  for (Eigen::Index i = 0; i < size; ++i) result.col(i) = whitener(VectorXd::Unit(size, i));
  return result;
}

}  // namespace

// What somebody knows of a sample is sigma / sqrt(2) of a bin of two samples.
TEST_CASE("A noise that is stated stands where nothing repeats, and gives way to repeats") {
  std::mt19937_64 random(4);
  const std::vector<StageFeatures> features(2, long_run());
  const std::vector<OpenShapes> none_open(2, closed());
  const std::vector<VectorXd> residuals{white(0.02, random), white(0.02, random)};
  std::vector<double> stated(diagnosis_channels().size(), 0);
  CHECK(sigma_of_x(noise_floor(features, residuals, {{0}, {1}}, none_open, stated)) == Approx(0.02).epsilon(0.15));
  stated[long_run().bins[0].channel] = 0.1;
  const double alone = sigma_of_x(noise_floor(features, residuals, {{0}, {1}}, none_open, stated));
  CHECK(alone == Approx(0.1 / std::sqrt(2)));
  CHECK(sigma_of_x(noise_floor(features, residuals, {{0, 1}}, none_open, stated)) == Approx(0.02).epsilon(0.15));
}

// A median of absolute values knows sigma to 1.17 / sqrt(n); that neighbouring second differences share bins makes it
// about 1.6 / sqrt(n): 2.6 % of 4000 bins, so 10 % is nearly four sigma.
TEST_CASE("White noise is found again, from residuals and from repeats, also under a gap that changes slowly") {
  std::mt19937_64 random(3);
  const double sigma = 0.02;
  std::vector<VectorXd> residuals;
  for (int r = 0; r < 4; ++r) residuals.push_back(white(sigma, random));
  CHECK(sigma_of_x(floor_of(residuals, {{0}, {1}, {2}, {3}})) == Approx(sigma).epsilon(0.1));
  CHECK_FALSE(floor_of(residuals, {{0}, {1}, {2}, {3}}).from_repeats);
  CHECK(sigma_of_x(floor_of(residuals, {{0, 1}, {2, 3}})) == Approx(sigma).epsilon(0.1));
  CHECK(floor_of(residuals, {{0, 1}, {2, 3}}).from_repeats);
  // of a sine with a period of 100 bins a second difference leaves (2 pi / 100)^2 = 0.4 %
  for (VectorXd& run : residuals)
    for (Eigen::Index i = 0; i < run.size(); ++i) run[i] += 10 * sigma * std::sin(0.0628 * static_cast<double>(i));
  CHECK(sigma_of_x(floor_of(residuals, {{0}, {1}, {2}, {3}})) == Approx(sigma).epsilon(0.1));
}

TEST_CASE("A twentieth of the bins at which something happens does not count as noise") {
  std::mt19937_64 random(4);
  std::vector<VectorXd> residuals{white(0.02, random), white(0.02, random)};
  // three second differences of each event, so a sixth of all: the median is then the quantile 0.5 / (5 / 6) = 0.6 of
  // the noise's, 0.84 sigma where half is 0.67 sigma
  for (Eigen::Index i = 0; i < residuals[0].size(); i += 20) residuals[0][i] += 5;
  const double sigma = sigma_of_x(floor_of(residuals, {{0}, {1}}));
  CHECK(sigma < 0.02 * 0.84 / 0.67 * 1.1);
}

TEST_CASE("Nothing is known finer than a channel's resolution, what was never measured has no sigma") {
  const NoiseFloor floor = floor_of({VectorXd::Zero(kBins), VectorXd::Zero(kBins)}, {{0, 1}});
  for (std::size_t c = 0; c < diagnosis_channels().size(); ++c)
    CHECK(floor.sigma[c] == (c == long_run().bins[0].channel ? diagnosis_channels()[c].resolution : 0));
}

TEST_CASE("A wander too slow to show from bin to bin shows in repeats") {
  // two repeats that lie 1.5 sigma x sqrt(2) above and below their mean: as one run's, a variance of 2 x 4.5 sigma^2,
  // with the noise 10 sigma^2. Leaving the largest 5 % of squares out costs 4 % of its root, the draw 3 %.
  std::mt19937_64 random(5);
  const double sigma = 0.02, apart = 1.5 * std::sqrt(2) * sigma;
  std::vector<VectorXd> residuals{white(sigma, random), white(sigma, random)};
  residuals[0].array() += apart;
  residuals[1].array() -= apart;
  CHECK(sigma_of_x(floor_of(residuals, {{0, 1}})) == Approx(std::sqrt(10) * sigma).epsilon(0.1));
  CHECK(sigma_of_x(floor_of(residuals, {{0}, {1}})) == Approx(sigma).epsilon(0.15));  // unseen: half the bins of above
}

TEST_CASE("One manoeuvre whose repeats differ by chance is no noise of the others") {
  std::mt19937_64 random(9);
  const double sigma = 0.02;
  std::vector<VectorXd> residuals;
  for (int r = 0; r < 6; ++r) residuals.push_back(white(sigma, random));
  residuals[4].array() += 1;  // stuck a metre from where the other one got to
  const NoiseFloor floor = floor_of(residuals, {{0, 1}, {2, 3}, {4, 5}});
  CHECK(sigma_of_x(floor) == Approx(sigma).epsilon(0.1));
  CHECK(floor.sigma_of_bin[0][7] == Approx(sigma).epsilon(0.1));
  // half a metre each from their mean, as one run's variance twice that
  CHECK(floor.sigma_of_bin[5][7] == Approx(std::sqrt(0.5)).epsilon(0.1));
}

TEST_CASE("Where one repeat goes on alone nothing is learnt of noise, and nothing is lost") {
  const StageFeatures half = features_of(test::made_run(125, 0.125, {{"x_m", [](double) { return 0.0; }}}));
  std::mt19937_64 random(7);
  const VectorXd whole = white(0.02, random), first = white(0.02, random).head(kBins / 2);
  const NoiseFloor floor =
      noise_floor({long_run(), half}, {whole, first}, {{0, 1}}, {closed(kBins), closed(kBins / 2)});
  // 500 pairs: 1.6 / sqrt(500) = 7 %, of which 3 are allowed
  CHECK(sigma_of_x(floor) == Approx(0.02).epsilon(0.21));
}

TEST_CASE("A bin with half the samples has sqrt(2) of the noise, roughness adds to it") {
  const StageFeatures run =
      features_of(test::made_run(1, 0.125, {{"x_m", [](double t_s) { return t_s > 0.8 ? NAN : 0.0; }}}));
  REQUIRE(run.bins.back().samples == 1);
  const VectorXd none = VectorXd::Zero(4);
  OpenShapes open = closed(4);
  open.roughness[0] = 5e-4 * std::sqrt(3);
  const NoiseFloor floor = noise_floor({run}, {none}, {{0}}, {open});
  CHECK(floor.sigma_of_bin[0][3] == Approx(5e-4 * std::sqrt(2)));
  CHECK(floor.sigma_of_bin[0][0] == Approx(5e-4 * 2));  // sqrt(1 + 3)
  CHECK(floor.rms({VectorXd(floor.sigma_of_bin[0] * 3)}) == Approx(3));
}

TEST_CASE("Whitened, noise with shapes of unknown amount has the covariance of independent standard normals") {
  const VectorXd sigma = (VectorXd(4) << 1, 2, 0.5, 3).finished();
  MatrixXd shapes(4, 3);
  shapes << 1, 0, 2, -3, 1, 4, 0.5, 0.2, 1, 2, 2, 4;  // a column that nearly repeats another one too
  const MatrixXd covariance = MatrixXd(sigma.cwiseAbs2().asDiagonal()) + shapes * shapes.transpose();
  const MatrixXd whiten = as_matrix(Whitener(sigma, shapes), 4);
  CHECK((whiten * covariance * whiten.transpose() - MatrixXd::Identity(4, 4)).norm() < 1e-12);
}

TEST_CASE("A shift along a shape s sigma long shrinks to 1 / sqrt(1 + s^2), one across it stays") {
  const VectorXd sigma = VectorXd::Constant(4, 0.1);
  const MatrixXd shape = (MatrixXd(4, 1) << 0.3, 0, 0.4, 0).finished();  // 5 sigma long
  const Whitener whitener(sigma, shape);
  CHECK(whitener(shape.col(0)).norm() == Approx(5 / std::sqrt(26.0)));
  CHECK(whitener((VectorXd(4) << 0, 0.2, 0, 0).finished()).norm() == Approx(2));
  CHECK(whitener((VectorXd(4) << 0.4, 0, -0.3, 0).finished()).norm() == Approx(5));
}

TEST_CASE("Around another model bins are as rough as the rougher one has them") {
  // noise is x's resolution, 5e-4; roughness in units of it: of the nominal model, of the other one, and by hand
  const StageFeatures run = features_of(test::made_run(1, 0.125, {{"x_m", [](double) { return 0.0; }}}));
  REQUIRE(run.bins.size() == 4);
  const VectorXd none = VectorXd::Zero(4), nominal_rough = (VectorXd(4) << 0, 0, 1, 2).finished(),
                 other_rough = (VectorXd(4) << 0, 1, 1, 1).finished();
  const NoiseFloor nominal = noise_floor({run}, {none}, {{0}}, {rough(5e-4 * nominal_rough)});
  const NoiseFloor around = with_open_shapes(nominal, {rough(5e-4 * other_rough)});
  const double expected[] = {1, std::sqrt(2), std::sqrt(2), std::sqrt(5)};
  for (Eigen::Index b = 0; b < 4; ++b) CHECK(around.sigma_of_bin[0][b] == Approx(5e-4 * expected[b]));
  // and from there on to a third: the roughness of all that it was taken around before
  const NoiseFloor third = with_open_shapes(around, {closed(4)});
  for (Eigen::Index b = 0; b < 4; ++b) CHECK(third.sigma_of_bin[0][b] == Approx(5e-4 * expected[b]));
}

TEST_CASE("Local and numeric shapes are open alike in a run's floor, and another model brings its own") {
  const StageFeatures run = features_of(test::made_run(1, 0.125, {{"x_m", [](double) { return 0.0; }}}));
  const double sigma = diagnosis_channels()[run.bins[0].channel].resolution;
  OpenShapes open = closed(4);
  open.local = 3 * sigma * VectorXd::Unit(4, 0);
  open.numerics = 7 * sigma * VectorXd::Unit(4, 2);
  const NoiseFloor floor = noise_floor({run}, {VectorXd::Zero(4)}, {{0}}, {open});
  const VectorXd white = floor.whiteners[0](VectorXd::Constant(4, sigma));
  // variances of 1, and 1 + 3^2, and 1 + 7^2
  CHECK(white[0] == Approx(1 / std::sqrt(10.0)));
  CHECK(white[1] == Approx(1));
  CHECK(white[2] == Approx(1 / std::sqrt(50.0)));
  CHECK((with_open_shapes(floor, {closed(4)}).whiteners[0](VectorXd::Constant(4, sigma)) - VectorXd::Ones(4)).norm() <
        1e-12);
}

TEST_CASE("What repeats differ by is measured over the bins that more than one of them has") {
  // the second one ends half way; each is off from their mean by half of 6, as one run's sqrt(2) times that
  const StageFeatures whole = features_of(test::made_run(1, 0.125, {{"x_m", [](double) { return 0.0; }}}));
  const StageFeatures half = features_of(test::made_run(0.5, 0.125, {{"x_m", [](double) { return 0.0; }}}));
  NoiseFloor floor;
  for (const Eigen::Index bins : {4, 2}) floor.whiteners.emplace_back(VectorXd::Ones(bins), MatrixXd(bins, 0));
  const std::vector<VectorXd> residuals{VectorXd::Constant(4, 6), VectorXd::Zero(2)};
  const auto rms = [&](const std::vector<std::vector<std::size_t>>& repeats) {
    return rms_of_repeats(floor, deviations_from_repeats({whole, half}, residuals, repeats));
  };
  CHECK(rms({{0, 1}}) == Approx(3 * std::sqrt(2.0)));
  CHECK(rms({{0}, {1}}) == 1);
}
