// Which candidates get whole curves after a first look.
#include "gap/diagnose/candidates_that_matter.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "gap/diagnose/model_search.hpp"
#include "tests/gap/diagnose/linear_world.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::candidates;
using namespace kenaf::gap::diagnose;
using test::LinearWorld;
using test::Whole;
using test::WorldChannel;

namespace {

// After a first look, a quarter of the way to the upper ends.
std::vector<std::size_t> that_matter(const LinearWorld& world, const std::vector<Whole>& per_value, const Whole& gap) {
  const StageData data = world.data(gap);
  const std::span<const Candidate> candidates = world.candidates(per_value.size());
  EffectCurves curves = empty_curves(data, candidates);
  std::vector<std::size_t> all;
  for (std::size_t c = 0; c < per_value.size(); ++c) {
    all.push_back(c);
    const std::vector<Setting> point{{c, 0.25}};
    insert_points(curves, data, point, {world.by_group(0.25 * per_value[c])}, Fidelity::coarse);
  }
  return candidates_that_matter(data, curves, all, nominal_model(data).likelihood.discrepancies);
}

}  // namespace

TEST_CASE("What explains some of the gap matters, what acts where there is none does not") {
  const LinearWorld world({6, 1, 3});
  const std::vector<Whole> effects{world.in_channel(WorldChannel::track, 60), world.in_channel(WorldChannel::yaw, 60)};
  CHECK(that_matter(world, effects, effects[0] + world.noise(3)) == std::vector<std::size_t>{0});
  CHECK(that_matter(world, effects, effects[1] + world.noise(3)) == std::vector<std::size_t>{1});
}

TEST_CASE("What explains no more than chance does not matter, however much of a small gap that is") {
  // noise without what it has along the effect, and so many sigma of the effect: they gain 3.2 and 6.2 of some 280,
  // more than 1 %
  const LinearWorld world({6, 1, 3});
  const Whole direction = world.direction(0), noise = world.noise(3);
  const Whole without = noise - noise.dot(direction) * direction;
  const std::vector<Whole> effects{60 * direction};
  CHECK(that_matter(world, effects, without + 1.8 * direction).empty());
  CHECK(that_matter(world, effects, without + 2.5 * direction) == std::vector<std::size_t>{0});
}

TEST_CASE("A voltage that is off alike in all runs matters, however much the tracks' speeds differ") {
  // beneath a discrepancy of the voltage that lasts as long as a run, a constant is one number a run, of unit size; the
  // speeds' discrepancy has many
  const LinearWorld world({24, 1, 6});
  const std::vector<Whole> effects{world.in_channel(WorldChannel::battery, 1000)};
  Whole gap = -effects[0] + world.noise(4);
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  for (Eigen::Index i = 0; i < world.bins(); ++i)
    if (i % world.bins_of_run() / world.bins_of_channel() == static_cast<Eigen::Index>(WorldChannel::track))
      gap[i] += 30 * normal(random);
  CHECK(that_matter(world, effects, gap) == std::vector<std::size_t>{0});
}
