// Deviations that the catalogue has no effect for.
#include "gap/challenge/foreign.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "gap/candidates/candidate.hpp"
#include "gap/challenge/plan.hpp"
#include "physics/effects.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::candidates;
using namespace kenaf::gap::challenge;

namespace {

// Both tracks at 0.3 m/s, all flippers at 1 rad, from flippers at 0 on.
rollout::Manoeuvre drive() {
  rollout::Manoeuvre replay;
  replay.start = rollout::Start{.x_m = 0, .y_m = 0, .yaw_rad = 0, .z_m = {}, .flipper_rad = {0, 0, 0, 0}, .motion = {}};
  robot::Command command;
  command.track_speed_mps = {0.3, 0.3};
  for (auto& flipper : command.flipper) flipper = {robot::JointMode::angle, 1};
  for (int i = 0; i <= 300; ++i) replay.timed.push_back({i * 0.01, command});
  return replay;
}

const robot::Command& at(const rollout::Manoeuvre& replay, double t_s) {
  return replay.timed[static_cast<std::size_t>(std::lround(t_s / 0.01))].command;
}

}  // namespace

TEST_CASE("A foreign deviation is none of the catalogue's, changes nothing at 0, and one of commands does at 1") {
  for (const ForeignEffect& foreign : foreign_effects()) {
    INFO(foreign.name);
    CHECK(physics::find_effect(foreign.name) == nullptr);
    rollout::Manoeuvre none = drive(), all = drive();
    obey_foreign(none, foreign.name, 0);
    obey_foreign(all, foreign.name, 1);
    const auto same = [](const rollout::Manoeuvre& a, const rollout::Manoeuvre& b) {
      for (std::size_t i = 0; i < a.timed.size(); ++i) {
        if (a.timed[i].command.track_speed_mps != b.timed[i].command.track_speed_mps) return false;
        for (std::size_t f = 0; f < robot::kFlipperCount; ++f)
          if (a.timed[i].command.flipper[f].value != b.timed[i].command.flipper[f].value) return false;
      }
      return true;
    };
    CHECK(same(none, drive()));
    CHECK(same(all, drive()) == !is_of_commands(foreign.name));
  }
}

TEST_CASE("No foreign deviation is a number of the description, which a diagnosis would find") {
  for (const Candidate& number : description_candidates(physics::load_robot(kChallengedRobot)))
    for (const ForeignEffect& foreign : foreign_effects()) CHECK(number.name != foreign.name);
}

TEST_CASE("Drives that hunt swing by a fifth in 1.1 s, drives that fade have lost 30 % after 10 s") {
  rollout::Manoeuvre hunts = drive(), fades = drive();
  obey_foreign(hunts, "speed_hunts", 1);
  obey_foreign(fades, "drives_fade", 1);
  for (const std::size_t side : {robot::kLeft, robot::kRight}) {
    CHECK(at(hunts, 0).track_speed_mps[side] == 0.3);
    CHECK(at(hunts, 0.55).track_speed_mps[side] == Approx(0.3));                        // half a period
    CHECK(at(hunts, 1.1 + 0.275).track_speed_mps[side] == Approx(0.36).epsilon(1e-3));  // a quarter of one
    CHECK(at(fades, 0).track_speed_mps[side] == 0.3);
    CHECK(at(fades, 2).track_speed_mps[side] == Approx(0.3 * 0.94));
  }
}

TEST_CASE("A gyro that saturates tells half of 1 rad/s, and two thirds of half") {
  runs::Run run{{"t_s", "gyro_z_radps"}, {{0, 1, 2}, {1, -0.5, 0}}};
  record_foreign(run, "gyro_saturates", 1);
  CHECK(run.column("gyro_z_radps")[0] == Approx(0.5));
  CHECK(run.column("gyro_z_radps")[1] == Approx(-1.0 / 3));
  CHECK(run.column("gyro_z_radps")[2] == 0);
}

TEST_CASE("One flipper that lags by half a second is 1 - 1/e of its way after that, the others are there") {
  rollout::Manoeuvre replay = drive();
  obey_foreign(replay, "right_flipper_lag", 1);
  const robot::Command& command = at(replay, 0.5);
  CHECK(command.flipper[robot::kFrontRight].value == Approx(1 - std::exp(-1)));
  for (const std::size_t other : {robot::kFrontLeft, robot::kRearLeft, robot::kRearRight})
    CHECK(command.flipper[other].value == 1);
  CHECK(command.track_speed_mps[robot::kRight] == 0.3);
}

TEST_CASE("A loose contact stops the right track for the last 0.2 s of each 1.3 s, half of it halves the speed then") {
  rollout::Manoeuvre replay = drive(), half = drive();
  obey_foreign(replay, "right_drive_cuts_out", 1);
  obey_foreign(half, "right_drive_cuts_out", 0.5);
  for (const double t_s : {0.0, 1.05, 1.35, 2.35, 2.7}) CHECK(at(replay, t_s).track_speed_mps[robot::kRight] == 0.3);
  for (const double t_s : {1.15, 1.25, 2.45}) {
    CHECK(at(replay, t_s).track_speed_mps[robot::kRight] == 0);
    CHECK(at(half, t_s).track_speed_mps[robot::kRight] == Approx(0.15));
    CHECK(at(replay, t_s).track_speed_mps[robot::kLeft] == 0.3);
  }
}
