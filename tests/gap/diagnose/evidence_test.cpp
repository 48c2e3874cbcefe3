// How sure a fit is, and what it is worth on runs that it has not seen.
#include "gap/diagnose/evidence.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <numeric>
#include <set>

#include "tests/gap/diagnose/linear_world.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::diagnose;
using test::LinearWorld;
using test::Whole;
using test::world;

namespace {

void check_whole(const Folds& folds, std::size_t runs) {
  std::multiset<std::size_t> held;
  for (const Fold& fold : folds)
    for (const RunPart& part : fold) held.insert(part.run);
  std::multiset<std::size_t> each;
  for (std::size_t r = 0; r < runs; ++r) each.insert(r);
  CHECK(held == each);
}

// What measures a gap of a world, `by` a whole.
struct Measured {
  const LinearWorld& world;
  NoiseFloor floor = world.floor();
  std::vector<Eigen::VectorXd> residuals;
  StageView view{&world.features, &world.repeats, &residuals, &floor};

  Measured(const LinearWorld& of, const Whole& gap) : world(of), residuals(of.by_run(gap)) {}
};

}  // namespace

TEST_CASE("Folds hold every run out once, repeats of one manoeuvre apart") {
  const Folds even = folds_by_repeat({{0, 1, 2}, {3, 4, 5}});
  check_whole(even, 6);
  REQUIRE(even.size() == 3);
  for (const auto& fold : even) {
    REQUIRE(fold.size() == 2);
    CHECK(fold[0].run / 3 != fold[1].run / 3);
  }
  check_whole(folds_by_repeat({{0, 1}, {2}, {3, 4, 5}}), 6);
  check_whole(folds_by_repeat({{0, 4, 2, 9, 5, 1, 3, 7, 8, 6}}), 10);
  // without repeats they are dealt out, to as many folds as runs or five
  CHECK(folds_by_repeat({{0}, {1}, {2}}).size() == 3);
  const Folds dealt = folds_by_repeat({{0}, {1}, {2}, {3}, {4}, {5}, {6}});
  check_whole(dealt, 7);
  CHECK(dealt.size() == 5);
}

TEST_CASE("By manoeuvre all repeats are held out together") {
  Observations observations;
  for (const char* name : {"a", "b", "a", "c", "b"}) {
    observations.runs.push_back({});
    observations.runs.back().manoeuvre = name;
  }
  CHECK(folds_by_manoeuvre(observations, {{0, 2}, {1}, {3}, {4}}) == Folds{{0, 2}, {1, 4}, {3}});
  // names that tell nothing apart: by commands
  for (Observation& run : observations.runs) run.manoeuvre = "drive";
  CHECK(folds_by_manoeuvre(observations, {{0, 2}, {1, 4}, {3}}) == Folds{{0, 2}, {1, 4}, {3}});
  observations.runs[3].manoeuvre = "square";
  for (const std::size_t run : {0, 1, 2, 4}) observations.runs[run].manoeuvre = "";
  CHECK(folds_by_manoeuvre(observations, {{0, 2}, {1, 4}, {3}}) == Folds{{0, 2}, {1, 4}, {3}});
}

namespace {
// Deviations of repeats in all bins.
Deviations everywhere(std::vector<Eigen::VectorXd> of_runs) {
  Deviations deviations{std::move(of_runs), {}};
  for (const Eigen::VectorXd& run : deviations.of_runs)
    deviations.shared.emplace_back(static_cast<std::size_t>(run.size()), true);
  return deviations;
}
Deviations no_repeats(const LinearWorld& of) {
  return everywhere(std::vector<Eigen::VectorXd>(of.runs()));
}
}  // namespace

TEST_CASE("How much of a gap is gone, by hand") {
  // in all bins 5, then 3; the noise is 1
  const Whole five = Whole::Constant(world().bins(), 5);
  const Measured measured(world(), five);
  const GapMeasure gap = measure_gap(measured.view, world().by_run(0.6 * five), no_repeats(world()), 1);
  CHECK(gap.before == Approx(5));
  CHECK(gap.after == Approx(3));
  CHECK(gap.floor == 1);
  CHECK(gap.shrink.value == Approx(0.5));  // (5 - 3) / (5 - 1)
  CHECK(gap.explains.value == Approx((25. - 9) / (25 - 1)));
  // all manoeuvres are alike, so it is the same whichever are drawn
  CHECK(gap.explains.from == Approx(gap.explains.value));
  CHECK(gap.explains.to == Approx(gap.explains.value));
  // repeats that differ by 2 leave 5^2 - 2^2 = 21 to explain
  const GapMeasure with_repeats =
      measure_gap(measured.view, world().by_run(0.6 * five), everywhere(world().by_run(0.4 * five)), 1);
  CHECK(with_repeats.floor == Approx(2));
  CHECK(with_repeats.explains.value == Approx(16.0 / 21));
}

