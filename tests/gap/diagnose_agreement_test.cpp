// Whether manoeuvres agree on a value: answers that geometry gives.
#include "gap/diagnose/agreement.hpp"

#include <catch2/catch.hpp>

#include "tests/gap/linear_world.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using test::LinearWorld;
using test::Whole;
using test::world;

namespace {

constexpr double kShift = 40;
constexpr Eigen::Index kBinsOfManoeuvre = LinearWorld::kBins / 2;

// 0.5 of an effect in the first manoeuvre, `second` of it in the other one.
Whole two_values(const Whole& effect, double second) {
  Whole gap = 0.5 * effect;
  gap.tail(kBinsOfManoeuvre) *= second / 0.5;
  return gap;
}

}  // namespace

TEST_CASE("What manoeuvres would gain by values of their own is what the common one costs them") {
  const Whole effect = kShift * world().direction(0);
  const EffectCurves curves = world().curves({effect}, two_values(effect, 0.3));
  const Agreement found = agreement(curves, world().fitted(curves, {0}), LinearWorld::repeats, 9, 0, {});
  // of two springs a and b that want values 0.2 apart: a b / (a + b) 0.2^2
  const double a = effect.head(kBinsOfManoeuvre).squaredNorm(), b = effect.tail(kBinsOfManoeuvre).squaredNorm();
  CHECK(found.gained == Approx(a * b / (a + b) * 0.04));
  CHECK(found.freedom == 1);
  // what numerics may change of a gap does not count: here a tenth of some 400 x 0.17
  CHECK(agreement(curves, world().fitted(curves, {0}), LinearWorld::repeats, 9, 0.1, {}).gained < found.gained - 10);
  const EffectCurves same = world().curves({effect}, two_values(effect, 0.5));
  CHECK(agreement(same, world().fitted(same, {0}), LinearWorld::repeats, 9, 0, {}).gained == Approx(0).margin(1e-9));
}

TEST_CASE("A manoeuvre that does not show an effect has no value of its own for it") {
  Whole effect = kShift * world().direction(0);
  effect.tail(kBinsOfManoeuvre).setZero();
  const EffectCurves curves = world().curves({effect, kShift * world().direction(1)}, effect / 2);
  CHECK(agreement(curves, world().fitted(curves, {0}), LinearWorld::repeats, 9, 0, {}).freedom == 0);
  CHECK(p_of_squares(100, 0) == 1);
}

TEST_CASE("A manoeuvre that hardly shows an effect has no value of its own either, and gains nothing by one") {
  // the second one is moved by 2 floors at the value of 0.5, and measured where 1.0 would move it: 4 squared floors,
  // for which a value of its own would have to be free
  Whole effect = kShift * world().direction(0);
  effect.tail(kBinsOfManoeuvre) *= 4 / effect.tail(kBinsOfManoeuvre).norm();
  const EffectCurves curves = world().curves({effect}, two_values(effect, 1.0));
  const Agreement found = agreement(curves, world().fitted(curves, {0}), LinearWorld::repeats, 9, 0, {});
  CHECK(found.freedom == 0);
  // only what the first one loses to the common value c: a (c - 0.5)^2, where c - 0.5 = 0.5 b / (a + b)
  const double a = effect.head(kBinsOfManoeuvre).squaredNorm(), b = effect.tail(kBinsOfManoeuvre).squaredNorm();
  REQUIRE(b == Approx(16));
  CHECK(found.gained == Approx(a * 0.25 * b * b / ((a + b) * (a + b))));
  CHECK(found.gained < 0.2);
}

TEST_CASE("An effect that a manoeuvre hardly shows is held there while the other one gets a value of its own") {
  Whole hardly = kShift * world().direction(0);
  hardly.tail(kBinsOfManoeuvre) *= 4 / hardly.tail(kBinsOfManoeuvre).norm();
  const Whole shown = kShift * world().direction(1);
  const EffectCurves curves = world().curves({hardly, shown}, two_values(hardly, 1.0) + 0.5 * shown);
  const Agreement found = agreement(curves, world().fitted(curves, {0, 1}), LinearWorld::repeats, 9, 0, {});
  CHECK(found.freedom == 1);  // of the one that both show
  CHECK(found.gained < 1);    // it agrees; the 4 that a free value of the other one would gain are not its own
}

TEST_CASE("Numbers of the simulator that move manoeuvres each its own way are expected to") {
  // a shape that is the effect in the first manoeuvre, its opposite in the second: values of 0.1 and -0.1 that differ
  // by 0.2 of a shift that is as long as that number times kShift in both together
  const Whole effect = kShift * world().direction(0);
  const EffectCurves curves = world().curves({effect}, 0.5 * effect);
  Whole shape = 0.1 * effect;
  shape.tail(kBinsOfManoeuvre) *= -1;
  std::vector<Eigen::MatrixXd> shapes;
  for (const Eigen::VectorXd& run : LinearWorld::by_run(shape)) {
    shapes.emplace_back(run.size(), 4);
    shapes.back() << run, -run, Eigen::VectorXd::Zero(run.size()), Eigen::VectorXd::Zero(run.size());
  }
  const Agreement found = agreement(curves, world().fitted(curves, {0}), LinearWorld::repeats, 9, 0, shapes);
  const double a = effect.head(kBinsOfManoeuvre).squaredNorm(), b = effect.tail(kBinsOfManoeuvre).squaredNorm();
  CHECK(found.of_numerics == Approx(a * b / (a + b) * 0.04));
  CHECK(found.gained == Approx(0).margin(1e-9));
  // one that moves all manoeuvres by the same value makes none disagree
  for (Eigen::MatrixXd& run : shapes) run.setZero();
  const std::vector<Eigen::VectorXd> same = LinearWorld::by_run(0.1 * effect);
  for (std::size_t r = 0; r < shapes.size(); ++r) shapes[r].col(0) = same[r];
  CHECK(agreement(curves, world().fitted(curves, {0}), LinearWorld::repeats, 9, 0, shapes).of_numerics ==
        Approx(0).margin(1e-9));
}

TEST_CASE("The chance of a sum of squares, against the tables of chi-squared") {
  CHECK(p_of_squares(7.815, 3) == Approx(0.05).margin(0.001));
  CHECK(p_of_squares(12.838, 3) == Approx(0.005).margin(0.001));
  CHECK(p_of_squares(18.307, 10) == Approx(0.05).margin(0.001));
  CHECK(p_of_squares(9.342, 10) == Approx(0.5).margin(0.001));
}

TEST_CASE("An effect that would need another value in each manoeuvre is not named") {
  std::vector<Whole> effects;
  for (std::size_t i = 0; i < 4; ++i) effects.push_back(kShift * world().direction(i));
  const Decision one = world().decide(effects, two_values(effects[2], 0.5), {});
  CHECK(one.verdict == Verdict::named);
  CHECK(one.p_agree > 0.5);
  // without noise what is left in all cells, about 400 x 0.2^2 = 16, is less than chance has there: 24
  const Decision two = world().decide(effects, two_values(effects[2], 0.3), {});
  CHECK(two.verdict == Verdict::unknown);
  CHECK(two.p_agree < 0.005);
  CHECK(two.p_left > 0.1);
}
