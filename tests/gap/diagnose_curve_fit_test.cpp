// Least squares on curves: answers that geometry gives.
#include "gap/diagnose/curve_fit.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "gap/diagnose/coherence.hpp"
#include "tests/gap/linear_world.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using test::LinearWorld;
using test::Whole;
using test::world;

namespace {

Products products(const EffectCurves& curves) {
  return products_of(curves, curves.gap);
}

// One run of two numbers, in which a single effect goes along the given points.
EffectCurves bent(const std::vector<std::pair<double, Eigen::Vector2d>>& points, const Eigen::Vector2d& gap) {
  EffectCurves curves;
  curves.gap = curves.residual = {gap};
  curves.shifts = {Eigen::MatrixXd(2, 0)};
  curves.curves.push_back({nullptr, nullptr, {}, 0});
  for (const auto& [value, shift] : points) {
    const bool neutral = shift.norm() == 0;
    curves.curves[0].points.push_back({value, neutral ? -1 : static_cast<int>(curves.shifts[0].cols()), true});
    if (neutral) continue;
    curves.shifts[0].conservativeResize(Eigen::NoChange, curves.shifts[0].cols() + 1);
    curves.shifts[0].rightCols(1) = shift;
  }
  curves.raw_shifts = curves.shifts;
  return curves;
}

}  // namespace

TEST_CASE("Products are summed in the same order whatever caches the processor has") {
  CHECK(Eigen::l1CacheSize() == Eigen::internal::defaultL1CacheSize);
  CHECK(Eigen::l2CacheSize() == Eigen::internal::defaultL2CacheSize);
  CHECK(Eigen::l3CacheSize() == Eigen::internal::defaultL3CacheSize);
}

TEST_CASE("One effect alone is found exactly, with nothing left") {
  const Whole shift = 20 * world().direction(0);
  for (const double value : {-0.9, -0.1, 0.0, 0.25, 0.7}) {
    const EffectCurves curves = world().curves({shift}, value * shift);
    const CurveFit fit = fit_one(products(curves), curves.curves, 0);
    CHECK(fit.places[0].value == Approx(value).margin(1e-12));
    CHECK(fit.left == Approx(0).margin(1e-9));
    CHECK((shift_at(curves.shifts[1], fit.places) - value * LinearWorld::by_run(shift)[1]).norm() < 1e-9);
    CHECK(left_with(products(curves), fit.places) == Approx(fit.left).margin(1e-9));
  }
}

TEST_CASE("What is across an effect is left") {
  const EffectCurves curves =
      world().curves({20 * world().direction(0)}, 10 * world().direction(0) + 3 * world().direction(1));
  const CurveFit fit = fit_one(products(curves), curves.curves, 0);
  CHECK(fit.places[0].value == Approx(0.5));
  CHECK(fit.left == Approx(9));
}

TEST_CASE("A value stays within the parameter's range") {
  const Whole shift = 20 * world().direction(0);
  const EffectCurves curves = world().curves({shift}, -1.5 * shift);
  const CurveFit fit = fit_one(products(curves), curves.curves, 0);
  CHECK(fit.places[0].value == Approx(-1));
  CHECK(fit.left == Approx(100));  // (0.5 x 20)^2
}

TEST_CASE("A bent curve: the nearest place on it") {
  // along x to (2, 0) at value 1, then up to (2, 2) at value 3
  const std::vector<std::pair<double, Eigen::Vector2d>> points{{0, {0, 0}}, {1, {2, 0}}, {3, {2, 2}}};
  struct Nearest {
    Eigen::Vector2d gap;
    double value, left;
  };
  for (const Nearest& nearest : {Nearest{{1, -1}, 0.5, 1}, Nearest{{3, 1}, 2, 1}, Nearest{{3, -1}, 1, 2},
                                 Nearest{{-1, 0}, 0, 1}, Nearest{{2, 5}, 3, 9}}) {
    const EffectCurves curves = bent(points, nearest.gap);
    const CurveFit fit = fit_one(products(curves), curves.curves, 0);
    CHECK(fit.places[0].value == Approx(nearest.value).margin(1e-12));
    CHECK(fit.left == Approx(nearest.left));
  }
  const EffectCurves curves = bent(points, {0, 0});
  const OnCurve place = at_value(curves.curves, 0, 2);
  CHECK((shift_at(curves.shifts[0], {&place, 1}) - Eigen::Vector2d(2, 1)).norm() < 1e-12);
}

TEST_CASE("Two effects at 60 degrees are told apart by both inner products") {
  const Whole a = world().direction(0), b = world().direction(0) / 2 + std::sqrt(0.75) * world().direction(1);
  const EffectCurves curves = world().curves({20 * a, 20 * b}, 6 * a - 8 * b + 2 * world().direction(2));
  const CurveFit fit = fit_two(products(curves), curves.curves, 0, 1);
  CHECK(fit.places[0].value == Approx(0.3));
  CHECK(fit.places[1].value == Approx(-0.4));
  CHECK(fit.left == Approx(4));
  CHECK(left_with(products(curves), fit.places) == Approx(4));
  // alone, the first one takes what of the other lies along it: 6 - 8 / 2 = 2 of 20
  CHECK(fit_one(products(curves), curves.curves, 0).places[0].value == Approx(0.1));
}

