// Two effects that change what the other one does: slopes and values by hand.
#include "gap/diagnose/side_by_side.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>

#include "gap/diagnose/effect_values.hpp"
#include "tests/gap/diagnose/linear_world.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::diagnose;
using test::LinearWorld;
using test::Whole;
using test::world;

namespace {

// Each moves all runs by 40 alone; beside b, a moves 30 b less, and a moves b's runs by as much.
Whole moved(const Settings& effects) {
  double value[2] = {0, 0};
  for (const Setting& effect : effects) value[effect.candidate] = effect.value;
  return (40 * value[0] - 30 * value[0] * value[1]) * world().direction(0) + 40 * value[1] * world().direction(1);
}

Model simulated(const StageData& data, const EffectCurves& curves, const LinearWorld::Moved& by, const Settings& at) {
  Model model{{}, world().by_group(by(at)), true, {}};
  for (const Setting& setting : at) model.places.push_back(at_value(curves.curves, setting.candidate, setting.value));
  model.likelihood = likelihood_of(data, rest_of(data, model), no_discrepancy());
  return model;
}

// From `at` on, in a gap that `truth` makes.
StandingModel stood(const LinearWorld::Moved& by, const Settings& truth, const Settings& at) {
  const StageData data = world().data(by(truth));
  const EffectCurves curves = world().curves(by, 2, data);
  return fit_side_by_side(data, curves, world().simulate(by), simulated(data, curves, by, at));
}

// By how much all runs move when a curve goes from one value to another.
double length_between(const EffectCurves& curves, std::size_t curve, double from, double to) {
  const OnCurve a = at_value(curves.curves, curve, from), b = at_value(curves.curves, curve, to);
  GroupVectors moved = shift_of(curves, {&b, 1});
  const GroupVectors of_a = shift_of(curves, {&a, 1});
  for (std::size_t g = 0; g < moved.size(); ++g) moved[g] -= of_a[g];
  return length_in_noise(world().data(Whole::Zero(world().bins())), moved);
}

double left(const Settings& truth, const Model& model) {
  const StageData data = world().data(moved(truth));
  return length_in_noise(data, rest_of(data, model));
}

}  // namespace

TEST_CASE("Joint effects are fitted by their joint shifts, not by those of each alone") {
  const Settings truth{{0, 0.5}, {1, 0.5}};
  const StandingModel standing = stood(moved, truth, {{0, 0.45}, {1, 0.45}});
  const Model& model = standing.model;
  REQUIRE(model.places.size() == 2);
  CHECK(model.places[0].value == Approx(0.5).margin(2e-3));
  CHECK(model.places[1].value == Approx(0.5).margin(2e-3));
  CHECK(left(truth, model) < 0.1);
  CHECK(model.exact);
  // a: 40 - 30 x 0.5 = 25 for a whole unit; b: 40 along its own direction and 30 x 0.5 along the other one
  CHECK(length_between(standing.curves, 0, 0.5, 0.54) == Approx(0.04 * 25).margin(0.02));
  CHECK(length_between(standing.curves, 1, 0.46, 0.5) == Approx(0.04 * std::hypot(40, 15)).margin(0.02));
}

TEST_CASE("A fit that is where it should be stays") {
  const StandingModel standing = stood(moved, {{0, -0.6}, {1, 0.3}}, {{0, -0.6}, {1, 0.3}});
  CHECK(standing.model.places[0].value == Approx(-0.6));
  CHECK(standing.model.places[1].value == Approx(0.3));
  // what the curves say where it stands, and what the two do together beyond it, are what was simulated
  const GroupVectors beyond = beyond_curves(standing.curves, standing.model);
  GroupVectors sum = shift_of(standing.curves, standing.model.places);
  const GroupVectors together = world().by_group(moved({{0, -0.6}, {1, 0.3}}));
  for (std::size_t g = 0; g < sum.size(); ++g) CHECK((sum[g] + beyond[g] - together[g]).norm() < 1e-9);
}

