// A rest in one channel of the drives that the sum over all channels has room for.
#include <catch2/catch.hpp>
#include <cmath>

#include "gap/diagnose/left_in_drives.hpp"
#include "tests/gap/linear_world.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using test::LinearWorld;
using test::quick;
using test::Whole;
using test::world;
using test::WorldChannel;

namespace {

// At 1, of two effects: one changes a track's speed, the other one the voltage.
std::vector<Whole> of_track_and_battery() {
  return {LinearWorld::in_channel(WorldChannel::track, 80), LinearWorld::in_channel(WorldChannel::battery, 40)};
}

// With effect `named` fitted to the gap.
std::optional<LeftInDrive> left(const Whole& gap, std::size_t named, double inflation = 1) {
  const EffectCurves curves = world().curves(of_track_and_battery(), gap);
  return left_in_drives(curves, world().fitted(curves, {named}), world().coherence(), inflation);
}

}  // namespace

TEST_CASE("What is left in a channel of the drives is not excused by other channels with less than chance") {
  // Without noise. A square of 40 in the 6 cells of a channel has a chance of 5e-7, in all 24 cells of 2 %.
  const Whole gap = 0.5 * of_track_and_battery()[0] + LinearWorld::in_channel(WorldChannel::battery, std::sqrt(40.0));
  const Decision decision = world().decide({of_track_and_battery()[0]}, gap, quick());
  REQUIRE(decision.best.places.size() == 1);
  CHECK(decision.verdict == Verdict::unknown);
  CHECK(decision.p_left > DecisionSettings{}.surprise);
  CHECK(decision.doubts == std::vector<Doubt>{Doubt::left_in_drive});
  REQUIRE(decision.left_in_drive.has_value());
  CHECK(diagnosis_channels()[decision.left_in_drive->channel].column == std::string("battery_v"));
  CHECK(decision.left_in_drive->share == Approx(1));
  CHECK(decision.left_in_drive->p < 1e-5);
}

TEST_CASE("The chance of what is left in a drive counts all channels of the drives, and how repeats differ") {
  // chi-squared with 6 degrees of freedom reaches 16.81 by a chance of 1 %: in one of two channels 2 %
  const Whole gap = 0.5 * of_track_and_battery()[0] + LinearWorld::in_channel(WorldChannel::battery, std::sqrt(16.81));
  const auto plain = left(gap, 0), inflated = left(gap, 0, 2);
  REQUIRE(plain.has_value());
  CHECK(plain->p == Approx(2 * 0.01).epsilon(0.03));
  REQUIRE(inflated.has_value());
  CHECK(inflated->p == Approx(2 * 0.2099).epsilon(0.03));  // of half of it, 8.405
}

TEST_CASE("A tenth of a channel's gap is left by right effects too, however unlikely by chance") {
  // The effect takes 20 floors, and can do nothing about what has the other sign in the second manoeuvre.
  const auto with = [](double rest_squared) {
    return left(
        0.5 * of_track_and_battery()[1] + LinearWorld::in_channel(WorldChannel::battery, std::sqrt(rest_squared), -1),
        1);
  };
  CHECK_FALSE(with(40).has_value());  // of 400 + 40: 9 %
  const auto more = with(50);         // of 400 + 50: 11 %
  REQUIRE(more.has_value());
  CHECK(more->share == Approx(50.0 / 450));
}

TEST_CASE("What is left of the pose is not for single channels to say") {
  CHECK_FALSE(left(0.5 * of_track_and_battery()[0] + LinearWorld::in_channel(WorldChannel::x, 40), 0).has_value());
}
