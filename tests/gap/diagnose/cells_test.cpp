// Sums of cells: near their number in noise.
#include "gap/diagnose/cells.hpp"

#include <catch2/catch.hpp>

#include "gap/diagnose/model_search.hpp"
#include "gap/diagnose/repeats.hpp"
#include "tests/gap/diagnose/linear_world.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::diagnose;
using test::LinearWorld;
using test::Whole;
using test::world;

namespace {

CellEnergy energy_of(const Whole& gap, double stretch_s = 1) {
  const StageData data = world().data(gap);
  return cell_energy(data, residuals_of(data), stretch_s);
}

}  // namespace

TEST_CASE("A gap that lasts adds up in a cell, one that alternates does not") {
  // 0.5 in 4 bins of means of two, each of sigma 1 / sqrt(2): 4 x 0.5 x sqrt(2) over 2, squared 2; 24 cells
  const Whole constant = Whole::Constant(world().bins(), 0.5);
  CHECK(energy_of(constant).cells == 24);
  CHECK(energy_of(constant).sum == Approx(24 * 2));
  // half as long, half as much
  CHECK(energy_of(constant, 0.5).cells == 48);
  CHECK(energy_of(constant, 0.5).sum == Approx(48 * 1));
  Whole alternating = constant;
  for (Eigen::Index i = 0; i < alternating.size(); i += 2) alternating[i] *= -1;
  CHECK(energy_of(alternating).sum == Approx(0).margin(1e-9));
}

TEST_CASE("What the simulation leaves open is no energy, and a bin that was not measured no cell") {
  const Whole gap = world().in_channel(test::WorldChannel::x, 20);
  StageData data = world().data(gap);
  CHECK(cell_energy(data, residuals_of(data), 1).sum == Approx(400));
  for (StageGroup& group : data.groups) group.shared_shapes = 10 * group.residual;
  CHECK(cell_energy(data, residuals_of(data), 1).sum < 1);
  const StageData first = world().data(gap, UsedParts::of({0, 1}));
  CHECK(cell_energy(first, residuals_of(first), 1).cells == 12);
}

TEST_CASE("In noise the chance of its energy is any, each as often as it says") {
  int below_half = 0, below_tenth = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const double p = energy_of(world().noise(seed)).p_of_noise(1);
    below_half += p < 0.5;
    below_tenth += p < 0.1;
  }
  // of 200: 100 with a sigma of 7, 20 with one of 4.2
  CHECK(std::abs(below_half - 100) <= 21);
  CHECK(std::abs(below_tenth - 20) <= 13);
}

TEST_CASE("Variances that are larger than thought make as much energy more likely") {
  const CellEnergy energy{72, 24};
  CHECK(energy.p_of_noise(1) < 1e-5);
  CHECK(energy.p_of_noise(3) == Approx(0.46).margin(0.01));  // 24 of 24
}

TEST_CASE("Repeats that differ as the floor says inflate nothing, a second of wander does") {
  const LinearWorld world({2, 3, 25});
  const auto inflation = [&](const Whole& residuals) {
    const auto deviations = deviations_from_repeats(world.features, world.by_run(residuals), world.repeats);
    return inflation_from_repeats(world.features, world.floor(), deviations, 1);
  };
  // 600 cells, of which 400 are free: sigma of their mean square sqrt(2 / 400) = 7 %
  Whole noise = world.noise(6);
  CHECK(inflation(noise) < 1.22);
  // whole seconds, four bins, that are off together by 1: their sum over its root has a variance of 1 + 4
  std::mt19937_64 random(8);
  std::normal_distribution<double> normal;
  for (Eigen::Index i = 0; i < noise.size(); i += 4) noise.segment(i, 4).array() += normal(random);
  CHECK(inflation(noise) == Approx(5).epsilon(0.22));
  const Deviations none{std::vector<Eigen::VectorXd>(world.runs()), std::vector<std::vector<bool>>(world.runs())};
  CHECK(inflation_from_repeats(world.features, world.floor(), none, 1) == 1);
  // the same where three quarters of each run are in no repeat
  Deviations quarter = deviations_from_repeats(world.features, world.by_run(noise), world.repeats);
  for (std::size_t r = 0; r < quarter.of_runs.size(); ++r)
    for (std::size_t b = 0; b < quarter.shared[r].size(); ++b)
      if (world.features[r].bins[b].span >= 25) {
        quarter.shared[r][b] = false;
        quarter.of_runs[r][static_cast<Eigen::Index>(b)] = 0;
      }
  CHECK(inflation_from_repeats(world.features, world.floor(), quarter, 1) == Approx(5).epsilon(0.44));
}
