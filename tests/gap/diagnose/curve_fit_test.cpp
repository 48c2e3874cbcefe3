// Least squares on curves: answers that geometry gives.
#include "gap/diagnose/curve_fit.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "gap/diagnose/model_search.hpp"
#include "tests/gap/diagnose/linear_world.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::diagnose;
using test::Whole;
using test::world;

namespace {

// Effects of the linear world, fitted without a discrepancy to a gap.
struct Fitting {
  StageData data;
  EffectCurves curves;
  Products products;

  Fitting(const std::vector<Whole>& per_value, const Whole& gap)
      : data(world().data(gap)),
        curves(world().curves(per_value, data)),
        products(products_of(whiteners_of(data, no_discrepancy()), curves.shifts, residuals_of(data))) {}
};

// One manoeuvre of two numbers, in which a single effect goes along the given points.
struct Bent {
  EffectCurves curves;
  Products products;

  Bent(const std::vector<std::pair<double, Eigen::Vector2d>>& points, const Eigen::Vector2d& gap) {
    StageGroup group;
    group.t_s = {0, 1};
    group.series = {{0, 2, 0, 0}};
    group.variance = Eigen::Vector2d::Ones();
    group.local_shapes = group.shared_shapes = Eigen::MatrixXd(2, 0);
    const StageData data{Passage::drive_to_body, {group}};
    curves.shifts = {Eigen::MatrixXd(2, 0)};
    curves.curves.push_back({0, {}, 0});
    for (const auto& [value, shift] : points) {
      const bool neutral = shift.norm() == 0;
      curves.curves[0].points.push_back({value, neutral ? -1 : static_cast<int>(curves.shifts[0].cols()), true});
      if (neutral) continue;
      curves.shifts[0].conservativeResize(Eigen::NoChange, curves.shifts[0].cols() + 1);
      curves.shifts[0].rightCols(1) = shift;
    }
    products = products_of(whiteners_of(data, no_discrepancy()), curves.shifts, {gap});
  }
};

}  // namespace

TEST_CASE("Products are summed in the same order whatever caches the processor has") {
  CHECK(Eigen::l1CacheSize() == Eigen::internal::defaultL1CacheSize);
  CHECK(Eigen::l2CacheSize() == Eigen::internal::defaultL2CacheSize);
  CHECK(Eigen::l3CacheSize() == Eigen::internal::defaultL3CacheSize);
}

TEST_CASE("One effect alone is found exactly, with nothing left") {
  const Whole shift = 20 * world().direction(0);
  for (const double value : {-0.9, -0.1, 0.0, 0.25, 0.7}) {
    const Fitting at({shift}, value * shift);
    const CurveFit fit = fit_one(at.products, at.curves.curves, 0);
    CHECK(fit.places[0].value == Approx(value).margin(1e-12));
    CHECK(fit.left == Approx(0).margin(1e-9));
    CHECK((shift_at(at.curves.shifts[1], fit.places) - value * world().by_group(shift)[1]).norm() < 1e-9);
    CHECK(left_with(at.products, fit.places) == Approx(fit.left).margin(1e-9));
  }
}

TEST_CASE("What is across an effect is left") {
  const Fitting at({20 * world().direction(0)}, 10 * world().direction(0) + 3 * world().direction(1));
  const CurveFit fit = fit_one(at.products, at.curves.curves, 0);
  CHECK(fit.places[0].value == Approx(0.5));
  CHECK(fit.left == Approx(9));
}

TEST_CASE("A value stays within the parameter's range") {
  const Whole shift = 20 * world().direction(0);
  const Fitting at({shift}, -1.5 * shift);
  const CurveFit fit = fit_one(at.products, at.curves.curves, 0);
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
    const Bent at(points, nearest.gap);
    const CurveFit fit = fit_one(at.products, at.curves.curves, 0);
    CHECK(fit.places[0].value == Approx(nearest.value).margin(1e-12));
    CHECK(fit.left == Approx(nearest.left));
  }
  const Bent at(points, {0, 0});
  const OnCurve place = at_value(at.curves.curves, 0, 2);
  CHECK((shift_at(at.curves.shifts[0], {&place, 1}) - Eigen::Vector2d(2, 1)).norm() < 1e-12);
}

