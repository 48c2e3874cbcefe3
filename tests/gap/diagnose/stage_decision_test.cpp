// Verdicts in a world whose effects are fixed vectors: tests/gap/linear_world.hpp.
#include "gap/diagnose/stage_decision.hpp"
#include "gap/diagnose/stage_candidates.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "gap/diagnose/other_stages.hpp"
#include "tests/gap/diagnose/linear_world.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::candidates;
using namespace kenaf::gap::diagnose;
using test::LinearWorld;
using test::Whole;
using test::world;

namespace {

constexpr std::size_t kEffects = 8;
constexpr double kLength = 60;  // of an effect's shift at the end of its range, in noise

const LinearWorld& six_manoeuvres() {
  static const LinearWorld world({6, 2, 3});
  return world;
}

std::vector<Whole> orthogonal_effects(const LinearWorld& of = world()) {
  std::vector<Whole> effects;
  for (std::size_t i = 0; i < kEffects; ++i) effects.push_back(kLength * of.direction(static_cast<Eigen::Index>(i)));
  return effects;
}

// Another one at an angle to effect 2, in the place of effect 5.
std::vector<Whole> with_look_alike(double degrees, const LinearWorld& of = world()) {
  std::vector<Whole> effects = orthogonal_effects(of);
  const double angle = degrees * 0.0174533;
  effects[5] = std::cos(angle) * effects[2] + std::sin(angle) * kLength * of.direction(kEffects);
  return effects;
}

std::vector<std::size_t> candidates_of(const StageDecision& decision) {
  std::vector<std::size_t> result;
  for (const ModelEffect& effect : decision.effects) result.push_back(effect.candidate);
  return result;
}

}  // namespace

// One in 200 expected at most; three or more have a chance of 8 %, of which most is not used: what is small is no gap.
TEST_CASE("Pure noise is called none") {
  const std::vector<Whole> effects = orthogonal_effects();
  int alarms = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed)
    alarms += world().decide(effects, world().noise(1000 + seed)).verdict != Verdict::none;
  INFO(alarms << " of 200");
  CHECK(alarms <= 2);
}

TEST_CASE("One effect is named alone, at its value") {
  const std::vector<Whole> effects = orthogonal_effects();
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const double value = seed % 2 == 0 ? 0.3 : -0.3;
    const StageDecision decision = world().decide(effects, value * effects[3] + world().noise(seed));
    REQUIRE(decision.verdict == Verdict::named);
    REQUIRE(candidates_of(decision) == std::vector<std::size_t>{3});
    const ModelEffect& effect = decision.effects[0];
    CHECK(effect.rivals == std::vector<std::size_t>{3});
    CHECK(effect.doubts.empty());
    CHECK(effect.value.value.value == Approx(value).margin(4.0 / kLength));  // its sigma is 1 / 60
    CHECK(decision.complete);
    CHECK(decision.best.model.exact);
    CHECK(decision.p_gap < 0.001);
  }
}

TEST_CASE("Two effects are both named, at their values") {
  const std::vector<Whole> effects = orthogonal_effects();
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    const StageDecision decision = world().decide(effects, 0.5 * effects[1] - 0.4 * effects[6] + world().noise(seed));
    REQUIRE(decision.verdict == Verdict::named);
    REQUIRE_THAT(candidates_of(decision), Catch::Matchers::UnorderedEquals(std::vector<std::size_t>{1, 6}));
    for (const ModelEffect& effect : decision.effects) {
      CHECK(effect.doubts.empty());
      CHECK(effect.value.value.value == Approx(effect.candidate == 1 ? 0.5 : -0.4).margin(4.0 / kLength));
    }
  }
}

TEST_CASE("Two effects with the same shift are indistinguishable") {
  for (const double degrees : {0.0, 1.0})
    for (const std::size_t truth : {2u, 5u}) {
      const std::vector<Whole> effects = with_look_alike(degrees);
      const StageDecision decision = world().decide(effects, 0.5 * effects[truth] + world().noise(1));
      REQUIRE(decision.verdict == Verdict::ambiguous);
      REQUIRE(decision.effects.size() == 1);
      CHECK_THAT(decision.effects[0].rivals, Catch::Matchers::UnorderedEquals(std::vector<std::size_t>{2, 5}));
      // each of them with a model of its own
      REQUIRE(decision.models_of_rivals.size() == 1);
      CHECK(decision.models_of_rivals[0].size() == 2);
    }
}

