#include "gap/diagnose/stage_candidates.hpp"

#include <catch2/catch.hpp>

#include "gap/candidates/own_effects.hpp"
#include "gap/diagnose/number_shapes.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::candidates;
using namespace kenaf::gap::diagnose;

namespace {

// The robot's numbers, then an effect that takes 1 V off the battery for each unit.
struct BatteryAndOwn {
  physics::RobotDescription robot = physics::load_robot("kenaf");
  std::vector<Candidate> all = description_candidates(robot);
  std::size_t own, voltage, mass;

  BatteryAndOwn() {
    all.push_back(parse_own_effects(R"(
[[effect]]
name = "old_cells"
summary = "the battery has less voltage"
stage = "drive"
parameter = "cells"
unit = "1"
neutral = 0
min = 0
max = 4
[[effect.moves]]
key = "battery.open_circuit_v"
add = -1
)",
                                    "own.toml", robot)
                      .front());
    own = all.size() - 1;
    voltage = place_of("battery.open_circuit_v");
    mass = place_of("body.mass_kg");
  }
  std::size_t place_of(const std::string& name) const {
    for (std::size_t c = 0; c < all.size(); ++c)
      if (all[c].name == name) return c;
    FAIL("no candidate " << name);
    return 0;
  }
};

}  // namespace

TEST_CASE("What moves a number moves it from where another candidate set it, whichever is listed first") {
  const BatteryAndOwn of;
  for (const Settings& settings : {Settings{{of.own, 3}, {of.voltage, 26}}, {{of.voltage, 26}, {of.own, 3}}})
    CHECK(with_settings(of.robot, of.all, settings).battery.open_circuit_v == Approx(26 - 3));
}

TEST_CASE("Errors of numbers are none of those that an effect in the model moves") {
  const BatteryAndOwn of;
  const std::vector<std::size_t> possible{of.voltage, of.mass};
  CHECK(numbers_but(of.all, possible, std::vector<std::size_t>{}) == possible);
  CHECK(numbers_but(of.all, possible, std::vector<std::size_t>{of.own}) == std::vector<std::size_t>{of.mass});
}
