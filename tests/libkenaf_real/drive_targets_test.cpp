// The commands of the drives: limits, ramps, the handshake; and that nothing moves without a command.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "libkenaf_real/drive_targets.hpp"

using namespace kenaf;
using namespace kenaf::real;
using canopen::DriveMode;
using canopen::kControlEnable;

namespace {

canbus::RobotBus bus_with(DriveMode track, DriveMode flipper) {
  canbus::RobotBus bus = canbus::load_robot_bus("kenaf");
  for (canbus::DriveOnBus& drive : bus.drives) drive.mode = drive.is_flipper() ? flipper : track;
  return bus;
}

// All enabled, flippers at `counts`, no set-point acknowledged.
ProcessImage image_at(const canbus::RobotBus& bus, std::int32_t counts) {
  ProcessImage image(bus);
  for (std::size_t i = 0; i < bus.drives.size(); ++i) {
    const std::int64_t values[] = {0x0637, counts};
    image.on_frame({pack(canbus::pdos_of(bus, i).state, bus.drives[i].node, values), canopen::Time(1)});
  }
  return image;
}

// As the opening leaves it: all were told to stay where they are.
DriveOrders held_at(const canbus::RobotBus& bus, const ProcessImage& image) {
  DriveOrders held(bus.drives.size());
  for (std::size_t i = 0; i < held.size(); ++i)
    held[i] = {kControlEnable, bus.drives[i].is_flipper() ? image.drive(i).position : 0};
  return held;
}

}  // namespace

TEST_CASE("Without a command flippers keep where they are, and tracks stand") {
  const canbus::RobotBus bus = bus_with(DriveMode::cyclic_velocity, DriveMode::cyclic_position);
  const ProcessImage image = image_at(bus, 12345);
  DriveTargets targets(bus, held_at(bus, image));
  for (int k = 0; k < 10; ++k) {
    const DriveOrders orders = targets.step(robot::Command{}, image, 0.01);
    for (std::size_t i = 0; i < bus.drives.size(); ++i) {
      CHECK(orders[i].controlword == kControlEnable);
      CHECK(orders[i].target == (bus.drives[i].is_flipper() ? 12345 : 0));
    }
  }
}

TEST_CASE("A cyclic track speed is ramped by the description's acceleration, a profile one is the drive's to ramp") {
  robot::Command command;
  command.track_speed_mps = {0.2, -0.2};
  const canbus::RobotBus cyclic = bus_with(DriveMode::cyclic_velocity, DriveMode::cyclic_position);
  const ProcessImage image = image_at(cyclic, 0);
  DriveTargets ramped(cyclic, held_at(cyclic, image));
  // 5 m/s^2 in 10 ms: 0.05 m/s a cycle; the right drive counts backwards, so that its -0.05 is positive
  const double units = cyclic.drives[0].units.velocity_per_unit;
  DriveOrders orders = ramped.step(command, image, 0.01);
  CHECK(orders[0].target == std::lround(0.05 * units));
  CHECK(orders[1].target == std::lround(0.05 * units));
  for (int k = 0; k < 3; ++k) orders = ramped.step(command, image, 0.01);
  CHECK(orders[0].target == std::lround(0.2 * units));

  const canbus::RobotBus profile = bus_with(DriveMode::profile_velocity, DriveMode::profile_position);
  DriveTargets direct(profile, held_at(profile, image));
  CHECK(direct.step(command, image, 0.01)[0].target == std::lround(0.2 * units));
}

TEST_CASE("A cyclic track that is to run the other way brakes as for a stop, and then speeds up") {
  const canbus::RobotBus bus = bus_with(DriveMode::cyclic_velocity, DriveMode::cyclic_position);
  const ProcessImage image = image_at(bus, 0);
  DriveTargets targets(bus, held_at(bus, image));
  robot::Command command;
  command.track_speed_mps = {0.5, -0.5};
  for (int k = 0; k < 20; ++k) targets.step(command, image, 0.01);
  command.track_speed_mps = {-0.5, 0.5};
  // in each 10 ms 0.125 m/s less at 12.5 m/s^2, and 0.05 m/s more at 5 m/s^2
  for (const double speed_mps : {0.375, 0.25, 0.125, 0.0, -0.05, -0.1, -0.15}) {
    const DriveOrders orders = targets.step(command, image, 0.01);
    CHECK(orders[0].target == velocity_to_drive(bus.drives[0].units, speed_mps));
    CHECK(orders[1].target == velocity_to_drive(bus.drives[1].units, -speed_mps));
  }
}