TEST_CASE("Of two indistinguishable effects the one counts that another stage names at the same value") {
  const std::vector<Whole> effects = with_look_alike(0);
  const Whole gap = 0.5 * effects[2] + world().noise(1);
  const auto decided = [&](std::vector<NamedElsewhere> elsewhere) {
    const StageAround nominal{world().floor(), world().data(gap)};
    return decide_stage(nominal, world().curves(effects, nominal.data), world().simulate(LinearWorld::linear(effects)),
                        [&](const Settings&, std::span<const std::size_t>) { return nominal; }, {}, {},
                        {elsewhere, {}});
  };
  for (const std::size_t named : {2u, 5u}) {
    const StageDecision decision = decided({{named, {0.5, 0.49, 0.51}}});
    REQUIRE(candidates_of(decision) == std::vector<std::size_t>{named});
    CHECK(decision.effects[0].rivals == std::vector<std::size_t>{named});
    CHECK(decision.models_of_rivals[0].size() == 1);
    CHECK(decision.effects[0].value.value.value == Approx(0.5).margin(4.0 / kLength));
  }
  // at another value it is not what both show, nor is what has nothing to do with it
  CHECK(decided({{5, {0.8, 0.79, 0.81}}}).effects[0].rivals.size() == 2);
  CHECK(decided({{7, {0.5, 0.49, 0.51}}}).effects[0].rivals.size() == 2);
}

TEST_CASE("What another stage refutes is not searched for, and gives way to what it does not refute") {
  const std::vector<Whole> effects = with_look_alike(0);
  const StageAround nominal{world().floor(), world().data(0.5 * effects[2] + world().noise(1))};
  const auto decided = [&](std::vector<RefutedElsewhere> refuted) {
    return decide_stage(nominal, world().curves(effects, nominal.data), world().simulate(LinearWorld::linear(effects)),
                        [&](const Settings&, std::span<const std::size_t>) { return nominal; }, {}, {},
                        {{}, std::move(refuted)});
  };
  for (const std::size_t refuted : {2u, 5u}) {
    const StageDecision decision = decided({{refuted, Passage::command_to_drive}});
    REQUIRE(candidates_of(decision) == std::vector<std::size_t>{refuted == 2 ? 5u : 2u});
    CHECK(decision.effects[0].rivals.size() == 1);
  }
  // with no other one left nothing explains the gap
  const StageDecision neither = decided({{2, Passage::command_to_drive}, {5, Passage::command_to_drive}});
  CHECK(std::ranges::none_of(candidates_of(neither), [](std::size_t c) { return c == 2 || c == 5; }));
  CHECK(neither.verdict == Verdict::unknown);
}

TEST_CASE("A stage refutes an effect where it acts there, whatever else remains") {
  // Nothing explains what remains in x, 100 in units of noise. The effect adds three times the noise to each bin of
  // yaw: 48 times 9, a twentieth of all squares, but nine times what yaw has.
  std::vector<Whole> effects(LinearWorld::kCandidates, Whole::Zero(world().bins()));
  const Whole in_yaw = world().in_channel(test::WorldChannel::yaw, 1);
  effects[3] = (in_yaw.array() != 0).select(3 * world().noise(2), 0);
  const auto refuted = [&](const Whole& gap) {
    StageDecision decision;
    decision.data = world().data(gap + world().noise(1));
    decision.best = {nominal_model(decision.data), world().curves(effects, decision.data)};
    const std::vector<Setting> values{{3, 1}, {3, 0.9}, {3, 1.0}};
    return refutes(decision, world().simulate(LinearWorld::linear(effects)), values, {});
  };
  const Whole in_x = world().in_channel(test::WorldChannel::x, 100);
  CHECK(refuted(in_x));
  CHECK_FALSE(refuted(in_x + effects[3]));
}

// 0.2 of the effect adds twice the noise to each bin of yaw, so without it the squares there are 1 + 2^2 = 5 times
// those of noise. With a value of 1 they are 1 + 8^2 = 65 times, with -0.2 1 + 4^2 = 17 times, with 0.2 as large as
// noise.
TEST_CASE("A stage refutes an effect that it has itself at another value") {
  std::vector<Whole> effects(LinearWorld::kCandidates, Whole::Zero(world().bins()));
  effects[3] = (world().in_channel(test::WorldChannel::yaw, 1).array() != 0).select(10 * world().noise(2), 0);
  StageDecision decision;
  decision.data =
      world().data(0.2 * effects[3] + 100 * world().in_channel(test::WorldChannel::x, 1) + world().noise(1));
  decision.best = world().fitted(effects, decision.data, {3});
  const auto refuted = [&](double value) {
    const std::vector<Setting> values{{3, value}, {3, 0.95 * value}, {3, 1.05 * value}};
    return refutes(decision, world().simulate(LinearWorld::linear(effects)), values, {});
  };
  CHECK(refuted(1));
  CHECK(refuted(-0.2));
  CHECK_FALSE(refuted(0.2));
}

