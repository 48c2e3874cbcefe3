// The simulated robot as the drives' plant: signs and units of its commands and reports.
#include "can/candrives/robot_plant.hpp"

#include <catch2/catch.hpp>

#include "formats/description/description_file.hpp"
#include "tests/formats/runs/temporary_folder.hpp"

using namespace kenaf;
using namespace kenaf::candrives;
using namespace std::chrono_literals;

namespace {

void run(RobotPlant& plant, const PlantCommand& command, int steps) {
  for (int i = 0; i < steps; ++i) plant.advance(1ms, command);
}

PlantCommand at_rest(const RobotPlant& plant) {
  PlantCommand command;
  command.flipper_rad = plant.state().flipper_rad;
  return command;
}

}  // namespace

TEST_CASE("Tracks, flippers, currents and yaw rate have the robot's signs", "[robot plant]") {
  RobotPlant plant("kenaf", "flat", 0.05);
  CHECK(plant.state().battery_v == Approx(25.9).margin(1));
  CHECK(plant.state().flipper_rad[0] == Approx(1.0));
  PlantCommand command = at_rest(plant);
  run(plant, command, 200);
  CHECK(std::abs(plant.state().pitch_rad) < 0.01);  // level
  CHECK(std::abs(plant.state().roll_rad) < 0.01);

  SECTION("both tracks forward: 0.2 m/s for 1 s, less the drive's lag of 50 ms") {
    const double x_m = plant.truth().X_WB.p.x();
    command.track_mps = {0.2, 0.2};
    run(plant, command, 1000);
    CHECK(plant.state().track_mps[0] == Approx(0.2).epsilon(0.02));
    CHECK(plant.state().track_m[1] == Approx(0.19).epsilon(0.03));
    CHECK(plant.truth().X_WB.p.x() - x_m == Approx(plant.state().track_m[0]).epsilon(0.03));
    CHECK(plant.state().track_a[0] > 0.3);  // idle current at least
  }
  SECTION("a turn to the left is a positive yaw rate") {
    command.track_mps = {-0.2, 0.2};
    run(plant, command, 500);
    CHECK(plant.state().yaw_rate_radps > 0.2);
  }
  SECTION("front flippers that press down lift the nose: pitch is positive nose down") {
    command.flipper_rad[0] = command.flipper_rad[1] = -0.9;
    run(plant, command, 2000);
    CHECK(plant.state().pitch_rad < -0.03);
    CHECK(plant.state().flipper_rad[0] == Approx(-0.9).margin(0.02));
    CHECK(plant.state().flipper_rad[2] == Approx(1.0).margin(0.02));
  }
}

TEST_CASE("A robot with its rear flippers alone is behind its drives, too", "[robot plant]") {
  const test::TemporaryFolder folder;
  const std::string table = "\n[flipper]\n";
  std::string text = description::read_description_file("robot", "kenaf", ".toml").text;
  text.replace(text.find(table), table.size(), table + "pairs = \"rear\"\n");
  test::write_file(folder / "rear.toml", text);

  RobotPlant plant((folder / "rear.toml").string(), "flat", 0.05);
  PlantCommand command = at_rest(plant);
  command.flipper_rad.fill(-0.9);
  run(plant, command, 2000);
  CHECK(plant.state().pitch_rad > 0.03);  // the tail is up
  CHECK(plant.state().flipper_rad[2] == Approx(-0.9).margin(0.02));
  CHECK(plant.state().flipper_rad[0] == 0);
}

TEST_CASE("A flipper that is sent beyond its stop stands at it, within the reach of its limit switch",
          "[robot plant]") {
  constexpr double kEnd_rad = 3.14159265;  // up and over; the other way the ground is in between
  RobotPlant plant("kenaf", "flat", 0.05);
  PlantCommand command = at_rest(plant);
  // at 0.8 rad/s, as in homing, until half a radian beyond
  for (; command.flipper_rad[0] < kEnd_rad + 0.5; command.flipper_rad[0] += 0.0008) plant.advance(1ms, command);
  CHECK(std::abs(plant.state().flipper_rad[0] - kEnd_rad) < 0.001);
}

TEST_CASE("Steps that are no multiple of the physics' steps are not lost", "[robot plant]") {
  RobotPlant plant("kenaf", "flat", 0.05);
  const PlantCommand command = at_rest(plant);
  for (int i = 0; i < 10; ++i) plant.advance(350us, command);  // 3.5 ms
  CHECK(plant.time_s() == Approx(0.003));
  plant.advance(500us, command);
  CHECK(plant.time_s() == Approx(0.004));
}
