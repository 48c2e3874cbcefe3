// How sure the values of a fit are, and whether manoeuvres agree on them.
#include "gap/diagnose/effect_values.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <utility>

#include "tests/gap/diagnose/linear_world.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::diagnose;
using test::LinearWorld;
using test::Whole;
using test::world;

namespace {

bool holds(const Interval& interval, double truth) {
  return interval.from <= truth && truth <= interval.to;
}

// An effect that moves all channels of all manoeuvres, as a slow motion does: half a sine in 6 s.
Whole slow_motion(const LinearWorld& world, double length) {
  Whole whole(world.bins());
  for (Eigen::Index i = 0; i < whole.size(); ++i) {
    const Eigen::Index bin = i % world.bins_of_channel(), manoeuvre = i / world.bins_of_manoeuvre();
    whole[i] = std::sin(0.13 * static_cast<double>(bin) + static_cast<double>(manoeuvre));
  }
  return length / whole.norm() * whole;
}

// Evenly from nothing at the start of each run to `most` of it at the end.
Whole growing_to(double most, Whole whole, const LinearWorld& world) {
  for (Eigen::Index i = 0; i < whole.size(); ++i)
    whole[i] *=
        most * (static_cast<double>(i % world.bins_of_channel()) + 0.5) / static_cast<double>(world.bins_of_channel());
  return whole;
}

// How many of `draws` intervals of an effect of 0.4 hold it.
int covered(const LinearWorld& world, double sigma, double memory_s, int draws) {
  const std::vector<Whole> effects{slow_motion(world, 60)};
  int count = 0;
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(draws); ++seed) {
    const StageData data =
        world.data(0.4 * effects[0] + world.noise(5000 + seed) + world.wander(sigma, memory_s, 9000 + seed));
    count += holds(effect_values(data, world.fitted(effects, data, {0}), 9)[0].value, 0.4);
  }
  return count;
}

}  // namespace

// 380 of 400 with a sigma of 4.4.
TEST_CASE("Intervals of 95 % cover the true value in 93 to 97 % of draws where the model is exact") {
  const int count = covered(LinearWorld({2, 2, 6}), 0, 1, 400);
  INFO(count << " of 400");
  CHECK(count >= 372);
  CHECK(count <= 388);
}

TEST_CASE("Intervals cover the true value in at least 90 % of draws beside a discrepancy that the fit has to find") {
  const int count = covered(LinearWorld({4, 2, 10}), 1.5, 0.7, 400);
  INFO(count << " of 400");
  CHECK(count >= 360);
}

TEST_CASE("An interval is as wide as the noise lets it be, and stays in range") {
  // sigma 1 / 1000, and none of a discrepancy
  const std::vector<Whole> effects{1000 * world().direction(0), 1e-3 * world().direction(1)};
  const StageData data = world().data(0.5 * effects[0]);
  const Interval sharp = effect_values(data, world().fitted(effects, data, {0}), 9)[0].value;
  CHECK(sharp.value == Approx(0.5));
  CHECK(sharp.to - sharp.value == Approx(1.96e-3));
  CHECK(sharp.value - sharp.from == Approx(1.96e-3));
  const Interval open = effect_values(data, world().fitted(effects, data, {1}), 9)[0].value;
  CHECK(open.from == -1);
  CHECK(open.to == 1);
}

TEST_CASE("Two effects at 60 degrees make each other's interval wider by 1 / sin of it") {
  const std::vector<Whole> effects{100 * world().direction(0),
                                   100 * (0.5 * world().direction(0) + std::sqrt(0.75) * world().direction(1))};
  const StageData data = world().data(0.4 * effects[0] - 0.3 * effects[1]);
  for (const EffectValue& effect : effect_values(data, world().fitted(effects, data, {0, 1}), 9))
    CHECK(effect.value.to - effect.value.value == Approx(1.96 / (100 * std::sqrt(0.75))));
}

TEST_CASE("A number of the simulator, the same in all runs, opens a value as far as it moves it") {
  // it moves the runs as 0.1 of the effect; noise alone has a sigma of 0.001
  const Whole effect = 1000 * world().direction(0);
  StageData data = world().data(0.5 * effect);
  const GroupVectors shape = world().by_group(0.1 * effect);
  for (std::size_t g = 0; g < data.groups.size(); ++g) data.groups[g].shared_shapes = shape[g];
  const Interval open = effect_values(data, world().fitted({effect}, data, {0}), 9)[0].value;
  CHECK(open.to - open.value == Approx(1.96 * 0.1).epsilon(0.01));
}