TEST_CASE("A curve that jumps is fitted at an end of the jump, alone or together with another one") {
  // nothing up to 1, all of it from 1.1 on, and a little more at 2
  const std::vector<std::pair<double, Eigen::Vector2d>> points{{0, {0, 0}}, {1, {0, 0}}, {1.1, {10, 0}}, {2, {10, 1}}};
  const auto fitted = [&](const Eigen::Vector2d& gap) {
    Bent at(points, gap);
    at.curves.curves[0].points[2].jump = true;
    return fit_one(at.products, at.curves.curves, 0);
  };
  CHECK(fitted({6, -1}).places[0].value == Approx(1.1));
  CHECK(fitted({6, -1}).left == Approx(17));  // 4^2 + 1^2
  CHECK(fitted({4, 0}).places[0].value <= 1);
  CHECK(fitted({4, 0}).left == Approx(16));
  CHECK(fitted({6, 0.5}).places[0].value == Approx(1.55));
  CHECK(fitted({6, 0.5}).left == Approx(16));

  // the slope at an end of the jump is that of the other side of it
  Bent at(points, {6, -1});
  at.curves.curves[0].points[2].jump = true;
  const OnCurve place = at_value(at.curves.curves, 0, 1.08);
  CHECK(place.value == Approx(1.1));
  CHECK(place.segment == Approx(0.9));

  // the first effect jumps from 2.5 to 10, and 7 is asked: at 10 the other one makes up for 1 of 3, which is all it can
  const Whole a = world().direction(0);
  Fitting two({10 * a, a}, 7 * a + 0.5 * world().direction(1));
  two.curves.curves[0].points.back().jump = true;
  const CurveFit fit = fit_two(two.products, two.curves.curves, 0, 1);
  CHECK(fit.places[0].value == Approx(1));
  CHECK(fit.places[1].value == Approx(-1));
  CHECK(fit.left == Approx(2 * 2 + 0.5 * 0.5));
}

TEST_CASE("Two effects at 60 degrees are distinguished by both inner products") {
  const Whole a = world().direction(0), b = world().direction(0) / 2 + std::sqrt(0.75) * world().direction(1);
  const Fitting at({20 * a, 20 * b}, 6 * a - 8 * b + 2 * world().direction(2));
  const CurveFit fit = fit_two(at.products, at.curves.curves, 0, 1);
  CHECK(fit.places[0].value == Approx(0.3));
  CHECK(fit.places[1].value == Approx(-0.4));
  CHECK(fit.left == Approx(4));
  CHECK(left_with(at.products, fit.places) == Approx(4));
  // alone, the first one takes what of the other lies along it: 6 - 8 / 2 = 2 of 20
  CHECK(fit_one(at.products, at.curves.curves, 0).places[0].value == Approx(0.1));
}

TEST_CASE("Two effects of which one is at its bound: the other makes up for it") {
  const Whole a = world().direction(0), b = world().direction(0) / 2 + std::sqrt(0.75) * world().direction(1);
  const Fitting at({20 * a, 20 * b}, 30 * a);
  const CurveFit fit = fit_two(at.products, at.curves.curves, 0, 1);
  CHECK(fit.places[0].value == Approx(1));
  CHECK(fit.places[1].value == Approx(0.25));  // 10 a . b = 5 of 20
  CHECK(fit.left == Approx(75));               // 10^2 - 5^2
}

TEST_CASE("Two effects that do the same share one explanation") {
  const Whole a = 20 * world().direction(0);
  const Fitting at({a, a}, 0.8 * a);
  const CurveFit fit = fit_two(at.products, at.curves.curves, 0, 1);
  CHECK(fit.left == Approx(0).margin(1e-9));
  CHECK(fit.places[0].value + fit.places[1].value == Approx(0.8));
}

TEST_CASE("Four effects, each at 60 degrees to the others, are distinguished") {
  // edges of a simplex: inner products of 1/2
  std::vector<Whole> effects;
  for (Eigen::Index i = 0; i < 4; ++i)
    effects.push_back(20 * (world().direction(4) + world().direction(i)) / std::sqrt(2.0));
  const double values[] = {0.3, -0.4, 0.1, 0.6};
  Whole gap = 2 * world().direction(5);
  for (std::size_t i = 0; i < 4; ++i) gap += values[i] * effects[i];
  const Fitting at(effects, gap);
  for (const std::vector<std::size_t>& order : {std::vector<std::size_t>{0, 1, 2, 3}, {3, 1, 0, 2}}) {
    const CurveFit fit = fit_together(at.products, at.curves.curves, order);
    REQUIRE(fit.places.size() == 4);
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK(fit.places[i].curve == order[i]);
      // turns end when one gains less than a millionth of the 4 that are left: 0.002 of 20
      CHECK(fit.places[i].value == Approx(values[order[i]]).margin(1e-3));
    }
    CHECK(fit.left == Approx(4).epsilon(1e-5));
  }
}
