#include "gap/diagnose/looks.hpp"

#include <catch2/catch.hpp>

using namespace kenaf::gap::diagnose;
using kenaf::gap::candidates::Candidate;

TEST_CASE("One look serves models with the same effects and nearly the same values") {
  std::vector<Candidate> candidates(2);
  candidates[1].present = 1;  // as a scale of mass
  std::vector<Settings> looks;
  const auto at = [&](const Settings& settings) {
    nearest_look(looks, settings, candidates);
    return looks.size();
  };
  CHECK(at({}) == 1);
  CHECK(at({{0, 0.05}, {1, 1.2}}) == 2);
  // a tenth of 0.05 from nothing, and of 0.2 from 1
  CHECK(at({{0, 0.0545}, {1, 1.2}}) == 2);
  CHECK(at({{0, 0.05}, {1, 1.185}}) == 2);
  CHECK(at({{0, 0.056}, {1, 1.2}}) == 3);
  CHECK(at({{0, 0.05}, {1, 1.225}}) == 4);
  // other effects
  CHECK(at({{0, 0.05}}) == 5);
  CHECK(at({}) == 5);
  CHECK(nearest_look(looks, {{0, 0.0505}}, candidates).front().value == 0.05);
}
