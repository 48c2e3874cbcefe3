// The operator: phases go on by posture, place, turn and time.
#include "rollout/driver.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <numbers>

using namespace kenaf;
using namespace kenaf::rollout;
using physics::Pose;

namespace {

constexpr std::array<double, 4> kFolded{1, 1, 1, 1};

Pose at(double x, double z = 0, double pitch = 0, double yaw = 0) {
  return {{x, 0, z}, physics::rotation_from({0, pitch, yaw})};
}

Manoeuvre of(std::vector<Phase> phases) {
  Manoeuvre manoeuvre;
  manoeuvre.phases = std::move(phases);
  return manoeuvre;
}

Phase lasting(double at_most_s, double speed = 0.2, PhaseEnd end = {}) {
  return {.name = "", .track_mps = {speed, speed}, .flipper_rad = {}, .at_most_s = at_most_s, .end = end};
}

}  // namespace

TEST_CASE("A phase lasts its time, at multiples of a period that is no binary fraction too") {
  const Manoeuvre manoeuvre = of({lasting(0.3, 0.1), lasting(0.4, 0.2)});
  Driver driver(manoeuvre, kFolded);
  for (int sample = 0; sample < 70; ++sample) {
    INFO(sample);
    const auto command = driver.command(sample * 0.01, at(0));
    REQUIRE(command);
    CHECK(command->track_speed_mps[robot::kLeft] == (sample < 30 ? 0.1 : 0.2));
  }
  CHECK_FALSE(driver.command(0.7, at(0)));
  CHECK(driver.phase() == 2);
}

TEST_CASE("Each end of a phase, beyond its value and not at it") {
  PhaseEnd end;
  Pose before = at(0.5, 0.1, 0.2), beyond;
  SECTION("nose down") {
    end.pitch_above_rad = 0.3;
    beyond = at(0.5, 0.1, 0.31);
  }
  SECTION("nose up") {
    end.pitch_below_rad = -0.3;
    beyond = at(0.5, 0.1, -0.31);
  }
  SECTION("ahead") {
    end.x_above_m = 0.5;
    beyond = at(0.51, 0.1);
  }
  SECTION("back") {
    end.x_below_m = 0.5;
    beyond = at(0.49, 0.1);
  }
  SECTION("up") {
    end.z_above_m = 0.1;
    beyond = at(0.5, 0.11);
  }
  const Manoeuvre manoeuvre = of({lasting(100, 0.2, end)});
  Driver driver(manoeuvre, kFolded);
  CHECK(driver.command(0, before));
  CHECK_FALSE(driver.command(1, beyond));
}

TEST_CASE("A turn counts from where its phase began, through half a turn and either way round") {
  const double sign = GENERATE(1.0, -1.0);
  const Manoeuvre manoeuvre = of({lasting(1), lasting(100, 0.2, {.turned_rad = 1.5 * std::numbers::pi})});
  Driver driver(manoeuvre, kFolded);
  driver.command(0, at(0));
  driver.command(0.5, at(0, 0, 0, sign * 2));  // before the phase: does not count
  for (int degree = 0; degree < 270; degree += 10) {
    INFO(degree);
    CHECK(driver.command(1 + degree * 0.1, at(0, 0, 0, sign * (2 + degree * std::numbers::pi / 180))));
    CHECK(driver.phase() == 1);
  }
  CHECK_FALSE(driver.command(30, at(0, 0, 0, sign * (2 + 270.1 * std::numbers::pi / 180))));
}

TEST_CASE("What holds already is passed over at once, as an operator would") {
  const Manoeuvre manoeuvre = of({lasting(5, 0.1, {.x_above_m = 1}), lasting(5, 0.2, {.x_above_m = 2})});
  Driver driver(manoeuvre, kFolded);
  CHECK(driver.command(0, at(1.5))->track_speed_mps[robot::kRight] == 0.2);
  CHECK(driver.phase() == 1);
}