TEST_CASE("A stage lacks an effect that another one names if its residual has it, at the value found there") {
  // 0.4 of effect 6 lowers the deviance by the squares of 0.4 * 60
  const std::vector<Whole> effects = orthogonal_effects();
  const Whole gap = 0.5 * effects[1] - 0.4 * effects[6] + world().noise(1);
  StageDecision decision;
  decision.data = world().data(gap);
  decision.best = world().fitted(effects, decision.data, {1});
  decision.effects.emplace_back();
  const auto is_lacking = [&](const NamedElsewhere& named) {
    return lacks(decision, world().simulate(LinearWorld::linear(effects)), {&named, 1}, {});
  };
  CHECK(is_lacking({6, {-0.4, -0.45, -0.35}}));
  CHECK(is_lacking({6, {-0.9, -1.4, -0.4}}));  // an end of the interval fits
  CHECK_FALSE(is_lacking({6, {0.4, 0.35, 0.45}}));
  CHECK_FALSE(is_lacking({7, {-0.4, -0.45, -0.35}}));
  CHECK_FALSE(is_lacking({1, {0.5, 0.45, 0.55}}));  // it has that
}

TEST_CASE("At 45 degrees they are distinguishable") {
  for (const std::size_t truth : {2u, 5u}) {
    const std::vector<Whole> effects = with_look_alike(45);
    const StageDecision decision = world().decide(effects, 0.5 * effects[truth] + world().noise(1));
    CHECK(decision.verdict == Verdict::named);
    CHECK(candidates_of(decision) == std::vector<std::size_t>{truth});
  }
}

TEST_CASE("Of two effects one has a look-alike: the other one is sure all the same") {
  const std::vector<Whole> effects = with_look_alike(1);
  const StageDecision decision = world().decide(effects, 0.5 * effects[2] + 0.5 * effects[7] + world().noise(2));
  REQUIRE(decision.verdict == Verdict::ambiguous);
  REQUIRE(decision.effects.size() == 2);
  for (const ModelEffect& effect : decision.effects)
    if (effect.candidate == 7)
      CHECK(effect.rivals == std::vector<std::size_t>{7});
    else
      CHECK_THAT(effect.rivals, Catch::Matchers::UnorderedEquals(std::vector<std::size_t>{2, 5}));
}

TEST_CASE("A gap that is like no effect of the catalogue is unknown") {
  const std::vector<Whole> effects = orthogonal_effects();
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    const StageDecision decision = world().decide(effects, 30 * world().direction(kEffects + 1) + world().noise(seed));
    CHECK(decision.verdict == Verdict::unknown);
    CHECK(decision.p_gap < 0.001);
    CHECK_FALSE(decision.complete);
  }
}

TEST_CASE("With a coherent discrepancy of a third of its size an effect is named, less surely, and not as complete") {
  const LinearWorld& world = six_manoeuvres();
  const std::vector<Whole> effects = orthogonal_effects(world);
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    const Whole wander = world.wander(1, 1, 50 + seed);
    const Whole exact = 0.6 * effects[3] + world.noise(seed);
    const Whole imperfect = exact + 0.6 * kLength / 3 / wander.norm() * wander;
    const StageDecision sure = world.decide(effects, exact), decision = world.decide(effects, imperfect);
    INFO("seed " << seed);
    REQUIRE(sure.verdict == Verdict::named);
    REQUIRE(decision.verdict == Verdict::named);
    REQUIRE(candidates_of(decision) == std::vector<std::size_t>{3});
    CHECK(sure.complete);
    CHECK_FALSE(decision.complete);
    // noise alone makes it 2 x 1.96 / 60
    const Interval& interval = decision.effects[0].value.value;
    CHECK(interval.to - interval.from > 1.2 * 2 * 1.96 / kLength);
    CHECK(interval.from < 0.6);
    CHECK(interval.to > 0.6);
    CHECK(decision.effects[0].evidence < sure.effects[0].evidence);
  }
}

TEST_CASE("An effect beyond the end of its range is not named for what it cannot do") {
  const std::vector<Whole> effects = orthogonal_effects();
  const StageDecision decision = world().decide(effects, 1.5 * effects[0] + world().noise(1));
  CHECK(decision.verdict == Verdict::unknown);
  REQUIRE(decision.effects.size() == 1);
  CHECK(decision.effects[0].at_bound);
  CHECK(decision.effects[0].doubts.front() == Doubt::end_of_range);
}

