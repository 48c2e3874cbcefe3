// Where a curve is simulated so that fits can follow it.
#include "gap/diagnose/effect_curves.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/gap/diagnose/linear_world.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::candidates;
using namespace kenaf::gap::diagnose;
using test::LinearWorld;
using test::Whole;
using test::world;

namespace {

const std::vector<std::size_t> kFirst{0};

std::vector<double> values_of(const EffectCurve& curve) {
  std::vector<double> values;
  for (const CurvePoint& point : curve.points) values.push_back(point.value);
  return values;
}

// A single effect that moves all runs by `length` of its value, and how often it was simulated.
struct OneEffect {
  std::function<double(double)> length;
  int simulated = 0;

  Simulate simulate() {
    return [this](std::span<const Settings> asked, Fidelity) {
      std::vector<GroupVectors> shifts;
      for (const Settings& settings : asked)
        shifts.push_back(world().by_group(length(settings[0].value) * world().direction(0)));
      simulated += static_cast<int>(asked.size());
      return shifts;
    };
  }
};

// Known at these values.
EffectCurves known_at(OneEffect& effect, const StageData& data, std::initializer_list<double> values) {
  EffectCurves curves = empty_curves(data, world().candidates(1));
  std::vector<Setting> points;
  for (const double value : values) points.push_back({0, value});
  add_points(curves, data, points, Fidelity::coarse, effect.simulate());
  effect.simulated = 0;
  return curves;
}

}  // namespace

TEST_CASE(
    "A first look has a point near the present value to either side, and of an effect that goes one way alone its "
    "end") {
  std::vector<Candidate> candidates(2, world().candidates(1)[0]);
  candidates[1].min = 0;
  OneEffect effect{[](double value) { return 8 * value; }};
  const StageData data = world().data(Whole::Zero(world().bins()));
  EffectCurves curves = empty_curves(data, candidates);
  const std::vector<std::size_t> both{0, 1};
  add_first_look(curves, data, both, effect.simulate());
  CHECK(values_of(curves.curves[0]) == std::vector<double>{-0.25, 0, 0.25});
  CHECK(values_of(curves.curves[1]) == std::vector<double>{0, 0.25, 1});
  CHECK(curves.curves[1].visible == Approx(8));
  // then over all of the range, without what is known
  effect.simulated = 0;
  add_spread(curves, data, both, effect.simulate());
  CHECK(values_of(curves.curves[0]) == std::vector<double>{-1, -0.25, 0, 0.25, 1});
  CHECK(values_of(curves.curves[1]) == std::vector<double>{0, 0.25, 1});
  CHECK(effect.simulated == 2);
}

TEST_CASE("Where a first look leads nowhere it goes to the ends: what lies straight ahead is shorter than the gap") {
  // effects of -1 to 1: a servo's torque that suffices until it is down by a half; a number that shifts all runs, and
  // one that begins below -0.5, of which one side alone is looked at first
  std::vector<Candidate> candidates(3, world().candidates(1)[0]);
  candidates[1].whole = candidates[2].whole = 1;
  const auto suffices_to_half = [](double value) { return std::max(0.0, -value - 0.5) * 100; };
  const std::function<double(double)> lengths[] = {suffices_to_half, [](double value) { return 100 * value; },
                                                   suffices_to_half};
  const Simulate simulate = [&](std::span<const Settings> asked, Fidelity) {
    std::vector<GroupVectors> shifts;
    for (const Settings& settings : asked)
      shifts.push_back(world().by_group(lengths[settings[0].candidate](settings[0].value) * world().direction(0)));
    return shifts;
  };
  const StageData data = world().data(10 * world().direction(0));
  EffectCurves curves = empty_curves(data, candidates);
  const std::vector<std::size_t> all{0, 1, 2};
  add_first_look(curves, data, all, simulate);
  CHECK(values_of(curves.curves[0]) == std::vector<double>{-1, -0.25, 0, 0.25, 1});
  CHECK(values_of(curves.curves[1]) == std::vector<double>{0, 0.02, 0.25});
  CHECK(values_of(curves.curves[2]) == std::vector<double>{-1, 0, 0.02, 1});
  CHECK(curves.curves[0].visible == Approx(50));
  CHECK(is_bent(curves, data, 0, 10));
}

