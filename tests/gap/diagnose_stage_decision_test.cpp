// Verdicts in a world whose effects are fixed vectors: tests/gap/linear_world.hpp.
#include "gap/diagnose/decision.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/gap/linear_world.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using test::LinearWorld;
using test::quick;
using test::Whole;
using test::world;

namespace {

constexpr std::size_t kEffects = 8;
constexpr double kLength = 40;  // of an effect's shift at the end of its range, in sigma

std::vector<Whole> orthogonal_effects() {
  std::vector<Whole> effects;
  for (std::size_t i = 0; i < kEffects; ++i) effects.push_back(kLength * world().direction(i));
  return effects;
}

bool holds(const Decision& decision, std::size_t place, std::size_t curve) {
  return std::ranges::count(decision.rivals.at(place), curve) > 0;
}

}  // namespace

TEST_CASE("Pure noise is called none, except as often as the chance of a false alarm says", "[long]") {
  const std::vector<Whole> effects = orthogonal_effects();
  const auto alarms_at = [&](double false_alarm) {
    DecisionSettings settings = quick();
    settings.false_alarm = false_alarm;
    if (false_alarm > 0.01) settings.null_draws = 200;
    int alarms = 0;
    for (std::uint64_t seed = 0; seed < 200; ++seed)
      alarms += world().decide(effects, LinearWorld::noise(1000 + seed), settings).verdict != Verdict::none;
    return alarms;
  };
  // one in 200 expected at most; five or more have a chance of 0.4 %
  CHECK(alarms_at(DecisionSettings{}.false_alarm) <= 4);
  // 20 expected at most, with a sigma of 4.2; most of the chance is not used, for what is small is not reported at all
  CHECK(alarms_at(0.1) <= 32);
}

TEST_CASE("One effect of 10 sigma is named alone, at its value") {
  const std::vector<Whole> effects = orthogonal_effects();
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const double value = seed % 2 == 0 ? 0.25 : -0.25;
    const Decision decision = world().decide(effects, value * effects[3] + LinearWorld::noise(seed), quick());
    REQUIRE(decision.verdict == Verdict::named);
    REQUIRE(decision.best.places.size() == 1);
    CHECK(decision.best.places[0].curve == 3);
    CHECK(decision.rivals[0].size() == 1);
    CHECK(decision.best.exact);
    // its sigma is 1 / 40, of which 4 are allowed
    CHECK(decision.best.places[0].value == Approx(value).margin(0.1));
  }
}

TEST_CASE("Two effects that look alike to one degree are not told apart, but both are named as possible") {
  std::vector<Whole> effects = orthogonal_effects();
  const double degree = 0.017453;
  effects[5] = std::cos(degree) * effects[2] + std::sin(degree) * kLength * world().direction(kEffects);
  for (const std::size_t truth : {2u, 5u})
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      const Decision decision = world().decide(effects, 0.5 * effects[truth] + LinearWorld::noise(seed), quick());
      REQUIRE(decision.verdict == Verdict::ambiguous);
      REQUIRE(decision.rivals.size() == 1);
      CHECK(decision.rivals[0].size() == 2);
      CHECK(holds(decision, 0, 2));
      CHECK(holds(decision, 0, 5));
    }
}

TEST_CASE(
    "Below ten degrees they are not told apart however sure it is, unless one leaves more than repeats differ by") {
  struct Gap {
    double degrees, floors;
    Verdict verdict;
  };
  // The one that is not there leaves sin^2 of the angle of the squared gap: 31 of 40^2 at 8 degrees, 107 at 15. Of the
  // noise 192 are left, and 1.25^2 x 192 = 300 may be; at 120 floors it would be 279 more.
  for (const Gap& hidden : {Gap{8, 40, Verdict::ambiguous}, Gap{15, 40, Verdict::named}, Gap{8, 120, Verdict::named}}) {
    std::vector<Whole> effects = orthogonal_effects();
    const double angle = hidden.degrees * 0.017453;
    effects[5] = std::cos(angle) * effects[2] + std::sin(angle) * kLength * world().direction(kEffects);
    for (const std::size_t e : {2u, 5u}) effects[e] *= 2 * hidden.floors / kLength;
    for (const std::size_t truth : {2u, 5u}) {
      INFO(hidden.degrees << " degrees, " << hidden.floors << " floors, " << truth);
      const Decision decision = world().decide(effects, 0.5 * effects[truth] + LinearWorld::noise(3), quick());
      CHECK(decision.verdict == hidden.verdict);
      REQUIRE(decision.rivals.size() == 1);
      CHECK(holds(decision, 0, truth));
    }
  }
}