TEST_CASE("A phase that is given up: the last one follows instead") {
  Manoeuvre manoeuvre = of({lasting(1, 0.1), lasting(1, 0.2), lasting(1, 0.3), lasting(1, 0)});
  manoeuvre.phases[1].give_up = GiveUp{.x_below_m = 0.5, .pitch_below_rad = -0.3};
  Driver driver(manoeuvre, kFolded);
  CHECK(driver.command(0, at(0.4, 0, -0.4))->track_speed_mps[robot::kLeft] == 0.1);  // not its turn yet
  SECTION("where all that is stated holds") {
    CHECK(driver.command(1, at(0.49, 0, -0.31))->track_speed_mps[robot::kLeft] == 0);
    CHECK(driver.phase() == 3);
    CHECK(driver.gave_up());
    CHECK(driver.command(1.99, at(0.6)));  // the last phase has its time; nothing is taken up again
    CHECK(driver.phase() == 3);
    CHECK_FALSE(driver.command(2, at(0.6)));
    CHECK(driver.phase() == 4);
  }
  SECTION("not where one does not, at its value or beyond") {
    const Pose goes_on = GENERATE(at(0.5, 0, -0.4), at(0.4, 0, -0.29));
    CHECK(driver.command(1, goes_on)->track_speed_mps[robot::kLeft] == 0.2);
    CHECK(driver.command(1.5, at(0.4, 0, -0.4))->track_speed_mps[robot::kLeft] == 0.2);  // begun is begun
    CHECK(driver.command(2, at(0.4, 0, -0.4))->track_speed_mps[robot::kLeft] == 0.3);
    CHECK_FALSE(driver.gave_up());
  }
}

TEST_CASE("Whether to give a phase up is asked before whether it is passed over") {
  Manoeuvre manoeuvre =
      of({lasting(1, 0.1), lasting(1, 0.2, {.pitch_above_rad = 0.1}), lasting(1, 0.3), lasting(1, 0)});
  manoeuvre.phases[1].give_up = GiveUp{.x_below_m = 0.5};
  const double x_m = GENERATE(0.4, 0.6);
  Driver driver(manoeuvre, kFolded);
  driver.command(0, at(x_m));
  CHECK(driver.command(1, at(x_m, 0, 0.2))->track_speed_mps[robot::kLeft] == (x_m > 0.5 ? 0.3 : 0));
  CHECK(driver.gave_up() == (x_m < 0.5));
}

TEST_CASE("Flippers stay as they were where a phase says nothing") {
  Manoeuvre manoeuvre = of({lasting(1), lasting(1), lasting(1)});
  manoeuvre.phases[1].flipper_rad = {{0.1, 0.2, 0.3, 0.4}};
  Driver driver(manoeuvre, kFolded);
  CHECK(driver.command(0, at(0))->flipper[robot::kRearLeft].value == 1);
  CHECK(driver.command(1, at(0))->flipper[robot::kRearLeft].value == 0.3);
  CHECK(driver.command(2, at(0))->flipper[robot::kRearLeft].value == 0.3);
}

TEST_CASE("A replay holds each command until the next one is due, and ends with the last") {
  Manoeuvre replay;
  for (const double t : {0.0, 0.033, 0.1}) {
    robot::Command command;
    command.track_speed_mps = {t, -t};
    replay.timed.push_back({t, command});
  }
  Driver driver(replay, kFolded);
  CHECK(driver.next_due_s() <= 0);
  CHECK(driver.command(0, at(0))->track_speed_mps[robot::kLeft] == 0);
  CHECK(driver.next_due_s() == Approx(0.033));
  CHECK(driver.command(0.0329, at(0))->track_speed_mps[robot::kLeft] == 0);
  CHECK(driver.command(0.033, at(0))->track_speed_mps[robot::kRight] == -0.033);
  CHECK(driver.command(0.099, at(0)));
  CHECK_FALSE(driver.command(0.1, at(0)));
}

TEST_CASE("Success: every condition that is stated, of the last pose") {
  Manoeuvre manoeuvre;
  CHECK_FALSE(succeeded(manoeuvre, at(5)));  // no measure, no success
  manoeuvre.success = Success{.x_above_m = 1, .z_above_m = 0.2, .z_below_m = 0.4, .upright_within_rad = 0.3};
  CHECK(succeeded(manoeuvre, at(1.1, 0.3, 0.2)));
  CHECK_FALSE(succeeded(manoeuvre, at(0.9, 0.3, 0.2)));
  CHECK_FALSE(succeeded(manoeuvre, at(1.1, 0.1, 0.2)));
  CHECK_FALSE(succeeded(manoeuvre, at(1.1, 0.5, 0.2)));
  CHECK_FALSE(succeeded(manoeuvre, at(1.1, 0.3, -0.4)));
  CHECK_FALSE(succeeded(manoeuvre, {{1.1, 0, 0.3}, physics::rotation_from({3, 0, 0})}));  // on its back
  CHECK_FALSE(succeeded(manoeuvre, at(std::numeric_limits<double>::quiet_NaN(), 0.3)));
}