TEST_CASE("A difference's length in noise counts each bin by its own") {
  StageData data = world().data(Whole::Zero(world().bins()));
  CHECK(length_in_noise(data, world().by_group(7 * world().direction(3))) == Approx(7));
  data.groups[0].variance *= 4;
  data.groups[1].variance *= 4;
  CHECK(length_in_noise(data, world().by_group(7 * world().direction(3))) == Approx(3.5));
}

TEST_CASE("Near an exact point rough ones are forgotten, but for the ends of a curve, and the same value is replaced") {
  OneEffect rough{[](double value) { return 12 * value; }}, exact{[](double value) { return 10 * value; }};
  const StageData data = world().data(Whole::Zero(world().bins()));
  EffectCurves curves = known_at(rough, data, {-1, -0.25, 0.125, 0.25, 0.5, 0.75, 1});
  const std::vector<Setting> points{{0, 0.25}};
  add_points(curves, data, points, Fidelity::fine, exact.simulate());
  // up to twice as far from the present value on its side
  CHECK(values_of(curves.curves[0]) == std::vector<double>{-1, -0.25, 0, 0.25, 0.5, 0.75, 1});
  const CurvePoint& replaced = curves.curves[0].points[3];
  CHECK(replaced.exact);
  CHECK((curves.shifts[0].col(replaced.column) - world().by_group(2.5 * world().direction(0))[0]).norm() < 1e-12);
  // all between neutral and twice the value; the end of the range stays
  const std::vector<Setting> farther{{0, 0.6}};
  add_points(curves, data, farther, Fidelity::fine, exact.simulate());
  CHECK(values_of(curves.curves[0]) == std::vector<double>{-1, -0.25, 0, 0.25, 0.6, 1});
}

TEST_CASE("A curve that does little and then much is halved to where it is as long as the gap") {
  // up to 0.5 the effect does nothing; at 1 it moves all runs by 100. Known at 0.25 and 1 only. A gap of 10: it is at
  // 0.55. Halves of 0.25 to 1: 0.625 (25), then on its lower side 0.4375 (0), then between these 0.53125 (6.25) and, on
  // its upper side, 0.578125 (15.6)
  OneEffect stalls{[](double value) { return std::max(0.0, value - 0.5) / 0.5 * 100; }};
  const StageData data = world().data(10 * world().direction(0));
  EffectCurves curves = known_at(stalls, data, {0.25, 1});
  follow_bends(curves, data, kFirst, stalls.simulate());
  CHECK(values_of(curves.curves[0]) == std::vector<double>{0, 0.25, 0.4375, 0.53125, 0.578125, 0.625, 1});
  CHECK(stalls.simulated == 4);
}

TEST_CASE(
    "A curve that has done all before its innermost point gets points nearer to neutral, until it is straight there") {
  // 100 from 0.01 on, in a straight line up to there. Known at 0.25 and 1; a gap of 10. A quarter of the way: 0.0625
  // and 0.015625 have 100, 0.00390625 has 39, less than twice a quarter of 100
  OneEffect early{[](double value) { return std::clamp(value / 0.01, -1.0, 1.0) * 100; }};
  const StageData data = world().data(10 * world().direction(0));
  EffectCurves curves = known_at(early, data, {0.25, 1, -1, -0.25});
  follow_bends(curves, data, kFirst, early.simulate());
  CHECK(values_of(curves.curves[0]) ==
        std::vector<double>{-1, -0.25, -0.0625, -0.015625, -0.00390625, 0, 0.00390625, 0.015625, 0.0625, 0.25, 1});
}

TEST_CASE("A straight curve needs no more points, and one that never is as long as the gap gets none") {
  for (const double length : {40.0, 4.0}) {
    OneEffect straight{[&](double value) { return length * value; }};
    const StageData data = world().data(8 * world().direction(0));
    EffectCurves curves = known_at(straight, data, {-1, -0.25, 0.25, 1});
    follow_bends(curves, data, kFirst, straight.simulate());
    CHECK(straight.simulated == 0);
  }
}
