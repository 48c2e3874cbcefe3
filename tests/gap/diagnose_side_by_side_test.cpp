// Two effects that change what the other one does: slopes and values by hand.
#include "gap/diagnose/side_by_side.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>

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

TEST_CASE("At the end of its range an effect gets a point on the inner side only, and one at neutral none") {
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
}

namespace {

// A single effect, which moves all runs by `floors` of its value.
struct Alone {
  std::function<double(double)> floors;

  Whole moved(double value) const { return floors(value) * world().direction(0); }
  Simulator simulator() const {
    Simulator simulator = world().simulator({});
    simulator.shifts = [*this](std::span<const std::vector<NewPoint>> asked, Fidelity) {
      std::vector<Shift> shifts;
      for (const std::vector<NewPoint>& effects : asked) shifts.push_back(LinearWorld::by_run(moved(effects[0].value)));
      return shifts;
    };
    return simulator;
  }
  EffectCurves curves(double truth) const {
    return world().curves({moved(1), 40 * world().direction(1)}, moved(truth));
  }
  Model simulated(const EffectCurves& curves, double value) const {
    Model model{{at_value(curves.curves, 0, value)}, LinearWorld::by_run(moved(value)), true};
    measure(model, curves, world().coherence());
    return model;
  }
};

}  // namespace

// Play: the least of it does as much as 18 floors, and from there on it does little.
TEST_CASE("An effect alone that does most at once has the slope that it has where it stands") {
  const Alone play{[](double value) { return value > 0 ? 18 + 4 * value : 0; }};
  EffectCurves curves = play.curves(0.5);
  // on the straight line from neutral to 22 floors at 1: 20 of them, where it stands, are at 0.91
  const Model model =
      fit_side_by_side(curves, world().coherence(), play.simulator(), play.simulated(curves, 20.0 / 22));
  CHECK(model.places[0].value == Approx(0.5).margin(0.01));
  CHECK(model.left < 1e-3);
  CHECK(length_between(curves, 0, 0.45, 0.5) == Approx(0.05 * 4).margin(0.01));
}

// A drive that stalls: from 0.5 on twenty times as much, from 0.7 on all is lost. A straight line from 0.55 to beyond
// 0.7 would have the value at 0.552.
TEST_CASE("A side that is round a bend is sought nearer, so that the fit gets to where it belongs") {
  const Alone stall{
      [](double value) { return 10 * value + 200 * std::max(0.0, value - 0.5) + 20'000 * std::max(0.0, value - 0.7); }};
  EffectCurves curves = stall.curves(0.6);
  const Model model = fit_side_by_side(curves, world().coherence(), stall.simulator(), stall.simulated(curves, 0.55));
  CHECK(model.places[0].value == Approx(0.6).margin(1e-3));
  CHECK(length_between(curves, 0, 0.599, 0.6) == Approx(0.001 * 210).margin(0.02));
}