TEST_CASE("A number of the description gets no name where it is off by no more than the others are") {
  const std::vector<Whole> effects = orthogonal_effects();
  const Whole gap = 0.3 * effects[0] + world().noise(1);
  StageDecision decision = world().decide(effects, gap);
  REQUIRE(decision.verdict == Verdict::named);
  const auto judged = [&](double ordinarily_off) {
    StageDecision again = decision;
    again.effects[0].ordinarily_off = ordinarily_off;
    judge(again, world().candidates(kEffects), {{decision.effects[0].share}, {}, 1},
          {{decision.effects[0].share}, {}, 1}, {});
    return again;
  };
  // at three sigma it begins to be one of them
  CHECK(judged(0.09).verdict == Verdict::named);
  REQUIRE(judged(0.11).verdict == Verdict::unknown);
  CHECK(judged(0.11).effects[0].doubts == std::vector{Doubt::ordinary});
  CHECK(judged(0).verdict == Verdict::named);  // no number of the description
}

TEST_CASE("At the end of the range of an effect that does no more by then it is named all the same") {
  // up to 0.6 of its range nearly all comes; 1 % more until the end. Of the 102 % in the data, 1 % of 60 are left at
  // the end and 1.25 % at 0.9: squared, 0.4 and 0.6, which is no difference
  const std::vector<Whole> effects = orthogonal_effects();
  const auto saturated = [&](const Settings& settings) {
    Whole whole = Whole::Zero(world().bins());
    for (const Setting& setting : settings) {
      const double size = std::abs(setting.value);
      const double amount = setting.candidate != 0 ? size : size < 0.6 ? size / 0.6 : 1 + 0.025 * (size - 0.6);
      whole += std::copysign(amount, setting.value) * effects[setting.candidate];
    }
    return whole;
  };
  const StageDecision decision = world().decide(saturated, kEffects, 1.02 * effects[0] + world().noise(1));
  CHECK(decision.verdict == Verdict::named);
  REQUIRE(candidates_of(decision) == std::vector<std::size_t>{0});
  CHECK_FALSE(decision.effects[0].at_bound);
}

TEST_CASE("An effect that would need another value in each manoeuvre is not named") {
  const LinearWorld& world = six_manoeuvres();
  const std::vector<Whole> effects = orthogonal_effects(world);
  const auto with_values = [&](const std::vector<double>& values) {
    Whole gap = world.noise(1);
    for (std::size_t m = 0; m < 6; ++m) {
      const Eigen::Index first = static_cast<Eigen::Index>(m) * world.bins_of_manoeuvre();
      gap.segment(first, world.bins_of_manoeuvre()) += values[m] * effects[2].segment(first, world.bins_of_manoeuvre());
    }
    return world.decide(effects, gap);
  };
  CHECK(with_values({0.5, 0.5, 0.5, 0.5, 0.5, 0.5}).verdict == Verdict::named);
  CHECK(with_values({0.9, -0.6, 0.8, -0.3, 0.9, 0.1}).verdict == Verdict::unknown);
}

TEST_CASE("What explains less than the negligible share of the noise is none, however sure it is") {
  // without any noise 6 along one effect explain 36, and no cell stands out; the noise's squared length would be 96
  const std::vector<Whole> effects = orthogonal_effects();
  const auto verdict_with = [&](double negligible) {
    DecisionSettings settings;
    settings.negligible = negligible;
    return world().decide(LinearWorld::linear(effects), kEffects, effects[4] * 6 / kLength, 1, {}, settings);
  };
  const StageDecision large = verdict_with(0.5), small = verdict_with(0.7);
  CHECK(large.verdict != Verdict::none);  // 36 of a quarter of 96
  CHECK(small.verdict == Verdict::none);  // of a half
  CHECK(small.effects.empty());
  CHECK(small.p_gap <= DecisionSettings{}.false_alarm);
}

TEST_CASE("Repeats that differ more than the floor says make a gap harder to see") {
  const std::vector<Whole> effects = orthogonal_effects();
  const auto verdict = [&](double inflation) {
    return world().decide(LinearWorld::linear(effects), kEffects, effects[4] * 7 / kLength, 1, {inflation, 1}).verdict;
  };
  CHECK(verdict(1) != Verdict::none);
  CHECK(verdict(9) == Verdict::none);
}

TEST_CASE("No effect is added where what is left is within what repeats differ by, whatever it gains") {
  // in addition to one of 30 sigma another one of 6 gains 36 of deviance
  const std::vector<Whole> effects = orthogonal_effects();
  const Whole gap = effects[2] * 30 / kLength + effects[4] * 6 / kLength;
  const auto found = [&](double inflation) {
    return candidates_of(world().decide(LinearWorld::linear(effects), kEffects, gap, 1, {inflation, 1}));
  };
  CHECK_THAT(found(1), Catch::Matchers::UnorderedEquals(std::vector<std::size_t>{2, 4}));
  CHECK(found(9) == std::vector<std::size_t>{2});
}