TEST_CASE("At 60 degrees they are told apart") {
  std::vector<Whole> effects = orthogonal_effects();
  effects[5] = 0.5 * effects[2] + std::sqrt(0.75) * kLength * world().direction(kEffects);
  const Decision decision = world().decide(effects, 0.5 * effects[5] + LinearWorld::noise(1), quick());
  CHECK(decision.verdict == Verdict::named);
  CHECK(decision.best.places.at(0).curve == 5);
}

TEST_CASE("A gap that no effect goes along is unknown, also where one goes along a part of it") {
  const std::vector<Whole> effects = orthogonal_effects();
  const Whole elsewhere = world().direction(kEffects + 1);
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const Whole noise = LinearWorld::noise(seed);
    CHECK(world().decide(effects, 20 * elsewhere + noise, quick()).verdict == Verdict::unknown);
    const Decision part = world().decide(effects, 20 * elsewhere + 0.5 * effects[1] + noise, quick());
    CHECK(part.verdict == Verdict::unknown);
    CHECK(part.best.places.at(0).curve == 1);  // and says what it explains
  }
}

TEST_CASE("An effect beyond the end of its range is not named for what it cannot do") {
  const std::vector<Whole> effects = orthogonal_effects();
  // half of its length is left: 20 sigma
  CHECK(world().decide(effects, 1.5 * effects[0] + LinearWorld::noise(1), quick()).verdict == Verdict::unknown);
}

TEST_CASE("At the end of the range of an effect that does no more by then it is named all the same") {
  std::vector<Whole> effects = orthogonal_effects();
  const Whole gap = 1.1 * effects[0] + LinearWorld::noise(1);
  // up to 0.6 of its range nearly all comes; 1 % more until the end. Of the 110 % in the data, 9 % of 40 sigma are left
  // there and 9.25 % at 0.9: squared, 13 and 13.7, which is no difference.
  const auto amount = [](const NewPoint& effect) {
    const double size = std::abs(effect.value);
    return effect.curve != 0 ? effect.value
                             : std::copysign(size < 0.6 ? size / 0.6 : 1 + 0.025 * (size - 0.6), effect.value);
  };
  const auto saturated = [&](std::span<const NewPoint> asked) {
    Whole whole = Whole::Zero(LinearWorld::kBins);
    for (const NewPoint& effect : asked) whole += amount(effect) * effects[effect.curve];
    return LinearWorld::by_run(whole);
  };
  EffectCurves curves = world().curves(effects, gap);
  std::vector<NewPoint> known;
  std::vector<Shift> shifts_of_known;
  for (const double value : {-1.0, -0.25, 0.25, 0.6, 1.0}) {
    known.push_back({0, value});
    shifts_of_known.push_back(saturated({&known.back(), 1}));
  }
  insert_points(curves, known, shifts_of_known, Fidelity::every_run);
  Simulator simulator = world().simulator(effects);
  simulator.add_points = [&](EffectCurves& to, std::span<const NewPoint> points, Fidelity fidelity) {
    std::vector<Shift> shifts;
    for (const NewPoint& point : points) shifts.push_back(saturated({&point, 1}));
    insert_points(to, points, shifts, fidelity);
  };
  simulator.shifts = [&](std::span<const std::vector<NewPoint>> asked, Fidelity) {
    std::vector<Shift> shifts;
    for (const std::vector<NewPoint>& effects_asked : asked) shifts.push_back(saturated(effects_asked));
    return shifts;
  };
  const Decision decision = decide(curves, world().coherence(), LinearWorld::spread(), simulator, quick(), 1);
  CHECK(decision.verdict == Verdict::named);
  CHECK(decision.best.places.at(0).curve == 0);
  CHECK(decision.best.places.at(0).value == 1);
}

