// Effects of which one takes back, in a channel, what another one does.
#include <catch2/catch.hpp>

#include "gap/diagnose/undone.hpp"
#include "tests/gap/linear_world.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using test::LinearWorld;
using test::quick;
using test::Whole;
using test::world;
using test::WorldChannel;

namespace {

// At 1, the first one moves the robot on and turns it, the second one turns it back, the third one drains its battery.
std::vector<Whole> opposing_effects() {
  return {LinearWorld::in_channel(WorldChannel::x, 80) + LinearWorld::in_channel(WorldChannel::yaw, 200),
          LinearWorld::in_channel(WorldChannel::yaw, -200), LinearWorld::in_channel(WorldChannel::battery, 80)};
}

}  // namespace

TEST_CASE("Effects of which one takes back what the other one does are no name for a gap that shows neither") {
  // what moves the robot on by 40 floors, and is in no catalogue, is the first one at 0.5 and the second one at 0.5
  const Decision decision =
      world().decide(opposing_effects(), LinearWorld::in_channel(WorldChannel::x, 40) + LinearWorld::noise(1), quick());
  REQUIRE(decision.best.places.size() == 2);
  CHECK(decision.verdict == Verdict::unknown);
  CHECK(decision.doubts == std::vector<Doubt>{Doubt::undone});
  REQUIRE(decision.undone.has_value());
  CHECK(diagnosis_channels()[decision.undone->channel].column == std::string("yaw_rad"));
  CHECK(decision.undone->alone == Approx(100).margin(10));  // 0.5 of 200; 40 of 80 is known to 1 / 40 of it
  CHECK(decision.undone->together < 4);                     // nothing but noise of 1 floor
}

TEST_CASE("Effects that work against each other are named where what is left of both is seen") {
  // 0.5 x 200 - 0.3 x 200 = 40 floors are left
  const std::vector<Whole> all = opposing_effects();
  const Decision decision = world().decide(all, 0.5 * all[0] + 0.3 * all[1] + LinearWorld::noise(1), quick());
  CHECK(decision.verdict == Verdict::named);
  REQUIRE(decision.best.places.size() == 2);
  CHECK_FALSE(decision.undone.has_value());
}

TEST_CASE("Undone is what many floors are taken back of, to a twentieth, by several effects") {
  const auto undone_at = [](double first, double second, double size) {
    std::vector<Whole> all = opposing_effects();
    for (Whole& effect : all) effect *= size;
    const EffectCurves curves = world().curves(all, first * all[0] + second * all[1]);
    return undone(curves, world().fitted(curves, {0, 1}), world().coherence());
  };
  CHECK(undone_at(0.5, 0.48, 1).has_value());        // 4 of 100 floors are left
  CHECK_FALSE(undone_at(0.5, 0.47, 1).has_value());  // 6 of 100
  CHECK(undone_at(0.5, 0.5, 0.21).has_value());      // nothing of 21
  CHECK_FALSE(undone_at(0.5, 0.5, 0.19).has_value());

  const EffectCurves curves = world().curves(opposing_effects(), 0.5 * opposing_effects()[0]);
  CHECK_FALSE(undone(curves, world().fitted(curves, {0}), world().coherence()).has_value());
}
