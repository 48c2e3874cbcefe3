// Two effects that change what the other one does: slopes and values by hand.
#include "gap/diagnose/side_by_side.hpp"

#include <catch2/catch.hpp>

#include "gap/diagnose/agreement.hpp"
#include "tests/gap/linear_world.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using test::LinearWorld;
using test::Whole;
using test::world;

namespace {

// Each moves all runs by 40 floors alone; beside b, a moves 30 b less, and a moves b's runs by as much.
Whole moved(std::span<const NewPoint> effects) {
  double value[2] = {0, 0};
  for (const NewPoint& effect : effects) value[effect.curve] = effect.value;
  return (40 * value[0] - 30 * value[0] * value[1]) * world().direction(0) + 40 * value[1] * world().direction(1);
}

Simulator simulator() {
  Simulator simulator = world().simulator({});
  simulator.add_points = [](EffectCurves& curves, std::span<const NewPoint> points, Fidelity fidelity) {
    std::vector<Shift> shifts;
    for (const NewPoint& point : points) shifts.push_back(LinearWorld::by_run(moved({&point, 1})));
    insert_points(curves, points, shifts, fidelity);
  };
  simulator.shifts = [](std::span<const std::vector<NewPoint>> asked, Fidelity) {
    std::vector<Shift> shifts;
    for (const std::vector<NewPoint>& effects : asked) shifts.push_back(LinearWorld::by_run(moved(effects)));
    return shifts;
  };
  return simulator;
}

EffectCurves curves_of(const Whole& gap) {
  return world().curves({40 * world().direction(0), 40 * world().direction(1)}, gap);
}

Model simulated(const EffectCurves& curves, double a, double b) {
  Model model{{at_value(curves.curves, 0, a), at_value(curves.curves, 1, b)}, {}, true};
  model.shift = LinearWorld::by_run(moved(values_of(model.places)));
  measure(model, curves, world().coherence());
  return model;
}

// By how much all runs move when a curve goes from one value to another.
double length_between(const EffectCurves& curves, std::size_t curve, double from, double to) {
  const OnCurve a = at_value(curves.curves, curve, from), b = at_value(curves.curves, curve, to);
  double squares = 0;
  for (const Eigen::MatrixXd& run : curves.shifts)
    squares += (shift_at(run, {&b, 1}) - shift_at(run, {&a, 1})).squaredNorm();
  return std::sqrt(squares);
}

}  // namespace

TEST_CASE("Beside one another effects are fitted by what they do there, not by what each does alone") {
  const std::vector<NewPoint> truth{{0, 0.5}, {1, 0.5}};
  EffectCurves curves = curves_of(moved(truth));
  const Model before = simulated(curves, 0.45, 0.45);
  const Model model = fit_side_by_side(curves, world().coherence(), simulator(), before);
  REQUIRE(model.places.size() == 2);
  CHECK(model.places[0].value == Approx(0.5).margin(1e-3));
  CHECK(model.places[1].value == Approx(0.5).margin(1e-3));
  CHECK(model.left < 1e-3);
  CHECK(model.exact);
  // a: 40 - 30 x 0.5 = 25 for a whole unit; b: 40 along its own direction and 30 x 0.5 along the other one
  CHECK(length_between(curves, 0, 0.5, 0.54) == Approx(0.04 * 25).margin(0.01));
  CHECK(length_between(curves, 1, 0.46, 0.5) == Approx(0.04 * std::hypot(40, 15)).margin(0.01));
}

TEST_CASE("A fit that stands where it should stays, and its sum with what was simulated is what it was") {
  const std::vector<NewPoint> truth{{0, -0.6}, {1, 0.3}};
  EffectCurves curves = curves_of(moved(truth));
  const Model model = fit_side_by_side(curves, world().coherence(), simulator(), simulated(curves, -0.6, 0.3));
  CHECK(model.places[0].value == Approx(-0.6));
  CHECK(model.places[1].value == Approx(0.3));
  CHECK(left_with(products_around(curves, model), model.places) == Approx(0).margin(1e-6));
  CHECK(agreement(curves, model, LinearWorld::repeats, 9, 0, {}).gained == Approx(0).margin(1e-6));
}

TEST_CASE("At the end of its range an effect gets a point on the inner side only, and one at neutral or alone none") {
  const std::vector<NewPoint> truth{{0, 1}, {1, 0.5}};
  EffectCurves curves = curves_of(moved(truth));
  const Model model = fit_side_by_side(curves, world().coherence(), simulator(), simulated(curves, 1, 0.5));
  CHECK(model.places[0].value == Approx(1).margin(1e-6));
  CHECK(curves.curves[0].points.back().value == 1);
  CHECK(length_between(curves, 0, 0.95, 1) == Approx(0.05 * 25).margin(0.01));

  EffectCurves without = curves_of(moved({{truth[0]}}));
  const Model neutral = fit_side_by_side(without, world().coherence(), simulator(), simulated(without, 1, 0));
  CHECK(neutral.places[1].value == 0);
  CHECK(at_value(without.curves, 1, 0).value == 0);

  EffectCurves alone = curves_of(moved({{truth[0]}}));
  const std::vector<CurvePoint> points = alone.curves[0].points;
  const Model single = world().fitted(alone, {0});
  CHECK(fit_side_by_side(alone, world().coherence(), simulator(), single).places[0].value == single.places[0].value);
  CHECK(alone.curves[0].points.size() == points.size());
}