TEST_CASE("At the end of its range an effect gets a point on the inner side only, and one at neutral none") {
  const StandingModel at_end = stood(moved, {{0, 1}, {1, 0.5}}, {{0, 1}, {1, 0.5}});
  CHECK(at_end.model.places[0].value == Approx(1).margin(1e-6));
  CHECK(at_end.curves.curves[0].points.back().value == 1);
  CHECK(length_between(at_end.curves, 0, 0.95, 1) == Approx(0.05 * 25).margin(0.01));

  const StandingModel neutral = stood(moved, {{0, 1}}, {{0, 1}, {1, 0}});
  CHECK(neutral.model.places[1].value == 0);
  CHECK(at_value(neutral.curves.curves, 1, 0).value == 0);
}

namespace {

// A single effect, which moves all runs by `length` of its value; the second one is not asked for.
LinearWorld::Moved alone(const std::function<double(double)>& length) {
  return [length](const Settings& effects) {
    return Whole(length(effects[0].value) * world().direction(static_cast<Eigen::Index>(effects[0].candidate)));
  };
}

}  // namespace

// Play: the least of it does as much as 18 floors, and from there on it does little.
TEST_CASE("An effect alone that does most at once has the slope that it has where it stands") {
  const auto play = alone([](double value) { return value > 0 ? 18 + 4 * value : 0; });
  // on the straight line from neutral to 22 floors at 1: 20 of them, where it stands, are at 0.91
  const StandingModel standing = stood(play, {{0, 0.5}}, {{0, 20.0 / 22}});
  // neutral stays what it is
  const std::vector<CurvePoint>& points = standing.curves.curves[0].points;
  CHECK(std::ranges::find(points, 0, &CurvePoint::value)->column == -1);
  CHECK(standing.model.places[0].value == Approx(0.5).margin(0.02));
  CHECK(length_between(standing.curves, 0, 0.48, 0.5) == Approx(0.02 * 4).margin(0.01));
}

// A drive that stalls: from 0.5 on twenty times as much, from 0.7 on all is lost. A straight line from 0.55 to beyond
// 0.7 would have the value at 0.552.
TEST_CASE("A side that is round a bend is sought nearer, so that the fit gets to where it belongs") {
  const auto stall = alone(
      [](double value) { return 10 * value + 200 * std::max(0.0, value - 0.5) + 20'000 * std::max(0.0, value - 0.7); });
  const StandingModel standing = stood(stall, {{0, 0.6}}, {{0, 0.55}});
  CHECK(standing.model.places[0].value == Approx(0.6).margin(3e-3));
  CHECK(length_between(standing.curves, 0, 0.599, 0.6) == Approx(0.001 * 210).margin(0.02));
}

// A dead band: commands at 0.5 no longer move a track from there on, those at 0.8 from there on. Some other effect does
// a tenth of it less.
TEST_CASE("An effect that jumps stands on one side of the jump, and its interval reaches from jump to jump") {
  const auto dead_band = [](double value) { return value > 0.8 ? 70 : value > 0.5 ? 40 : 0; };
  for (const double from : {0.501, 0.6, 0.79}) {
    CAPTURE(from);
    const StageData data = world().data(0.9 * 40 * world().direction(0));
    const LinearWorld::Moved by = alone(dead_band);
    const EffectCurves curves = world().curves(by, 1, data);
    const StandingModel standing =
        fit_side_by_side(data, curves, world().simulate(by), simulated(data, curves, by, {{0, from}}));
    const double value = standing.model.places[0].value;
    CHECK(value > 0.5);
    CHECK(value <= 0.8);
    CHECK(length_in_noise(data, rest_of(data, standing.model)) == Approx(4).margin(1e-6));
    // what a fit to other data takes from the curve is what the robot does at that value
    const OnCurve fitted = fit_one(products_of(whiteners_of(data, no_discrepancy()), standing.curves.shifts,
                                               world().by_group(34 * world().direction(0))),
                                   standing.curves.curves, 0)
                               .places.front();
    CHECK(dead_band(fitted.value) == 40);
    const Interval interval = effect_values(data, standing, 9)[0].value;
    CHECK(interval.from == Approx(0.5).margin(0.01));
    CHECK(interval.from <= 0.5);
    CHECK(interval.to == Approx(0.8).margin(0.01));
    CHECK(interval.to >= 0.8);
  }
}