TEST_CASE(
    "A speed beyond the limit is cut to it, a flipper goes to the same direction within its range as the simulated one "
    "does") {
  const canbus::RobotBus bus = bus_with(DriveMode::profile_velocity, DriveMode::profile_position);
  const ProcessImage image = image_at(bus, 0);
  DriveTargets targets(bus, held_at(bus, image));
  robot::Command command;
  command.track_speed_mps = {99, -99};
  command.flipper[0] = {robot::JointMode::angle, 6};
  const DriveOrders orders = targets.step(command, image, 0.01);
  CHECK(orders[0].target == std::lround(0.5 * bus.drives[0].units.velocity_per_unit));
  CHECK(orders[2].target == position_to_drive(bus.drives[2].units, 6 - 2 * std::numbers::pi));
  CHECK((orders[2].controlword & canopen::kControlNewSetPoint) != 0);
  CHECK((orders[3].controlword & canopen::kControlNewSetPoint) == 0);  // was never commanded: no set-point
}

TEST_CASE("A flipper that stands outside of its limits stays there until it is told, and then goes as its ramp does") {
  for (const DriveMode mode : {DriveMode::cyclic_position, DriveMode::profile_position}) {
    const canbus::RobotBus bus = bus_with(DriveMode::cyclic_velocity, mode);
    const std::int32_t outside = position_to_drive(bus.drives[2].units, 4);  // its range ends at pi
    const ProcessImage image = image_at(bus, outside);
    DriveTargets targets(bus, held_at(bus, image));
    for (int k = 0; k < 10; ++k) {
      const DriveOrders orders = targets.step(robot::Command{}, image, 0.01);
      for (std::size_t i = robot::kTrackCount; i < bus.drives.size(); ++i) {
        CHECK(orders[i].controlword == kControlEnable);
        CHECK(orders[i].target == outside);
      }
    }
    robot::Command command;
    command.flipper[0] = {robot::JointMode::angle, 3};
    const DriveOrders orders = targets.step(command, image, 0.01);
    // 15 rad/s^2 in 10 ms: 0.15 rad/s, and so 0.0015 rad; a drive in profile mode has its own ramp
    const double first_rad = mode == DriveMode::cyclic_position ? 4 - 0.0015 : 3;
    CHECK(orders[2].target == Approx(position_to_drive(bus.drives[2].units, first_rad)).margin(1));
    CHECK(orders[3].target == outside);
  }
}

TEST_CASE("A position ramp reaches its target in the time of its trapezoid and does not go beyond") {
  // 1 rad at 1.5 rad/s and 15 rad/s^2: 0.1 s up, 0.1 s down, 0.15 rad together; 0.85 rad at full speed: 0.567 s; in all
  // 0.767 s
  PositionRamp ramp;
  double time_s = 0, fastest = 0, farthest = 0;
  while (std::abs(ramp.position - 1) > 1e-6 && time_s < 5) {
    const double before = ramp.speed;
    ramp.step(1, 1.5, 15, 0.01);
    time_s += 0.01;
    fastest = std::max(fastest, ramp.speed);
    farthest = std::max(farthest, ramp.position);
    CHECK(std::abs(ramp.speed - before) <= 15 * 0.01 + 1e-9);
  }
  CHECK(fastest == Approx(1.5));
  CHECK(farthest <= 1 + 1e-6);
  CHECK(time_s == Approx(0.767).margin(0.05));  // whole steps, and the last ones are slow
}

TEST_CASE("A target that comes nearer than the way to stop is gone back to, within the acceleration") {
  PositionRamp ramp;
  for (int k = 0; k < 30; ++k) ramp.step(1, 1.5, 15, 0.01);
  for (int k = 0; k < 200; ++k) {
    const double before = ramp.speed;
    ramp.step(0.1, 1.5, 15, 0.01);
    CHECK(std::abs(ramp.speed - before) <= 15 * 0.01 + 1e-9);
  }
  CHECK(ramp.position == Approx(0.1).margin(1e-4));
}
