// The events that gz-sim's test of its tracked vehicle has (test/integration/tracked_vehicle_system.cc), driven by
// Kenaf: straight, turn, stairs, half cylinder, a tilted box that needs flippers, and no motion without belts. Their
// tolerances, where they are as tight as Kenaf's own physics allows; speeds are Kenaf's.
#include <catch2/catch.hpp>
#include <cmath>

#include "rollout/roll_out.hpp"

using namespace kenaf;
using rollout::Manoeuvre;
using rollout::RollOut;

namespace {

RollOut drive(const physics::RobotDescription& robot, const Manoeuvre& manoeuvre) {
  std::vector<std::string> unsupported;
  rollout::RollOutOptions exact;
  exact.noise_scale = 0;
  return rollout::roll_out(robot, physics::load_world(manoeuvre.world, unsupported), manoeuvre, exact);
}
RollOut drive(const std::string& manoeuvre) {
  return drive(physics::load_robot("kenaf"), rollout::load_manoeuvre(manoeuvre));
}

}  // namespace

TEST_CASE("Kenaf drives 1 m straight ahead, then it stands") {
  // 0.2 m/s for 5 s; what the speed loop's lag costs at the start it gives back at the end
  const RollOut out = drive("straight");
  CHECK(out.end.X_WB.p.x() == Approx(1).margin(0.001));
  CHECK(std::abs(out.end.X_WB.p.y()) < 0.001);
  CHECK(std::abs(physics::roll_pitch_yaw(out.end.X_WB.q).z()) < 1e-3);
  CHECK(out.end.v_WB_mps.norm() < 1e-3);
}

TEST_CASE("Kenaf turns by 0.25 rad on the spot, to either side") {
  for (const double side : {1.0, -1.0}) {
    Manoeuvre turn = rollout::load_manoeuvre("turn-in-place");
    REQUIRE(turn.phases.size() == 3);  // stand, turn, rest
    turn.phases[1].track_mps = {-0.2 * side, 0.2 * side};
    turn.phases[1].end.turned_rad = 0.25;
    const RollOut out = drive(physics::load_robot("kenaf"), turn);
    // 1.1 rad/s go on for the lag of 0.05 s and for up to a sample of 0.01 s, then friction stops the rest: 0.01 rad
    const double turned = side * physics::roll_pitch_yaw(out.end.X_WB.q).z();
    CHECK(turned > 0.25 + 1.0 * 0.05);
    CHECK(turned < 0.25 + 1.1 * 0.06 + 0.01);
    CHECK(out.end.X_WB.p.head<2>().norm() < 0.01);
  }
}

TEST_CASE("Kenaf climbs 12 stairs of 75 mm by 175 mm") {
  const RollOut out = drive("stairs");
  CHECK(out.succeeded);
  CHECK(out.end.X_WB.p.z() == Approx(12 * 0.075 + 0.09).margin(0.005));
  CHECK(std::abs(out.end.X_WB.p.y()) < 0.05);
  // on the stairs, edge to edge, it lies along them: atan(75 / 175) = 0.405 rad nose up
  double sum = 0;
  int rows = 0;
  for (std::size_t row = 0; row < out.run.row_count(); ++row) {
    const double x = out.run.column("x_m")[row];
    if (x < 1.6 || x > 2.6) continue;
    sum += out.run.column("pitch_rad")[row];
    ++rows;
  }
  REQUIRE(rows > 100);
  CHECK(sum / rows == Approx(-std::atan(75.0 / 175)).margin(0.05));
}

TEST_CASE("Kenaf drives over a half cylinder of 150 mm") {
  Manoeuvre over;
  over.world = "half-cylinder";
  over.phases = {
      {.name = "", .track_mps = {0.2, 0.2}, .flipper_rad = {{0.6, 0.6, 0.2, 0.2}}, .at_most_s = 15, .end = {}}};
  over.phases[0].end.x_above_m = 2;
  const RollOut out = drive(physics::load_robot("kenaf"), over);
  CHECK(out.end.X_WB.p.x() > 2);
  CHECK(out.end.X_WB.p.z() == Approx(0.09).margin(0.01));
}

// Kenaf's own friction of 1.3 pulls its bare tracks over: to raise the nose at a wall takes more than 1 (the climbs of
// tests/physics/tracks_test.cpp). gz-sim's vehicle has 0.7, and so has Kenaf here.
TEST_CASE("With a friction of 0.7 the tilted box needs flippers") {
  physics::RobotDescription robot = physics::load_robot("kenaf");
  robot.track.front().friction_along = robot.track.front().friction_across = 0.7;
  robot.flipper.front().friction_along = robot.flipper.front().friction_across = 0.7;
  robot.track.front().lug_height_m = 0;
  const Manoeuvre over = rollout::load_manoeuvre("tilted-box");
  const RollOut out = drive(robot, over);
  INFO("ended at x = " << out.end.X_WB.p.x());
  CHECK(out.succeeded);
  robot.flipper.clear();
  const RollOut stuck = drive(robot, over);
  CHECK_FALSE(stuck.succeeded);
  CHECK(stuck.end.X_WB.p.x() < 1);  // it leans against the box: its centre has not come over the edge
}

TEST_CASE("With its belts off the robot does not move, on the ground, on a slope or at the box") {
  physics::RobotDescription off = physics::load_robot("kenaf");
  off.drive.max_force_n = 1e-9;
  for (const char* name : {"straight", "turn-in-place", "stairs", "tilted-box"}) {
    INFO(name);
    Manoeuvre manoeuvre = rollout::load_manoeuvre(name);
    for (rollout::Phase& phase : manoeuvre.phases) phase.flipper_rad.reset();  // flippers are not off
    const RollOut out = drive(off, manoeuvre);
    CHECK(out.end.X_WB.p.head<2>().norm() < 0.001);
    CHECK(std::abs(physics::roll_pitch_yaw(out.end.X_WB.q).z()) < 1e-3);
    CHECK_FALSE(out.end.X_WB.p.z() > 0.1);
  }
}

// The data sheets: Husky A200 has wheels of 0.165 m; the Pioneer 3-AT of 0.111 m climbs 0.1 m, by the tread of its
// tyres: smooth ones of friction 0.8 slide on the edge.
TEST_CASE("Husky and the Pioneer 3-AT drive the square and climb a step of 100 mm") {
  for (const char* name : {"husky", "p3at"}) {
    INFO(name);
    const physics::RobotDescription robot = physics::load_robot(name);
    CHECK(drive(robot, rollout::load_manoeuvre("square")).succeeded);
    const RollOut step = drive(robot, rollout::load_manoeuvre("step-100"));
    CHECK(step.succeeded);
    CHECK(step.end.X_WB.p.z() == Approx(0.1 + robot.ride_height_m()).margin(0.01));
  }
  physics::RobotDescription smooth = physics::load_robot("p3at");
  for (physics::TrackDescription& wheels : smooth.track) wheels.lug_height_m = 0;
  CHECK_FALSE(drive(smooth, rollout::load_manoeuvre("step-100")).succeeded);
}