TEST_CASE("Of a decision some effects alone are fitted again without the others") {
  const std::vector<Whole> effects = orthogonal_effects();
  const StageAround nominal{world().floor(), world().data(0.5 * effects[1] - 0.4 * effects[6] + world().noise(1))};
  const EffectCurves curves = world().curves(effects, nominal.data);
  const Simulate simulate = world().simulate(LinearWorld::linear(effects));
  const Around around = [&](const Settings&, std::span<const std::size_t>) { return nominal; };
  const StageDecision both = decide_stage(nominal, curves, simulate, around, {}, {});
  REQUIRE(both.effects.size() == 2);
  REQUIRE(both.complete);
  const std::vector<std::size_t> first{0};
  const StageDecision one = decide_again(both, with_effects_alone(both, first), simulate, around, {}, {});
  REQUIRE(candidates_of(one) == std::vector<std::size_t>{both.effects[0].candidate});
  CHECK(one.effects[0].value.value.value == Approx(both.effects[0].value.value.value).margin(2 * 4.0 / kLength));
  // what the other one explained is left, and makes this one less sure
  CHECK_FALSE(one.complete);
  CHECK(one.effects[0].evidence < both.effects[0].evidence);
  CHECK(one.models_of_rivals.size() == 1);
}

TEST_CASE("Decided again in other noise, single effects gain what they gain if decided in it first") {
  const std::vector<Whole> effects = orthogonal_effects();
  const StageAround quiet{world().floor(), world().data(0.5 * effects[1] - 0.4 * effects[6] + world().noise(1))};
  StageAround noisy = quiet;
  for (StageGroup& group : noisy.data.groups) group.variance *= 4;
  const Simulate simulate = world().simulate(LinearWorld::linear(effects));
  const auto around = [](const StageAround& there) {
    return [&there](const Settings&, std::span<const std::size_t>) { return there; };
  };
  const auto first_decided = [&](const StageAround& there) {
    return decide_stage(there, world().curves(effects, there.data), simulate, around(there), {}, {});
  };
  const StageDecision in_quiet = first_decided(quiet), in_noise = first_decided(noisy);
  REQUIRE(in_quiet.effects.size() == 2);
  const std::vector<std::size_t> all{0, 1};
  const StageDecision again =
      decide_again(in_quiet, with_effects_alone(in_quiet, all), simulate, around(noisy), {}, {});
  const auto gain = [](const StageDecision& decision) {
    return decision.nominal_deviance - decision.singles.front().deviance();
  };
  CHECK(again.singles.front().places.front().curve == in_noise.singles.front().places.front().curve);
  CHECK(gain(again) == Approx(gain(in_noise)).epsilon(0.02));
  CHECK(gain(again) < 0.9 * gain(in_quiet));
}

TEST_CASE("Each stage looks for what can act in it") {
  const physics::RobotDescription robot = physics::load_robot("kenaf");
  const std::vector<Candidate> candidates = leave_out(all_candidates(robot, false), {});
  const auto acts = [&](Passage passage, std::string_view name, bool drives_measured = true) {
    return std::ranges::any_of(gap::diagnose::candidates_of(passage, candidates, drives_measured),
                               [&](std::size_t c) { return candidates[c].name == name; });
  };
  CHECK(acts(Passage::command_to_drive, "drive_lag"));
  CHECK(acts(Passage::command_to_drive, "mass"));
  // what drives report late, but nothing of what sees the body
  for (const char* name :
       {"encoder_scale", "sensor[Encoder].delay_s", "sensor[Tachometer].delay_s", "sensor[Drives].delay_s"})
    CHECK(acts(Passage::command_to_drive, name));
  for (const char* name : {"gyro_bias", "posture_delay", "clock_offset"})
    CHECK_FALSE(acts(Passage::command_to_drive, name));
  // belts and servos turn as they were measured; an arm gives way behind its encoder
  CHECK_FALSE(acts(Passage::drive_to_body, "drive_lag"));
  CHECK(acts(Passage::drive_to_body, "drive_lag", false));
  CHECK_FALSE(acts(Passage::drive_to_body, "flipper_lag"));
  for (const char* name :
       {"flipper_compliance", "flipper_backlash", "sensor[Encoder].delay_s", "clock_offset", "track.separation_m"})
    CHECK(acts(Passage::drive_to_body, name));
  CHECK(acts(Passage::body_to_sensor, "gyro_bias"));
  CHECK_FALSE(acts(Passage::body_to_sensor, "mass"));
}

