// How far differences are from chance, cell by cell.
#include "gap/diagnose/coherence.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/gap/diagnose/linear_world.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::diagnose;
using test::Whole;
using test::world;

namespace {

Coherence in_stretches(double stretch_s) {
  return {world().features, world().repeats, stretch_s};
}

}  // namespace

TEST_CASE("Energy of cells: of noise near their count, of a constant gap growing with the bins of a cell") {
  const Coherence coherence = in_stretches(1);
  REQUIRE(coherence.cell_count() == 24);
  // a sum of 24 squares of standard normals has a sigma of sqrt(48) = 7; of the mean of 100 of them 0.7
  double sum = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) sum += coherence.energy(world().by_run(world().noise(seed)));
  CHECK(sum / 100 == Approx(24).margin(2.8));
  // 8 bins of 0.5 sum to 4; over sqrt(8), squared: 2 for each cell, 8 times a single bin's square
  const Whole constant = Whole::Constant(world().bins(), 0.5);
  CHECK(coherence.energy(world().by_run(constant)) == Approx(24 * 8 * 0.25));
  // in spans half as long it is half as much in each of twice as many cells
  const Coherence finer = in_stretches(0.5);
  CHECK(finer.cell_count() == 48);
  CHECK(finer.energy(world().by_run(constant)) == Approx(48 * 4 * 0.25));
  // what repeats do not share, or what alternates within a cell, is no coherent gap
  Whole opposed = constant;
  opposed.segment(world().bins_of_run(), world().bins_of_run()) *= -1;
  opposed.tail(world().bins_of_run()) *= -1;
  CHECK(coherence.energy(world().by_run(opposed)) == Approx(0).margin(1e-9));
}

TEST_CASE("A cell says which group, channel and second it is") {
  Whole gap = Whole::Zero(world().bins());
  gap.segment(2 * world().bins_of_run() + 12 + 4, 4)
      .setConstant(3);  // run 2: the second group; the voltage; the second second
  for (const Cell& cell : in_stretches(1).cells(world().by_run(gap))) {
    const bool here = cell.group == 1 && diagnosis_channels()[cell.channel].column == "battery_v" && cell.stretch == 1;
    CHECK(cell.z == Approx(here ? 12 / std::sqrt(8.0) : 0).margin(1e-12));
  }
}