TEST_CASE("Exact simulations correct what coarse ones said of an effect's size, anywhere in its range") {
  const std::vector<Whole> effects = orthogonal_effects();
  for (const double rough : {0.8, 1.25})
    for (const double value : {-0.9, -0.3, 0.2, 0.6, 0.75, 0.95}) {
      const Decision decision = world().decide(effects, value * effects[3] + LinearWorld::noise(1), quick(), rough);
      INFO("coarse simulations say " << rough << " times as much of " << value);
      CHECK(decision.verdict == Verdict::named);
      REQUIRE(decision.best.places.size() == 1);
      CHECK(decision.best.places[0].curve == 3);
      // 4 sigma of 1 / 40, and half a sigma within which a simulated point is taken as the same
      CHECK(decision.best.places[0].value == Approx(value).margin(0.1125));
    }
}

TEST_CASE("Two effects together are both named") {
  const std::vector<Whole> effects = orthogonal_effects();
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const Decision decision =
        world().decide(effects, 0.5 * effects[1] - 0.4 * effects[6] + LinearWorld::noise(seed), quick());
    REQUIRE(decision.verdict == Verdict::named);
    REQUIRE(decision.best.places.size() == 2);
    CHECK(decision.best.places[0].curve == 1);
    CHECK(decision.best.places[0].value == Approx(0.5).margin(0.1));
    CHECK(decision.best.places[1].curve == 6);
    CHECK(decision.best.places[1].value == Approx(-0.4).margin(0.1));
  }
}

TEST_CASE("Three effects of a size are all named, with a third one that is a trifle of the gap the rest is not") {
  const std::vector<Whole> effects = orthogonal_effects();
  const Whole two = 0.5 * effects[1] - 0.4 * effects[6];
  const Decision all = world().decide(effects, two + 0.3 * effects[4] + LinearWorld::noise(1), quick());
  CHECK(all.verdict == Verdict::named);
  REQUIRE(all.best.places.size() == 3);
  std::vector<std::size_t> named;
  for (const OnCurve& place : all.best.places) named.push_back(place.curve);
  CHECK_THAT(named, Catch::Matchers::UnorderedEquals(std::vector<std::size_t>{1, 4, 6}));
  for (const OnCurve& place : all.best.places)
    CHECK(place.value == Approx(place.curve == 1 ? 0.5 : place.curve == 4 ? 0.3 : -0.4).margin(0.1));

  // of 20^2 + 16^2 = 656 and what the third one adds, 6.4^2 = 41 are 6 %; a tenth is due
  const Decision most = world().decide(effects, two + 0.16 * effects[4] + LinearWorld::noise(2), quick());
  CHECK(most.verdict == Verdict::unknown);
  CHECK(most.best.places.size() == 3);  // but says what it explains
}

TEST_CASE("Of two effects one has a look-alike: the other one is sure all the same") {
  std::vector<Whole> effects = orthogonal_effects();
  const double degree = 0.017453;
  effects[5] = std::cos(degree) * effects[2] + std::sin(degree) * kLength * world().direction(kEffects);
  const Decision decision =
      world().decide(effects, 0.5 * effects[2] + 0.5 * effects[7] + LinearWorld::noise(2), quick());
  REQUIRE(decision.verdict == Verdict::ambiguous);
  REQUIRE(decision.best.places.size() == 2);
  const std::size_t sure = decision.best.places[0].curve == 7 ? 0 : 1;
  CHECK(decision.best.places[sure].curve == 7);
  CHECK(decision.rivals[sure].size() == 1);
  CHECK(holds(decision, 1 - sure, 2));
  CHECK(holds(decision, 1 - sure, 5));
}

TEST_CASE("A floor that is wider around an effect excuses a gap only where that effect fits it") {
  const std::vector<Whole> effects = orthogonal_effects();
  EffectCurves curves;
  const auto verdict_of = [&](const Whole& gap) {
    curves = world().curves(effects, gap);
    Simulator simulator = world().simulator(effects);
    // around effect 4 nothing can be known to less than 10 sigma
    simulator.whiteners_around = [](std::span<const NewPoint> model) {
      const bool wide = std::ranges::any_of(model, [](const NewPoint& effect) { return effect.curve == 4; });
      const Eigen::VectorXd sigma = Eigen::VectorXd::Constant(LinearWorld::kBinsOfRun, wide ? 10 : 1);
      return std::vector<Whitener>(LinearWorld::kRuns,
                                   Whitener(sigma, Eigen::MatrixXd::Zero(LinearWorld::kBinsOfRun, 1)));
    };
    return decide(curves, world().coherence(), LinearWorld::spread(), simulator, quick(), 1).verdict;
  };
  // all of it is along the effect: 10 sigma, which are 1 in that floor
  CHECK(verdict_of(10 * effects[4] / kLength + LinearWorld::noise(4)) == Verdict::none);
  // of 20^2 + 10^2 squared it takes off a fifth: what is left is there all the same
  CHECK(verdict_of(20 * world().direction(kEffects + 1) + 10 * effects[4] / kLength + LinearWorld::noise(4)) ==
        Verdict::unknown);
}