TEST_CASE("A floor that is wider around an effect excuses a gap only where that effect fits it") {
  const std::vector<Whole> effects = orthogonal_effects();
  const auto verdict_of = [&](const Whole& gap) {
    const StageAround nominal{world().floor(), world().data(gap)};
    // around effect 4 nothing can be known to less than 20 sigma
    const Around around = [&](const Settings& settings, std::span<const std::size_t>) {
      StageAround result = nominal;
      if (std::ranges::any_of(settings, [](const Setting& setting) { return setting.candidate == 4; }))
        for (StageGroup& group : result.data.groups) group.variance *= 400;
      return result;
    };
    return decide_stage(nominal, world().curves(effects, nominal.data), world().simulate(LinearWorld::linear(effects)),
                        around, {}, {})
        .verdict;
  };
  CHECK(verdict_of(effects[4] / 3 + world().noise(4)) == Verdict::none);  // all of it is along the effect
  // a quarter of it is, what is left is there all the same
  CHECK(verdict_of(30 * world().direction(kEffects + 1) + effects[4] / 3 + world().noise(4)) != Verdict::none);
}

namespace {

// Judged by these shares of the gap, on runs and on manoeuvres held out alike.
StageDecision judged(double first, double second, double both, double shown_by_others = 1000) {
  const auto share = [&](double taken) {
    return HeldOutShares::OfEffect{taken, taken, taken, 0, 0.9, shown_by_others};
  };
  const HeldOutShares shares{{share(first), share(second)}, {{{0, 1}, share(both)}}, 0.9};
  StageDecision decision;
  std::vector<Candidate> candidates(2);
  for (std::size_t c = 0; c < candidates.size(); ++c)
    decision.effects.push_back({c, {{1, 0.9, 1.1}, 0, 1}, 100, {}, {}, false, {}, {c}, {}, {}});
  judge(decision, candidates, shares, shares, {});
  return decision;
}

}  // namespace

TEST_CASE(
    "Two effects that each absorb what the other leaves are named as a set, a negligible addition to another one is "
    "not") {
  const StageDecision set = judged(0.05, 0.13, 0.8);
  CHECK(set.verdict == Verdict::ambiguous);
  CHECK(set.effects[0].rivals == std::vector<std::size_t>{0, 1});
  CHECK(set.effects[1].rivals == std::vector<std::size_t>{1, 0});
  CHECK(set.effects[0].partners == std::vector<std::size_t>{1});
  CHECK(set.effects[1].share_of_set.of_kind == 0.8);

  const StageDecision one = judged(0.6, 0.04, 0.64);
  CHECK(one.verdict == Verdict::named);
  CHECK(one.effects[0].doubts.empty());
  CHECK(one.effects[1].doubts == std::vector<Doubt>{Doubt::not_held_out});
  CHECK(judged(0.05, 0.04, 0.1).verdict == Verdict::unknown);

  // one of them may have enough alone: together they explain 94 %, without one or the other 25 and 12 % are lost
  const StageDecision stand_in = judged(0.25, 0.12, 0.94);
  CHECK(stand_in.verdict == Verdict::ambiguous);
  CHECK(stand_in.effects[0].rivals == std::vector<std::size_t>{0, 1});
  CHECK(stand_in.effects[1].partners == std::vector<std::size_t>{0});
  const StageDecision each_its_own = judged(0.3, 0.12, 0.5);
  CHECK(each_its_own.verdict == Verdict::named);
  CHECK(each_its_own.effects[1].doubts == std::vector<Doubt>{Doubt::not_held_out});
}

TEST_CASE("Of several sets that explain enough the one counts that explains most, with all that substitute for it") {
  const auto share = [](double taken) { return HeldOutShares::OfEffect{taken, taken, taken, 0, 0.9, 1000}; };
  const auto partners_of_last = [&](double all_three) {
    StageDecision decision;
    for (const std::size_t c : {0u, 1u, 2u})
      decision.effects.push_back({c, {{1, 0.9, 1.1}, 0, 1}, 100, {}, {}, false, {}, {c}, {}, {}});
    const HeldOutShares shares{
        {share(0.02), share(0.05), share(0.1)},
        {{{0, 1}, share(0.25)}, {{0, 2}, share(0.21)}, {{1, 2}, share(0.3)}, {{0, 1, 2}, share(all_three)}},
        0.9};
    judge(decision, std::vector<Candidate>(3), shares, shares, {});
    return decision.effects.back().partners;
  };
  // the first one adds 0.09 to 0.3: less than a share of the stage that would give a name
  CHECK(partners_of_last(0.39) == std::vector<std::size_t>{1});
  // 0.11: what the three of them take off and no two of them
  CHECK(partners_of_last(0.41) == std::vector<std::size_t>{0, 1});
}

TEST_CASE("Of a lag and a ramp, which together are one step's course, neither is asked to be the same early and late") {
  StageDecision decision;
  for (const std::size_t c : {0u, 1u})
    decision.effects.push_back({c, {{1, 0.9, 1.1}, 0, 1, 1.2}, 100, {}, {}, false, {}, {c}, {}, {}});
  const auto share = [](double taken) { return HeldOutShares::OfEffect{taken, taken, taken, 0, 0.9, 1000}; };
  const HeldOutShares shares{{share(0.05), share(0.13)}, {{{0, 1}, share(0.8)}}, 0.9};
  judge(decision, std::vector<Candidate>(2), shares, shares, {});
  CHECK(decision.verdict == Verdict::ambiguous);
  CHECK(decision.effects[0].partners == std::vector<std::size_t>{1});
}