TEST_CASE("Two effects of which one is at its bound: the other makes up for it") {
  const Whole a = world().direction(0), b = world().direction(0) / 2 + std::sqrt(0.75) * world().direction(1);
  const EffectCurves curves = world().curves({20 * a, 20 * b}, 30 * a);
  const CurveFit fit = fit_two(products(curves), curves.curves, 0, 1);
  CHECK(fit.places[0].value == Approx(1));
  CHECK(fit.places[1].value == Approx(0.25));  // 10 a . b = 5 of 20
  CHECK(fit.left == Approx(75));               // 10^2 - 5^2
}

TEST_CASE("Two effects that do the same share one explanation") {
  const Whole a = 20 * world().direction(0);
  const EffectCurves curves = world().curves({a, a}, 0.8 * a);
  const CurveFit fit = fit_two(products(curves), curves.curves, 0, 1);
  CHECK(fit.left == Approx(0).margin(1e-9));
  CHECK(fit.places[0].value + fit.places[1].value == Approx(0.8));
}

TEST_CASE("Four effects, each at 60 degrees to the others, are told apart") {
  // edges of a simplex: inner products of 1/2
  std::vector<Whole> effects;
  for (std::size_t i = 0; i < 4; ++i)
    effects.push_back(20 * (world().direction(4) + world().direction(i)) / std::sqrt(2.0));
  const double values[] = {0.3, -0.4, 0.1, 0.6};
  Whole gap = 2 * world().direction(5);
  for (std::size_t i = 0; i < 4; ++i) gap += values[i] * effects[i];
  const EffectCurves curves = world().curves(effects, gap);
  for (const std::vector<std::size_t>& order : {std::vector<std::size_t>{0, 1, 2, 3}, {3, 1, 0, 2}}) {
    const CurveFit fit = fit_together(products(curves), curves.curves, order);
    REQUIRE(fit.places.size() == 4);
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK(fit.places[i].curve == order[i]);
      // turns end when one gains less than a millionth of the 4 that are left: 0.002 of 20
      CHECK(fit.places[i].value == Approx(values[order[i]]).margin(1e-3));
    }
    CHECK(fit.left == Approx(4).epsilon(1e-5));
  }
}

TEST_CASE("Weights of runs: a run counts as often as it is drawn") {
  const Whole shift = 20 * world().direction(0);
  Whole gap = 0.2 * shift;
  gap.head(2 * LinearWorld::kBinsOfRun) = 0.6 * shift.head(2 * LinearWorld::kBinsOfRun);  // runs 0 and 1
  const EffectCurves curves = world().curves({shift}, gap);
  const std::vector<Products> runs = products_of_runs(curves, curves.gap);
  const auto value = [&](std::vector<double> weights) {
    return fit_one(weighted_sum(runs, weights), curves.curves, 0).places[0].value;
  };
  CHECK(value({1, 1, 0, 0}) == Approx(0.6));
  CHECK(value({0, 0, 2, 1}) == Approx(0.2));
  // by how much each run shows of the effect, times its weight
  const double first = runs[0].shift_shift(3, 3), second = runs[2].shift_shift(3, 3);
  CHECK(value({3, 0, 1, 0}) == Approx((3 * first * 0.6 + second * 0.2) / (3 * first + second)));
}

TEST_CASE("Energy of cells: of noise near their count, of a constant gap growing with the bins of a cell") {
  const Coherence coherence = world().coherence();
  REQUIRE(coherence.cell_count() == LinearWorld::kCells);
  // a sum of 24 squares of standard normals has a sigma of sqrt(48) = 7; of the mean of 100 of them 0.7
  double sum = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed)
    sum += coherence.energy(LinearWorld::by_run(LinearWorld::noise(seed)));
  CHECK(sum / 100 == Approx(24).margin(2.8));
  // 8 bins of 0.5 sum to 4; over sqrt(8), squared: 2 for each cell, 8 times a single bin's square
  const Whole constant = Whole::Constant(LinearWorld::kBins, 0.5);
  CHECK(coherence.energy(LinearWorld::by_run(constant)) == Approx(24 * 8 * 0.25));
  // in spans half as long it is half as much in each of twice as many cells
  const Coherence finer(world().features, LinearWorld::repeats, 0.5);
  CHECK(finer.cell_count() == 48);
  CHECK(finer.energy(LinearWorld::by_run(constant)) == Approx(48 * 4 * 0.25));
  // what repeats do not share, or what alternates within a cell, is no coherent gap
  Whole opposed = constant;
  opposed.segment(LinearWorld::kBinsOfRun, LinearWorld::kBinsOfRun) *= -1;
  opposed.tail(LinearWorld::kBinsOfRun) *= -1;
  CHECK(coherence.energy(LinearWorld::by_run(opposed)) == Approx(0).margin(1e-9));
}

TEST_CASE("A cell says which group, channel and second it is") {
  Whole gap = Whole::Zero(LinearWorld::kBins);
  gap.segment(2 * LinearWorld::kBinsOfRun + 12 + 4, 4)
      .setConstant(3);  // run 2: the second group; the voltage; the second second
  for (const Cell& cell : world().coherence().cells(LinearWorld::by_run(gap))) {
    const bool here = cell.group == 1 && diagnosis_channels()[cell.channel].column == "battery_v" && cell.stretch == 1;
    CHECK(cell.z == Approx(here ? 12 / std::sqrt(8.0) : 0).margin(1e-12));
  }
}
