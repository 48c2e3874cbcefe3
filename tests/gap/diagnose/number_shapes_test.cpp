#include "gap/diagnose/number_shapes.hpp"

#include <catch2/catch.hpp>

#include "tests/gap/diagnose/linear_world.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::candidates;
using namespace kenaf::gap::diagnose;
using Eigen::MatrixXd;
using test::LinearWorld;
using test::Whole;

namespace {

Candidate number(double whole, double present, double min, double max) {
  Candidate candidate;
  candidate.present = present;
  candidate.min = min;
  candidate.max = max;
  candidate.whole = whole;
  return candidate;
}

// Shifts by `per_unit` for each unit of a candidate's number, known at half way to the upper end and there.
EffectCurves curves_of(const LinearWorld& world, const StageData& data, const std::vector<Candidate>& candidates,
                       const std::vector<Whole>& per_unit) {
  EffectCurves curves = empty_curves(data, candidates);
  for (std::size_t c = 0; c < candidates.size(); ++c)
    for (const double part : {0.5, 1.0}) {
      const double off = part * (candidates[c].max - candidates[c].present);
      const std::vector<Setting> point{{c, candidates[c].present + off}};
      insert_points(curves, data, point, {world.by_group(off * per_unit[c])}, Fidelity::coarse);
    }
  return curves;
}

// What of one group two bins have in common, over all shapes.
MatrixXd covariance(const MatrixXd& shapes) {
  return shapes * shapes.transpose();
}

}  // namespace

TEST_CASE("A number that is off by all of itself makes a shape of 1 sigma, an effect that is no number makes none") {
  const LinearWorld world({2, 2, 3});
  const StageData data = world.data(world.noise(1));
  const std::vector<Candidate> candidates{number(20, 20, 10, 40), number(0.2, 0, -0.1, 0.1), number(0, 1, 0.5, 2)};
  const std::vector<Whole> per_unit{5 * world.direction(0), 300 * world.direction(1), 90 * world.direction(2)};
  const EffectCurves curves = curves_of(world, data, candidates, per_unit);
  const std::vector<std::size_t> possible{0, 1, 2};
  const std::vector<MatrixXd> shapes = number_shapes(data, curves, possible);

  // 20 kg by 5 a kilogram, and a range of 0.2 m by 300 a metre
  const std::vector<Eigen::VectorXd> mass = world.by_group(100 * world.direction(0)),
                                     com = world.by_group(60 * world.direction(1));
  REQUIRE(shapes.size() == 2);
  for (std::size_t g = 0; g < 2; ++g) {
    CHECK(shapes[g].cols() == 2);
    const MatrixXd expected = covariance(mass[g]) + covariance(com[g]);
    CHECK((covariance(shapes[g]) - expected).norm() < 1e-9 * expected.norm());
  }
}

TEST_CASE("Numbers that cannot be seen make no shapes, and two that do the same make one that is longer") {
  const LinearWorld world({2, 2, 3});
  const StageData data = world.data(world.noise(1));
  const std::vector<Candidate> candidates{number(1, 1, 0.5, 2), number(1, 1, 0.5, 2), number(1, 1, 0.5, 2)};
  const EffectCurves curves =
      curves_of(world, data, candidates, {30 * world.direction(0), 40 * world.direction(0), 0.5 * world.direction(1)});
  const std::vector<std::size_t> possible{0, 1, 2}, none;
  const std::vector<MatrixXd> shapes = number_shapes(data, curves, possible);
  // of independent amounts: the root of 30^2 + 40^2
  const std::vector<Eigen::VectorXd> expected = world.by_group(50 * world.direction(0));
  for (std::size_t g = 0; g < 2; ++g) {
    CHECK(shapes[g].cols() == 1);
    CHECK((covariance(shapes[g]) - covariance(expected[g])).norm() < 1e-9 * covariance(expected[g]).norm());
  }
  for (const MatrixXd& group : number_shapes(data, curves, none)) CHECK(group.cols() == 0);
}

TEST_CASE(
    "Around a model a number has its shift with the model's values applied, and the model's own numbers are no "
    "shapes") {
  // tracks that are wider do nothing to track speeds, but for a robot whose turns are limited: 20 a metre and a unit of
  // the limit; without the limit 3 a metre; mass 7 a kilogram, whatever else
  const LinearWorld world({2, 2, 3});
  const StageData data = world.data(world.noise(1));
  const std::vector<Candidate> candidates{number(0, 0, 0, 2), number(10, 10, 5, 20), number(1, 1, 0.5, 2)};
  const auto moved = [&](const Settings& settings) {
    double limit = 0, metres = 0, kilograms = 0;
    for (const Setting& setting : settings)
      (setting.candidate == 0   ? limit
       : setting.candidate == 1 ? metres
                                : kilograms) = setting.value - candidates[setting.candidate].present;
    return Whole(40 * limit * world.direction(0) + (3 + 20 * limit) * metres * world.direction(1) +
                 7 * kilograms * world.direction(2));
  };
  const Simulate simulate = [&](std::span<const Settings> asked, Fidelity) {
    std::vector<GroupVectors> shifts;
    for (const Settings& settings : asked) shifts.push_back(world.by_group(moved(settings)));
    return shifts;
  };
  const std::vector<std::size_t> possible{0, 1, 2};
  const auto is = [&](const std::vector<MatrixXd>& shapes, const Whole& first, const Whole& second) {
    const std::vector<Eigen::VectorXd> a = world.by_group(first), b = world.by_group(second);
    for (std::size_t g = 0; g < 2; ++g) {
      const MatrixXd expected = covariance(a[g]) + covariance(b[g]);
      CHECK((covariance(shapes[g]) - expected).norm() < 1e-9 * covariance(world.by_group(first + second)[g]).norm());
    }
  };
  const Whole none = Whole::Zero(world.bins());

  // at a limit of 0.5 a metre shifts 3 + 20 * 0.5 = 13; tracks are 10 m apart, so all of them shift 130
  const Settings limited{{0, 0.5}};
  const std::vector<std::size_t> mass{2}, no_numbers;
  is(number_shapes_around(data, candidates, possible, limited, no_numbers, simulate), 130 * world.direction(1),
     7 * world.direction(2));
  // mass is one of the model's values, and no longer open
  const Settings limited_and_heavy{{0, 0.5}, {2, 1.2}};
  is(number_shapes_around(data, candidates, possible, limited_and_heavy, mass, simulate), 130 * world.direction(1),
     none);
  // but where it is asked what numbers do in its place; also at the end of its range
  for (const double kilograms : {1.2, 2.0})
    is(number_shapes_around(data, candidates, possible, {{0, 0.5}, {2, kilograms}}, no_numbers, simulate),
       130 * world.direction(1), 7 * world.direction(2));
  // what tracks shift without a limit, and mass, both datasets have
  is(number_shapes_of_change(data, candidates, possible, limited, no_numbers, simulate), 100 * world.direction(1),
     none);
}