TEST_CASE(
    "A misfit with a share of its own joins a set only if its members do something together that none does alone") {
  // the second one has 0.22 by itself, and a trend; the first one has 0.05
  const auto verdict = [](double both) {
    StageDecision decision;
    for (const std::size_t c : {0u, 1u})
      decision.effects.push_back({c, {{1, 0.9, 1.1}, 0, 1, c == 1 ? 1.2 : 0}, 100, {}, {}, false, {}, {c}, {}, {}});
    const auto share = [](double taken) { return HeldOutShares::OfEffect{taken, taken, taken, 0, 0.9, 1000}; };
    const HeldOutShares shares{{share(0.05), share(0.22)}, {{{0, 1}, share(both)}}, 0.9};
    judge(decision, std::vector<Candidate>(2), shares, shares, {});
    return decision.verdict;
  };
  CHECK(verdict(0.38) == Verdict::ambiguous);  // 0.11 of it together: a share that would give a name
  CHECK(verdict(0.36) == Verdict::unknown);    // 0.09: a look-alike with something small beside it
}

TEST_CASE("Half of what ordinary numbers leave is negligible where they leave next to nothing") {
  const auto verdict = [](double of_stage, double beyond_numbers) {
    StageDecision decision;
    decision.effects.push_back({0, {{1, 0.9, 1.1}, 0, 1}, 100, {}, {}, false, {}, {0}, {}, {}});
    const HeldOutShares shares{{{of_stage, beyond_numbers, 0.7, 0, 0.9, 1000}}, {}, 0.9};
    judge(decision, std::vector<Candidate>(1), shares, shares, {});
    return decision.verdict;
  };
  CHECK(verdict(0.07, 0.5) == Verdict::unknown);
  CHECK(verdict(0.5, 0.07) == Verdict::unknown);  // ordinary numbers do all of it as well
  CHECK(verdict(0.5, 0.5) == Verdict::named);
}

TEST_CASE("An effect that grows from nothing in the course of a run is not the one that it looks like") {
  const auto verdict = [](double trend) {
    StageDecision decision;
    decision.effects.push_back({0, {{-0.07, -0.08, -0.06}, 0, 1, trend}, 100, {}, {}, false, {}, {0}, {}, {}});
    const HeldOutShares shares{{{0.9, 0.9, 0.9, 0, 0.9, 1000}}, {}, 0.9};
    judge(decision, std::vector<Candidate>(1), shares, shares, {});
    return decision.verdict;
  };
  // a gain that falls evenly from 1 is 0.93 in the mean: 0.965 in the first half, 0.895 in the second
  CHECK(verdict(0.07) == Verdict::unknown);
  CHECK(verdict(0.02) == Verdict::named);
}

TEST_CASE("An effect that only one manoeuvre shows is judged by its repeats, as no other one predicts it") {
  const HeldOutShares by_repeat{{{0.9, 0.9, 0.9, 0, 0.9, 500}}, {}, 0.9};
  const auto verdict = [&](double shown_by_others) {
    StageDecision decision;
    decision.effects.push_back({0, {{1, 0.9, 1.1}, 0, 1}, 100, {}, {}, false, {}, {0}, {}, {}});
    judge(decision, std::vector<Candidate>(1), by_repeat, {{{0, 0, 0, 0, 0, shown_by_others}}, {}, 0}, {});
    return decision.verdict;
  };
  CHECK(verdict(1) == Verdict::named);      // the others hardly show it: nothing can be held out
  CHECK(verdict(400) == Verdict::unknown);  // they should, and predict nothing of it
}

namespace {
// The judgement of one effect of 1 that explains nearly all of the stage's gap.
StageDecision judged_with(const EffectValue& value, double simulated = 0.9, double sure_from = 0) {
  StageDecision decision;
  decision.effects.push_back({0, value, 100, {}, {}, false, {}, {0}, {}, {}});
  decision.effects.front().sure_from = sure_from;
  const HeldOutShares shares{{{0.9, 0.9, 0.9, 0, 0.9, 1000}}, {}, 0.9};
  judge(decision, std::vector<Candidate>(1), shares, shares, {});
  doubt_unless_simulated(decision, simulated, simulated, {});
  doubt_uncertain_values(decision, std::vector<Candidate>(1));
  return decision;
}
}  // namespace