TEST_CASE("No share of a gap is above 1, however little is left") {
  const Whole five = Whole::Constant(world().bins(), 5);
  const Measured measured(world(), five);
  const GapMeasure gap = measure_gap(measured.view, world().by_run(0 * five), no_repeats(world()), 1);
  for (const Interval& share : {gap.shrink, gap.explains}) {
    CHECK(share.value == 1);
    CHECK(share.to == 1);
  }
  const std::vector<Whole> effects{40 * world().direction(0)};
  const Measured noiseless(world(), 0.5 * effects[0]);
  const StandingModel standing = world().fitted(effects, world().data(0.5 * effects[0]), {0});
  const HeldOutShares shares =
      shares_held_out(noiseless.view, Passage::drive_to_body, standing, {}, folds_by_repeat(world().repeats), 1);
  CHECK(shares.model == 1);
  CHECK(shares.effects.at(0).of_stage == 1);
  CHECK(shares.effects.at(0).of_kind == 1);
  CHECK(shares.effects.at(0).model_of_kind == 1);
}

TEST_CASE("The interval of a share has what manoeuvres differ by") {
  // half of the manoeuvres are explained altogether, the others not at all: shares of 0 to 1 can be drawn
  const LinearWorld four({4, 1, 3});
  Whole left = Whole::Constant(four.bins(), 5);
  const Measured measured(four, left);
  left.head(2 * four.bins_of_manoeuvre()).setConstant(1);
  const GapMeasure gap = measure_gap(measured.view, four.by_run(left), no_repeats(four), 1);
  CHECK(gap.explains.value == Approx(0.5));
  CHECK(gap.explains.from == Approx(0));
  CHECK(gap.explains.to == Approx(1));
}

TEST_CASE("A share of a single manoeuvre has no interval, as nothing shows how manoeuvres differ") {
  const LinearWorld one({1, 3, 3});
  const Measured measured(one, Whole::Constant(one.bins(), 5));
  const GapMeasure gap = measure_gap(measured.view, one.by_run(Whole::Constant(one.bins(), 3)), no_repeats(one), 1);
  CHECK(gap.explains.value == Approx(16.0 / 24));
  CHECK(std::isnan(gap.explains.from));
  CHECK(std::isnan(gap.explains.to));
}

TEST_CASE("Without repeats, the floor of a difference from one earlier run has the noise of both") {
  LinearWorld against({4, 1, 3});
  for (StageFeatures& run : against.features) run.baseline_runs = Eigen::VectorXd::Ones(std::ssize(run.bins));
  const Measured measured(against, Whole::Constant(against.bins(), 5));
  const GapMeasure gap =
      measure_gap(measured.view, against.by_run(Whole::Constant(against.bins(), 3)), no_repeats(against), 1);
  CHECK(gap.floor == Approx(std::sqrt(2.0)));
  CHECK(gap.explains.value == Approx(16.0 / 23));  // (25 - 9) / (25 - 2)
}

TEST_CASE("The true effect takes a gap away on runs it was not fitted to, another one nothing") {
  const std::vector<Whole> effects{60 * world().direction(0), 60 * world().direction(1)};
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const Whole gap = 0.8 * effects[0] + world().noise(seed);
    const Measured measured(world(), gap);
    const Folds folds = folds_by_repeat(world().repeats);
    const auto share = [&](std::size_t effect) {
      const StandingModel standing = world().fitted(effects, world().data(gap), {effect});
      const HeldOutShares shares = shares_held_out(measured.view, Passage::drive_to_body, standing, {}, folds, 1);
      CHECK(shares.effects.at(0).of_stage == Approx(shares.model));  // alone it is the whole model
      return shares.model;
    };
    // of 48^2 = 2304 and noise; a value fitted to half of the runs costs 2 or so
    CHECK(share(0) == Approx(1).margin(0.05));
    CHECK(share(1) == Approx(0).margin(0.02));
  }
}

