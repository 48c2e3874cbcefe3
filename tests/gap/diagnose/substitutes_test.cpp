// Effects that stand in for each other have nearly the same shift. Here one shifts the position by 3 and the yaw by 4,
// the others position or yaw alone (lengths in noise).
#include "gap/diagnose/substitutes.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "gap/diagnose/shares_of_effects.hpp"
#include "tests/gap/diagnose/linear_world.hpp"

using namespace kenaf::gap::diagnose;
using kenaf::test::LinearWorld;
using kenaf::test::position;
using kenaf::test::Whole;
using kenaf::test::world;
using kenaf::test::yaw;

namespace {

Eigen::MatrixXd products(const std::vector<Whole>& effects, const std::vector<std::size_t>& model) {
  Whole gap = Whole::Zero(world().bins());
  for (const std::size_t e : model) gap += effects[e];
  const StageData data = world().data(gap);
  return products_of_effects(data, world().fitted(effects, data, model));
}

double apart(const Eigen::MatrixXd& products, const std::vector<std::size_t>& places) {
  return least_apart(products, places);
}

}  // namespace

TEST_CASE("The sine between two shifts, the least of all pairs, whatever their sizes and signs") {
  const std::vector<Whole> effects{position(30) + yaw(40), position(70), -yaw(5)};
  const Eigen::MatrixXd all = products(effects, {0, 1, 2});
  CHECK(all(0, 0) == Approx(50 * 50));
  CHECK(all(0, 1) == Approx(30 * 70));

  // of 3, 4 and 5: with the position a cosine of 3 / 5, with the yaw of 4 / 5
  CHECK(apart(all, {0, 1}) == Approx(0.8));
  CHECK(apart(all, {0, 2}) == Approx(0.6));
  CHECK(apart(all, {1, 2}) == Approx(1));
  CHECK(apart(all, {0, 1, 2}) == Approx(0.6));

  CHECK(apart(all, {0}) == 1);
  CHECK(apart(Eigen::MatrixXd::Zero(2, 2), {0, 1}) == 1);
  CHECK(apart(Eigen::MatrixXd::Constant(2, 2, 7), {0, 1}) == 0);
}

TEST_CASE("Effects whose shifts have nothing in common are no set, whatever they explain together") {
  // each takes off less than half of a gap that only both take off
  const auto sets = [](const std::vector<Whole>& effects, const Whole& gap) {
    const std::vector<Eigen::VectorXd> residuals = world().by_run(gap);
    const NoiseFloor floor = world().floor();
    const StageView view{&world().features, &world().repeats, &residuals, &floor};
    const StandingModel standing = world().fitted(effects, world().data(gap), {0, 1});
    DecisionSettings settings;
    settings.effect_share = 0.9;  // none has enough alone
    const Folds folds = folds_by_repeat(world().repeats);
    return shares_of_effects(view, Passage::drive_to_body, standing, world().simulate(LinearWorld::linear(effects)),
                             folds, folds, settings)
        .of_repeats.sets;
  };
  CHECK(sets({position(60), yaw(80)}, position(30) + yaw(40)).empty());
  const std::vector<Whole> alike{position(60) + yaw(80), position(60) + yaw(30)};
  REQUIRE(sets(alike, 0.5 * alike[0] + 0.5 * alike[1]).size() == 1);
}