TEST_CASE("Beside an unexplained rest, what one manoeuvre alone shows has a name only if others predict part of it") {
  const auto doubts = [](bool complete, double on_manoeuvres, double shown_by_others = 1) {
    StageDecision decision;
    decision.complete = complete;
    decision.effects.push_back({0, {{1, 0.9, 1.1}, 0, 1}, 100, {}, {}, false, {}, {0}, {}, {}});
    const HeldOutShares shares{{{0.9, 0.9, 0.9, 0, 0.9, shown_by_others}}, {}, 0.9};
    judge(decision, std::vector<Candidate>(1), shares, shares, {});
    doubt_unless_simulated(decision, 0.9, on_manoeuvres, {});
    return decision.effects.front().doubts;
  };
  CHECK(doubts(true, 0).empty());  // only that manoeuvre shows it, and nothing else is left
  CHECK(doubts(false, 0) == std::vector<Doubt>{Doubt::not_predicted});
  CHECK(doubts(false, -1.1) == std::vector<Doubt>{Doubt::not_predicted});
  CHECK(doubts(false, 0.3).empty());  // the others show little of it, and that agrees
  CHECK(doubts(true, 0, 1000) == std::vector<Doubt>{Doubt::not_predicted});  // they should show it
}

TEST_CASE("An effect that does not fit in some kind of channels resembles the cause, and has no name") {
  const auto doubts = [](const FitByKind& fit) {
    return judged_with({{1, 0.9, 1.1}, 0, 1, 0, fit}).effects.front().doubts;
  };
  // a value of 0.6 or 1.4 in one kind is 0.4 from that of all; sin(10 degrees) of its shift may be left
  CHECK(doubts({0, 0, 0.4, 0}) == std::vector<Doubt>{Doubt::kinds_differ});
  CHECK(doubts({0, 0, 0.2, 0}).empty());
  CHECK(doubts({0.18, 0, 0, 0}) == std::vector<Doubt>{Doubt::leaves_much});
  CHECK(doubts({0.17, 0, 0, 0}).empty());
}

TEST_CASE("A look-alike stays in the model without a name, and what explains nothing does not") {
  StageDecision decision;
  for (const std::vector<Doubt>& doubts : {std::vector<Doubt>{},
                                           {Doubt::leaves_much},
                                           {Doubt::kinds_differ, Doubt::leaves_much},
                                           {Doubt::not_held_out},
                                           {Doubt::leaves_much, Doubt::end_of_range}}) {
    decision.effects.emplace_back();
    decision.effects.back().doubts = doubts;
  }
  CHECK(places_with_name(decision) == std::vector<std::size_t>{0});
  CHECK(places_to_keep(decision) == std::vector<std::size_t>{0, 1, 2});

  // nor does one that another stage names leave: its share here would be taken for a misfit of the others
  decision.effects[4].is_named_elsewhere = true;
  CHECK(places_to_keep(decision) == std::vector<std::size_t>{0, 1, 2, 4});
  CHECK(places_to_try(decision) == std::vector<std::size_t>{0, 1, 2, 4});
  CHECK(places_with_name(decision) == std::vector<std::size_t>{0});
}

// What an effect explains of a stage, and what its model explains, depends on the model's other effects; its value at
// an end of its range, or a share too small where it acts most, is its own.
TEST_CASE("Only doubts that may be due to other effects leave an effect to be tried without these") {
  StageDecision decision;
  for (const std::vector<Doubt>& doubts : {std::vector<Doubt>{Doubt::negligible},
                                           {Doubt::end_of_range, Doubt::little_explained},
                                           {Doubt::little_explained, Doubt::leaves_much},
                                           {Doubt::not_held_out},
                                           {}}) {
    decision.effects.emplace_back();
    decision.effects.back().doubts = doubts;
  }
  CHECK(places_to_try(decision) == std::vector<std::size_t>{0, 2, 4});
}

TEST_CASE("A model that explains a gap on curves and not in simulation gives no name") {
  CHECK(judged_with({{1, 0.9, 1.1}, 0, 1}, 0.15).verdict == Verdict::named);
  CHECK(judged_with({{1, 0.9, 1.1}, 0, 1}, -0.6).verdict == Verdict::unknown);
  CHECK(judged_with({{1, 0.9, 1.1}, 0, 1}, GapMeasure::kNotMeasured).verdict == Verdict::unknown);
}

TEST_CASE("An effect that errors of the description's numbers could be has no name") {
  CHECK(judged_with({{1, 0.5, 1.5}, 0, 1}, 0.9, 0.9).verdict == Verdict::named);
  const StageDecision doubtful = judged_with({{1, 0.5, 1.5}, 0, 1}, 0.9, 1.1);
  CHECK(doubtful.verdict == Verdict::unknown);
  CHECK(doubtful.effects.front().doubts == std::vector<Doubt>{Doubt::uncertain});
}