TEST_CASE("Each of two effects has the share that the model without it leaves, in the stage and in its own channels") {
  // in one channel, at right angles: of 30^2 + 40^2 = 2500 in 48 bins noise has 48
  const Whole plain = world().in_channel(test::WorldChannel::x, 1);
  Whole turned = plain;
  turned.tail(world().bins_of_manoeuvre()) *= -1;
  const std::vector<Whole> effects{60 * plain, 80 * turned, 100 * world().in_channel(test::WorldChannel::battery, 1)};
  const auto shares_of = [&](const Whole& gap, const std::vector<std::size_t>& of) {
    const Measured measured(world(), gap);
    const StandingModel standing = world().fitted(effects, world().data(gap), of);
    const Folds folds = folds_by_repeat(world().repeats);
    HeldOutShares shares = shares_held_out(measured.view, Passage::drive_to_body, standing, {}, folds, 1);
    std::vector<std::size_t> places(of.size());
    std::iota(places.begin(), places.end(), std::size_t{0});
    shares.sets = shares_of_sets_held_out(measured.view, Passage::drive_to_body, standing, sets_small_first(places), {},
                                          folds, 1);
    return shares;
  };
  const HeldOutShares shares = shares_of(0.5 * effects[0] + 0.5 * effects[1], {0, 1});
  REQUIRE(shares.effects.size() == 2);
  // each fold tests one repeat of either manoeuvre, so that all of the gap is tested once
  for (const std::size_t e : {0u, 1u}) {
    const double left_without_it = e == 0 ? 900 : 1600;
    CHECK(shares.effects[e].of_stage == Approx(1 - (2500 - left_without_it) / (2500 - 48)));
    CHECK(shares.effects[e].of_kind == Approx(shares.effects[e].of_stage));
    CHECK(kind_name(shares.effects[e].kind) == "position");
  }
  CHECK(shares.model == 1);
  REQUIRE(shares.sets.size() == 1);
  CHECK(shares.sets[0].places == std::vector<std::size_t>{0, 1});
  CHECK(shares.sets[0].share.of_stage == 1);  // without both nothing is explained
  // half of the runs show half of the squared shifts: of each, and of both together
  CHECK(shares.effects[0].shown_by_others == Approx(900.0 / 2));
  CHECK(shares.effects[1].shown_by_others == Approx(1600.0 / 2));
  CHECK(shares.sets[0].share.shown_by_others == Approx(2500.0 / 2));

  // half of what x lacks is explained, and all of the voltage: each in its own channels, whatever the other one's size
  const HeldOutShares two = shares_of(0.5 * effects[0] + 0.4 * effects[1] + 0.9 * effects[2], {0, 2});
  REQUIRE(two.effects.size() == 2);
  CHECK(kind_name(two.effects[0].kind) == "position");
  CHECK(two.effects[0].of_kind == Approx(900.0 / (900 + 1024 - 48)));
  CHECK(two.effects[0].model_of_kind == Approx(two.effects[0].of_kind));
  CHECK(kind_name(two.effects[1].kind) == "battery voltage");
  CHECK(two.effects[1].of_kind == 1);
}

TEST_CASE("What numbers that are a little off explain as well is no share of an effect's") {
  // 40 along two directions; numbers that are off by 2 % shift as much along the first one
  const std::vector<Whole> effects{60 * world().direction(0), 60 * world().direction(1)};
  const Whole gap = 40 * world().direction(0) + 40 * world().direction(1) + world().noise(3);
  Measured measured(world(), gap);
  for (const Eigen::VectorXd& group : world().by_group(40 / 0.02 * world().direction(0)))
    measured.floor.number_shapes.emplace_back(group);
  StandingModel standing = world().fitted(effects, world().data(gap), {0, 1});
  const auto shares_with = [&](double numbers_off) {
    standing.model.likelihood.discrepancies.numbers_off = numbers_off;
    return shares_held_out(measured.view, Passage::drive_to_body, standing, {}, folds_by_repeat(world().repeats), 1);
  };
  // where numbers are off by 1e-4, each usually reaches 1e-4 of 2000, which is 0.2 of the 40
  for (const HeldOutShares::OfEffect& share : shares_with(1e-4).effects)
    CHECK(share.beyond_numbers == Approx(0.5).margin(0.1));
  // off by 1 %, 20 of the 40: 20^2 of 2 * 40^2 are left for the effect
  CHECK(shares_with(0.01).effects[0].beyond_numbers == Approx(0.125).margin(0.03));
  const HeldOutShares shares = shares_with(0.02);
  for (const HeldOutShares::OfEffect& share : shares.effects) CHECK(share.of_stage == Approx(0.5).margin(0.1));
  CHECK(shares.effects[0].beyond_numbers == Approx(0).margin(0.05));
  CHECK(shares.effects[0].of_kind == Approx(0).margin(0.1));
  CHECK(shares.effects[1].beyond_numbers == Approx(0.5).margin(0.1));
  CHECK(shares.effects[1].of_kind > 0.2);
}