TEST_CASE("Effects that change what the other one does are named at their values") {
  // beside a half of effect 6, effect 1 does 1.9 times what it does alone: who corrects the sum of what they do alone
  // by what was left of the last simulation goes 1.9 times as far as he should, and so back and forth
  const std::vector<Whole> effects = orthogonal_effects();
  const auto moved = [&](std::span<const NewPoint> asked) {
    Whole whole = Whole::Zero(LinearWorld::kBins);
    double one = 0, six = 0;
    for (const NewPoint& effect : asked) {
      whole += effect.value * effects[effect.curve];
      if (effect.curve == 1) one = effect.value;
      if (effect.curve == 6) six = effect.value;
    }
    return LinearWorld::by_run(whole + 1.8 * one * six * effects[1]);
  };
  const auto decision_of = [&](double one, double six, std::uint64_t seed) {
    const std::vector<NewPoint> truth{{1, one}, {6, six}};
    Whole gap = LinearWorld::noise(seed);
    for (std::size_t r = 0; r < LinearWorld::kRuns; ++r)
      gap.segment(static_cast<Eigen::Index>(r * LinearWorld::kBinsOfRun), LinearWorld::kBinsOfRun) += moved(truth)[r];
    EffectCurves curves = world().curves(effects, gap);
    Simulator simulator = world().simulator(effects);
    simulator.shifts = [&](std::span<const std::vector<NewPoint>> asked, Fidelity) {
      std::vector<Shift> shifts;
      for (const std::vector<NewPoint>& effects_asked : asked) shifts.push_back(moved(effects_asked));
      return shifts;
    };
    return decide(curves, world().coherence(), LinearWorld::spread(), simulator, quick(), 1);
  };
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const Decision decision = decision_of(0.3, 0.5, seed);
    INFO("seed " << seed);
    CHECK(decision.verdict == Verdict::named);
    REQUIRE(decision.best.places.size() == 2);
    for (const OnCurve& place : decision.best.places)
      CHECK(place.value == Approx(place.curve == 1 ? 0.3 : 0.5).margin(0.1));
    // in the decision's own curves, not in those of each effect alone
    CHECK(decision.beside.size() == effects.size());
  }
}

TEST_CASE("What explains less than the negligible share of the noise is none, however sure it is") {
  const std::vector<Whole> effects = orthogonal_effects();
  // without any noise 5 sigma along one effect explain 25. The noise's squared length would be 192: a quarter of its
  // length has a square of 12, a half 48.
  const Whole gap = effects[4] * 5 / kLength;
  DecisionSettings settings = quick();
  CHECK(world().decide(effects, gap, settings).verdict == Verdict::named);
  settings.negligible = 0.5;
  const Decision decision = world().decide(effects, gap, settings);
  CHECK(decision.verdict == Verdict::none);
  CHECK(decision.best.places.empty());
  CHECK(decision.p_gap <= settings.false_alarm);
}

TEST_CASE("Repeats that differ more than the floor says make a verdict harder to get") {
  const std::vector<Whole> effects = orthogonal_effects();
  EffectCurves curves = world().curves(effects, effects[4] * 7 / kLength);
  const auto verdict = [&](double inflation) {
    return decide(curves, world().coherence(), {inflation, static_cast<double>(LinearWorld::kBins)},
                  world().simulator(effects), quick(), 1)
        .verdict;
  };
  // 49 explained, against 13 as the luckiest of eight effects in 400 draws, and a margin of 9
  CHECK(verdict(1) == Verdict::named);
  CHECK(verdict(9) == Verdict::none);
}
