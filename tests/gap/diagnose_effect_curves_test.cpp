// Where a curve is simulated so that fits can follow it.
#include "gap/diagnose/effect_curves.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/gap/linear_world.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using test::LinearWorld;
using test::Whole;
using test::world;

namespace {

constexpr double kStalls = 0.5;  // up to this the effect does nothing; at 1 it moves all runs by 100 floors

Whole stalling(double value) {
  return std::max(0.0, value - kStalls) / (1 - kStalls) * 100 * world().direction(0);
}

std::vector<double> values_of(const EffectCurve& curve) {
  std::vector<double> values;
  for (const CurvePoint& point : curve.points) values.push_back(point.value);
  return values;
}

}  // namespace

TEST_CASE("A curve that does little and then much is halved to where it is as long as the gap") {
  // known at 0.25 and 1 only. A gap of 10 floors: it is at 0.55. Halves of 0.25 to 1: 0.625 (25 floors), then on its
  // lower side 0.4375 (0), then between these 0.53125 (6.25) and, on its upper side, 0.578125 (15.6)
  EffectCurves curves = world().curves({}, 10 * world().direction(0));
  static constexpr physics::EffectParameter kParameter{"amount", "1", 0, -1, 1, &physics::Effects::command_gain};
  curves.curves.push_back({nullptr, &kParameter, {{0, -1, true}}, 0});
  int simulated = 0;
  const auto simulate = [&](std::span<const NewPoint> points) {
    std::vector<Shift> shifts;
    for (const NewPoint& point : points) shifts.push_back(LinearWorld::by_run(stalling(point.value)));
    insert_points(curves, points, shifts, Fidelity::coarse);
    simulated += static_cast<int>(points.size());
  };
  const std::vector<NewPoint> known{{0, 0.25}, {0, 1}};
  simulate(known);
  simulated = 0;
  follow_bends(curves, simulate);
  CHECK(values_of(curves.curves[0]) == std::vector<double>{0, 0.25, 0.4375, 0.53125, 0.578125, 0.625, 1});
  CHECK(simulated == 4);
}

TEST_CASE(
    "A curve that has done all before its innermost point gets points nearer to neutral, until it is straight there") {
  // 100 floors from 0.01 on, in a straight line up to there. Known at 0.25 and 1; a gap of 10 floors. A quarter of the
  // way: 0.0625 and 0.015625 have 100, 0.00390625 has 39, less than twice a quarter of 100
  EffectCurves curves = world().curves({}, 10 * world().direction(0));
  static constexpr physics::EffectParameter kParameter{"amount", "1", 0, -1, 1, &physics::Effects::command_gain};
  curves.curves.push_back({nullptr, &kParameter, {{0, -1, true}}, 0});
  const auto simulate = [&](std::span<const NewPoint> points) {
    std::vector<Shift> shifts;
    for (const NewPoint& point : points)
      shifts.push_back(LinearWorld::by_run(std::clamp(point.value / 0.01, -1.0, 1.0) * 100 * world().direction(0)));
    insert_points(curves, points, shifts, Fidelity::coarse);
  };
  const std::vector<NewPoint> known{{0, 0.25}, {0, 1}, {0, -1}, {0, -0.25}};
  simulate(known);
  follow_bends(curves, simulate);
  CHECK(values_of(curves.curves[0]) ==
        std::vector<double>{-1, -0.25, -0.0625, -0.015625, -0.00390625, 0, 0.00390625, 0.015625, 0.0625, 0.25, 1});
}

TEST_CASE("A straight curve needs no more points, and one that never is as long as the gap gets none") {
  for (const double length : {40.0, 4.0}) {
    EffectCurves curves = world().curves({length * world().direction(0)}, 8 * world().direction(0));
    follow_bends(curves, [](std::span<const NewPoint>) { FAIL("nothing to follow"); });
  }
}