TEST_CASE("Numbers that mispredict a held-out manoeuvre take nothing away from an effect") {
  // the voltage lacks 30 in both manoeuvres; a number that explains it in one has the other sign in the other
  const std::vector<Whole> effects{60 * world().in_channel(test::WorldChannel::x, 1)};
  const Whole plain = world().in_channel(test::WorldChannel::battery, 1);
  Whole turned = plain;
  turned.tail(world().bins_of_manoeuvre()) *= -1;
  const Whole gap = 0.5 * effects[0] + 30 * plain;
  Measured measured(world(), gap);
  for (const Eigen::VectorXd& group : world().by_group(30 / 0.02 * turned))
    measured.floor.number_shapes.emplace_back(group);
  StandingModel standing = world().fitted(effects, world().data(gap), {0});
  standing.model.likelihood.discrepancies.numbers_off = 0.02;
  const Folds by_manoeuvre{{0, 1}, {2, 3}};
  const HeldOutShares::OfEffect share =
      shares_held_out(measured.view, Passage::drive_to_body, standing, {}, by_manoeuvre, 1).effects.at(0);
  // position and voltage have the same gap, and with the number the voltage's would be four times as large
  CHECK(share.of_stage == Approx(0.5).margin(0.05));
  CHECK(share.beyond_numbers == Approx(share.of_stage));
  CHECK(share.of_kind == Approx(1).margin(0.05));
}

TEST_CASE("What is open in each run by itself is not a gap for an effect to explain") {
  // 30 in x, all of it the effect's; each run's yaw begins 5 sigma off, where it is open by 10
  const std::vector<Whole> effects{60 * world().in_channel(test::WorldChannel::x, 1)};
  const Whole yaw = world().in_channel(test::WorldChannel::yaw, 1);
  const Whole in_each_bin = yaw / yaw.maxCoeff();
  Whole starts = 5 * in_each_bin;
  for (const Eigen::Index run : {1, 2}) starts.segment(run * world().bins_of_run(), world().bins_of_run()) *= -1;
  const Whole gap = 0.5 * effects[0] + starts;
  Measured measured(world(), gap);
  for (std::size_t r = 0; r < world().runs(); ++r) measured.floor.open[r].local = world().by_run(10 * in_each_bin)[r];
  const HeldOutShares shares =
      shares_held_out(measured.view, Passage::drive_to_body, world().fitted(effects, world().data(gap), {0}), {},
                      folds_by_repeat(world().repeats), 1);
  // of 900 in x and, as if nothing were open, 25 in each of the 48 bins of yaw: 0.45
  CHECK(shares.effects[0].of_stage == Approx(1));
}

TEST_CASE("An effect acts most where there is a gap, not where chance makes the noise smaller") {
  // of 900 + 1024 in x it explains 900; of 50 in the 48 bins of the voltage all: two more than noise has
  const Whole plain = world().in_channel(test::WorldChannel::x, 1);
  Whole turned = plain;
  turned.tail(world().bins_of_manoeuvre()) *= -1;
  const std::vector<Whole> effects{60 * plain + world().in_channel(test::WorldChannel::battery, 2 * std::sqrt(50.0))};
  const Whole gap = 0.5 * effects[0] + 32 * turned;
  const Measured measured(world(), gap);
  const HeldOutShares shares =
      shares_held_out(measured.view, Passage::drive_to_body, world().fitted(effects, world().data(gap), {0}), {},
                      folds_by_repeat(world().repeats), 1);
  CHECK(kind_name(shares.effects[0].kind) == "position");
  CHECK(shares.effects[0].of_kind == Approx(900.0 / (1924 - 48)).epsilon(0.01));
}

TEST_CASE("With an additional effect that explains nothing the whole model keeps its share") {
  const std::vector<Whole> effects{60 * world().in_channel(test::WorldChannel::x, 1),
                                   100 * world().in_channel(test::WorldChannel::battery, 1)};
  const Whole gap = 0.5 * effects[0];
  const Measured measured(world(), gap);
  const StandingModel standing = world().fitted(effects, world().data(gap), {0, 1});
  const HeldOutShares shares =
      shares_held_out(measured.view, Passage::drive_to_body, standing, {}, folds_by_repeat(world().repeats), 1);
  CHECK(shares.effects[1].of_kind == 0);
  CHECK(shares.effects[1].model_of_kind == 1);
}

