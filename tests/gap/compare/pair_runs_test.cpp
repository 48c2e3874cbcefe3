// Which run is compared with which.
#include "gap/compare/pair_runs.hpp"

#include <catch2/catch.hpp>

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::compare;

namespace {

runs::Dataset dataset(std::vector<std::string> manoeuvres) {
  runs::Dataset dataset;
  for (std::string& manoeuvre : manoeuvres) dataset.runs.push_back({"", std::move(manoeuvre), ""});
  return dataset;
}

}  // namespace

TEST_CASE("The k-th repeat belongs to the k-th, whatever stands between them") {
  const RunPairs result = pair_runs(dataset({"step", "square", "step"}), dataset({"square", "step", "step"}));
  REQUIRE(result.pairs.size() == 3);
  CHECK(result.left_out.empty());
  const std::size_t expected[][3] = {{0, 1, 0}, {1, 0, 0}, {2, 2, 1}};
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(result.pairs[i].real == expected[i][0]);
    CHECK(result.pairs[i].sim == expected[i][1]);
    CHECK(result.pairs[i].repeat == expected[i][2]);
  }
}

TEST_CASE("The shorter list of repeats decides, the rest is named on its own side") {
  const RunPairs result = pair_runs(dataset({"step", "step", "trench"}), dataset({"step", "trench", "trench", "ramp"}));
  REQUIRE(result.pairs.size() == 2);
  REQUIRE(result.left_out.size() == 3);
  CHECK(result.left_out[0].side == LeftOutRun::Side::real);
  CHECK(result.left_out[0].index == 1);
  CHECK(result.left_out[0].why == "the simulated dataset has only 1 of this manoeuvre");
  CHECK(result.left_out[1].side == LeftOutRun::Side::sim);
  CHECK(result.left_out[1].index == 2);
  CHECK(result.left_out[2].index == 3);
  CHECK(result.left_out[2].why == "the real dataset has no run of this manoeuvre");
}

TEST_CASE("Runs without a manoeuvre belong together") {
  const RunPairs result = pair_runs(dataset({"", "step"}), dataset({"step", "", ""}));
  REQUIRE(result.pairs.size() == 2);
  CHECK(result.pairs[0].sim == 1);
  REQUIRE(result.left_out.size() == 1);
  CHECK(result.left_out[0].why == "the real dataset has only 1 without a manoeuvre");
}