TEST_CASE("What a value differs by from manoeuvre to manoeuvre is found, and nothing where they agree") {
  // eight manoeuvres, each of which knows the value to 1 / 20: as far as they differ by 0.2 that is nothing
  const LinearWorld world({8, 2, 3});
  const Whole effect = 20 * std::sqrt(8.0) * slow_motion(world, 1);
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  double squares = 0;
  int wide = 0, covered = 0, alarms = 0;
  constexpr int kDraws = 60;
  for (int draw = 0; draw < kDraws; ++draw) {
    const Whole noise = world.noise(100 + static_cast<std::uint64_t>(draw));
    Whole gap = noise;
    for (Eigen::Index m = 0; m < 8; ++m) {
      const Eigen::Index first = m * world.bins_of_manoeuvre();
      gap.segment(first, world.bins_of_manoeuvre()) +=
          (0.4 + 0.2 * normal(random)) * effect.segment(first, world.bins_of_manoeuvre());
    }
    const StageData differing = world.data(gap), agreeing = world.data(0.4 * effect + noise);
    const EffectValue differs = effect_values(differing, world.fitted({effect}, differing, {0}), 9)[0];
    const EffectValue agrees = effect_values(agreeing, world.fitted({effect}, agreeing, {0}), 9)[0];
    squares += differs.spread * differs.spread;
    wide += differs.spread > 0;
    covered += holds(differs.value, 0.4);
    alarms += agrees.spread > 0;
  }
  INFO("rms " << std::sqrt(squares / kDraws) << ", found in " << wide << ", covered " << covered << ", alarms "
              << alarms << " of " << kDraws);
  CHECK(std::sqrt(squares / kDraws) == Approx(0.2).epsilon(0.25));
  CHECK(alarms <= 7);  // by chance one in twenty: 3 with a sigma of 1.7
  CHECK(covered >= 50);
}

// The first manoeuvre knows the value of 0.5 to 1 / 200; the second one, which it moves by a hundredth of that, has a
// misfit of 4 sigma along it and would have it at the end of its range, 1.5 away.
TEST_CASE("A manoeuvre that hardly shows an effect says little of how far manoeuvres differ on its value") {
  const Eigen::Index first = world().bins_of_manoeuvre();
  Whole strong = slow_motion(world(), 1), weak = strong;
  strong.tail(first).setZero();
  weak.head(first).setZero();
  const Whole effect = 200 / strong.norm() * strong + 2 / weak.norm() * weak;
  const StageData data = world().data(0.5 * effect - 4 / weak.norm() * weak);
  const EffectValue value = effect_values(data, world().fitted({effect}, data, {0}), 9)[0];
  CHECK(value.value.value == Approx(0.5).margin(1e-3));
  // q = 1.5^2 x 2^2 = 9 of one degree of freedom, over half of 200^2; some of it is taken for a discrepancy
  CHECK(value.spread == Approx(std::sqrt(8 / 2e4)).epsilon(0.2));
  CHECK(value.value.to - value.value.value < 0.06);
}

TEST_CASE("What grows from nothing in the course of manoeuvres is seen as a trend, and nothing where the value stays") {
  // evenly from 0 to 0.8: in the first half 0.2 in the mean, in the second one 0.6
  const LinearWorld world({8, 2, 4});
  const Whole effect = world.in_channel(test::WorldChannel::x, 400);
  const Whole growing = growing_to(0.8, effect, world);
  int alarms = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const StageData grows = world.data(growing + world.noise(seed)),
                    stays = world.data(0.4 * effect + world.noise(seed));
    CHECK(effect_values(grows, world.fitted({effect}, grows, {0}), 9)[0].trend == Approx(0.4).epsilon(0.2));
    alarms += effect_values(stays, world.fitted({effect}, stays, {0}), 9)[0].trend > 0;
  }
  CHECK(alarms <= 1);  // by chance one in a thousand
}

TEST_CASE("A trend in channels that hardly bear on the value is none") {
  // x moves by 400 for each unit and wants 0.4 from beginning to end; yaw, by 40, from 0 to 0.8
  const LinearWorld world({8, 2, 4});
  const Whole x = world.in_channel(test::WorldChannel::x, 400);
  const auto measured = [&](double yaw_moves) {
    const Whole yaw = world.in_channel(test::WorldChannel::yaw, yaw_moves);
    const std::vector<Whole> effects{x + yaw};
    const StageData data = world.data(0.4 * x + growing_to(0.8, yaw, world) + world.noise(1));
    return effect_values(data, world.fitted(effects, data, {0}), 9)[0].trend;
  };
  CHECK(measured(40) == 0);
  CHECK(measured(400) == Approx(0.4).epsilon(0.2));
}

TEST_CASE("Where an effect has done all it can, no manoeuvre wants a value out of the range") {
  // up to 0.4 it shifts by 100 for each unit, from there on by 1: at 0.8 the two manoeuvres say 2.5 sigma more and
  // less, along the slope 3.5 either way
  const Whole direction = world().direction(0);
  const LinearWorld::Moved saturates = [&](const Settings& settings) {
    Whole whole = Whole::Zero(world().bins());
    for (const Setting& setting : settings)
      whole += (100 * std::min(setting.value, 0.4) + std::max(0.0, setting.value - 0.4)) * direction;
    return whole;
  };
  Whole differing = 2.5 * std::sqrt(2.0) * direction;
  differing.tail(world().bins_of_manoeuvre()) *= -1;
  const StageData data = world().data(saturates({{0, 0.8}}) + differing);
  EffectCurves curves = world().curves(saturates, 1, data);
  const std::vector<Setting> around{{0, 0.4}, {0, 0.6}, {0, 0.8}};
  add_points(curves, data, around, Fidelity::every_run, world().simulate(saturates));
  Model model = fit_model(data, curves, std::vector<std::size_t>{0}, {}, no_discrepancy());
  model.places = {at_value(curves.curves, 0, 0.8)};
  const EffectValue value = effect_values(data, {std::move(model), std::move(curves)}, 9)[0];
  CHECK(value.spread < 0.5);
}