TEST_CASE("An effect explains no more than the whole model does, however much the others leave without it") {
  // a moves x by 60; b moves x back by 60, and the voltage by 100; what is there is 10 in x, 50 in the voltage, and 40
  // in x that neither explains. Both explain the voltage, and of 1700 in x 100. Without a, b explains the voltage and
  // moves x by 30 from 10 to 40: 3200 are left of 1700
  const Whole plain = world().in_channel(test::WorldChannel::x, 1);
  Whole turned = plain;
  turned.tail(world().bins_of_manoeuvre()) *= -1;
  const Whole battery = world().in_channel(test::WorldChannel::battery, 1);
  const std::vector<Whole> effects{60 * plain, 100 * battery - 60 * plain};
  const Whole gap = 10 * plain + 50 * battery + 40 * turned;
  const Measured measured(world(), gap);
  const StandingModel standing = world().fitted(effects, world().data(gap), {0, 1});
  const HeldOutShares shares =
      shares_held_out(measured.view, Passage::drive_to_body, standing, {}, folds_by_repeat(world().repeats), 1);
  CHECK(kind_name(shares.effects[0].kind) == "position");
  CHECK(shares.effects[0].model_of_kind == Approx(100.0 / (1700 - 48)));
  CHECK(shares.effects[0].of_kind == shares.effects[0].model_of_kind);
  CHECK(shares.effects[0].of_stage <= shares.model);
}

// a moves x of the first manoeuvre by 600; b the voltage by 100, and that x by 30. Half of both is there. Without a, b
// at its value explains all of the voltage and 1 - (300 / 315)^2 of x. Fitted again it goes to the end of its range: 1
// - (285 / 315)^2 of x, and nothing of the voltage, of which it makes as much too much.
TEST_CASE("What others lose where they are fitted to what they cannot do is no share of an effect's") {
  const Whole battery = world().in_channel(test::WorldChannel::battery, 1);
  Whole x = world().in_channel(test::WorldChannel::x, 1);
  x.tail(world().bins_of_manoeuvre()).setZero();
  x.normalize();
  const std::vector<Whole> effects{600 * x, 100 * battery + 30 * x};
  const Whole gap = 0.5 * effects[0] + 0.5 * effects[1];
  const Measured measured(world(), gap);
  const StandingModel standing = world().fitted(effects, world().data(gap), {0, 1});
  const HeldOutShares shares =
      shares_held_out(measured.view, Passage::drive_to_body, standing, {}, folds_by_repeat(world().repeats), 1);
  const HeldOutShares::OfEffect &a = shares.effects[0], &b = shares.effects[1];
  CHECK(kind_name(a.kind) == "position");
  CHECK(a.of_kind == Approx(285.0 * 285 / (315.0 * 315)).margin(0.02));
  CHECK(kind_name(b.kind) == "battery voltage");
  CHECK(b.of_kind == Approx(1).margin(0.05));
  CHECK(shares.model == Approx(1).margin(0.01));
  CHECK(a.of_stage + b.of_stage <= 1);
}

TEST_CASE("Where the model without an effect was simulated, that is what the others do at their values") {
  // a moves x by 40, b the voltage by 100; half of both is there. Simulated alone, b moves x by 16 of 20 as well
  const Whole x = world().in_channel(test::WorldChannel::x, 1),
              battery = world().in_channel(test::WorldChannel::battery, 1);
  const std::vector<Whole> effects{40 * x, 100 * battery};
  const Whole gap = 0.5 * effects[0] + 0.5 * effects[1];
  const Measured measured(world(), gap);
  const StandingModel standing = world().fitted(effects, world().data(gap), {0, 1});
  std::vector<Model> without_each{standing.model, standing.model};
  without_each[0].shift = world().by_group(50 * battery + 16 * x);
  without_each[1].shift = world().by_group(20 * x);
  const HeldOutShares shares = shares_held_out(measured.view, Passage::drive_to_body, standing, without_each,
                                               folds_by_repeat(world().repeats), 1);
  // of 20^2 in x, less 48 of noise, 4^2 are left without a: nothing but noise
  CHECK(shares.effects[0].of_kind == Approx(0).margin(0.05));
  CHECK(shares.effects[1].of_kind == Approx(1).margin(0.05));
}

TEST_CASE("A value that is held out is fitted without the runs it is for") {
  // run 0 alone shows 0.8, all others 0.2: by repeats, run 0 is held out with run 2, and gets the value of 1 and 3
  const std::vector<Whole> effects{60 * world().direction(0)};
  Whole gap = 0.2 * effects[0];
  gap.head(world().bins_of_run()) *= 4;
  const Measured measured(world(), gap);
  const StandingModel standing = world().fitted(effects, world().data(gap), {0});
  const auto places =
      places_held_out(measured.view, Passage::drive_to_body, standing, folds_by_repeat(world().repeats), 1);
  const auto value = [&](std::size_t run) { return places[run].at(0).places[0].value; };
  CHECK(value(0) == Approx(0.2));
  CHECK(value(2) == Approx(0.2));
  CHECK(value(1) > 0.25);
  // a single fold holds nothing out
  for (const auto& run : places_held_out(measured.view, Passage::drive_to_body, standing, {{0, 1, 2, 3}}, 1))
    CHECK(run.at(0).places[0].value == standing.model.places[0].value);
}

TEST_CASE("What a simulation of two effects has beyond their sum stays where they are fitted again") {
  const std::vector<Whole> effects{40 * world().direction(0), 40 * world().direction(1)};
  const Whole beyond = 6 * world().direction(0);  // looks like more of the first effect, but belongs to both together
  const Whole gap = 0.5 * effects[0] + 0.5 * effects[1] + beyond;
  const Measured measured(world(), gap);
  StandingModel standing = world().fitted(effects, world().data(gap), {0, 1});
  standing.model.places = {at_value(standing.curves.curves, 0, 0.5), at_value(standing.curves.curves, 1, 0.5)};
  standing.model.shift = world().by_group(gap);
  for (const auto& of_run :
       places_held_out(measured.view, Passage::drive_to_body, standing, folds_by_repeat(world().repeats), 1))
    for (const OnCurve& place : of_run.at(0).places) CHECK(place.value == Approx(0.5));
}

TEST_CASE("Of a run that alone shows an effect each half is held out in turn") {
  // three manoeuvres, none repeated; the first one alone shows the effect, from 2 to 4 s of 6: 0.4 of it
  const LinearWorld world({3, 1, 6});
  std::vector<Whole> effects{Whole::Zero(world.bins()), 60 * world.direction(1)};
  for (Eigen::Index i = 0; i < world.bins_of_channel(); ++i)
    if (i >= 8 && i < 16) effects[0][i] = 30;
  const Whole gap = 0.4 * effects[0];
  const Measured measured(world, gap);
  const StandingModel alone = world.fitted(effects, world.data(gap), {0});
  const std::vector<RunPart> halves = halves_of_runs_alone(measured.view, Passage::drive_to_body, alone, 16);
  REQUIRE(halves.size() == 1);
  CHECK(halves[0].run == 0);
  CHECK(halves[0].to_s == Approx(3).margin(0.3));  // half of what it shifts is over then

  const Folds folds = with_halves(folds_by_repeat(world.repeats), halves);
  const auto is_held_out = [&](std::size_t fold, double t_s) {
    return std::ranges::any_of(folds[fold], [&](const RunPart& part) { return part.run == 0 && part.holds(t_s); });
  };
  for (const double t_s : {0.1, 2.0, 2.5}) CHECK((is_held_out(0, t_s) && !is_held_out(1, t_s)));
  for (const double t_s : {3.4, 5.9}) CHECK((is_held_out(1, t_s) && !is_held_out(0, t_s)));
  // by whole runs nothing can predict it; by halves each one predicts the other
  const auto explained_share = [&](const Folds& of) {
    return shares_held_out(measured.view, Passage::drive_to_body, alone, {}, of, 1).effects[0].of_kind;
  };
  CHECK(explained_share(folds_by_repeat(world.repeats)) < 0.05);
  CHECK(explained_share(folds) > 0.9);
  const auto places = places_held_out(measured.view, Passage::drive_to_body, alone, folds, 1);
  REQUIRE(places[0].size() == 2);
  for (const PlacesOfPart& part : places[0]) CHECK(part.places[0].value == Approx(0.4).margin(0.02));
  CHECK(places[1].size() == 1);

  // one that all manoeuvres show is held out run by run
  const StandingModel shared = world.fitted(effects, world.data(0.5 * effects[1]), {1});
  CHECK(halves_of_runs_alone(measured.view, Passage::drive_to_body, shared, 16).empty());
  // repeats are held out for each other, and a run without others is not halved
  CHECK(with_halves({{0}}, halves) == Folds{{0}});
}
