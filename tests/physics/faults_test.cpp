// A robot that falls out of the world, explodes or loses its numbers is named and harms no other robot. Its neighbour
// must drive the same bits as without it, its sensors report finite numbers, and the ground or box under it carries the
// next robot.
#include <catch2/catch.hpp>

#include "tests/physics/scenes.hpp"

using namespace kenaf::physics;
using Catch::Contains;

TEST_CASE("A robot without ground under it leaves the world, and can be put back") {
  WorldDescription pit = ground();
  pit.planes.clear();
  pit.boxes.push_back(fixed_box({4, 4, 1}, {0, 0, -0.5}));
  World world(pit, {}, 1);
  const RobotId lost = world.add_robot(load_robot("kenaf"), "a", {{10, 0, 0}, Eigen::Quaterniond::Identity()});
  // 100 m take sqrt(2 * 100 / g) = 4.516 s
  run(world, 4.51);
  CHECK(world.fault(lost).empty());
  run(world, 0.02);
  CHECK_THAT(world.fault(lost), Contains("left the world"));
  const Pose at_fault = world.truth(lost).X_WB;
  run(world, 1);
  CHECK(world.truth(lost).X_WB.p == at_fault.p);
  CHECK(world.truth(lost).v_WB_mps.norm() == 0);
  world.teleport(lost, {});
  CHECK(world.fault(lost).empty());
  world.set_command(lost, drive(0.2, 0.2));
  run(world, 2);
  CHECK(world.truth(lost).X_WB.p.x() == Approx(0.39).margin(5e-3));
}

// Its moment of inertia has no inverse; flippers would add theirs.
static RobotDescription without_inertia() {
  RobotDescription robot = load_robot("kenaf");
  robot.body.inertia_kgm2 = {1e-310, 1e-310, 1e-310};
  robot.flipper.clear();
  return robot;
}

TEST_CASE("A robot whose numbers end is named, and its neighbour drives on to the same bits") {
  RobotDescription wild = load_robot("kenaf");
  std::string expected;
  SECTION("explodes: belts that pull with ten times its weight reach 50 m/s in 0.5 s") {
    wild.track.front().friction_along = 10;
    wild.drive.max_speed_mps = 1e5;
    wild.drive.max_force_n = 1e6;
    expected = "exploded";
  }
  SECTION("is no number: a moment of inertia that has no inverse") {
    wild = without_inertia();
    expected = "not a number";
  }
  const auto end_of_neighbour = [&](bool company) {
    World world(ground(), {}, 1);
    const RobotId id = world.add_robot(load_robot("kenaf"), "a", {});
    RobotId other{};
    if (company) {
      other = world.add_robot(wild, "b", {{5, 0, 0}, Eigen::Quaterniond::Identity()});
      world.set_command(other, drive(1e4, 1e4));
    }
    world.set_command(id, drive(0.3, 0.1));
    run(world, 1);
    if (company) CHECK_THAT(world.fault(other), Contains(expected));
    CHECK(world.fault(id).empty());
    return world.truth(id).X_WB;
  };
  const Pose alone = end_of_neighbour(false), beside = end_of_neighbour(true);
  CHECK(alone.p == beside.p);
  CHECK(alone.q.coeffs() == beside.q.coeffs());
}

TEST_CASE("After a fault sensors report a robot that stands, in numbers, and a teleport begins anew") {
  const RobotDescription wild = without_inertia();
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(wild, "a", {});
  world.set_command(id, drive(0.3, 0.3));
  run(world, 1);
  REQUIRE_THAT(world.fault(id), Contains("not a number"));
  const RobotTruth truth = world.truth(id);
  CHECK(truth.X_WB.p.allFinite());
  CHECK(truth.track_mps == std::array<double, 2>{});
  CHECK(std::isfinite(truth.battery_v));
  std::vector<SensorSample> samples;
  world.read_sensors(id, samples);
  for (const SensorSample& sample : samples) {
    if (const auto* encoder = std::get_if<EncoderReading>(&sample.reading))
      for (const auto count : encoder->counts) CHECK(std::abs(count) < 1000);
    if (const auto* drives = std::get_if<DrivesReading>(&sample.reading)) {
      for (const double current_a : drives->track_a) CHECK(std::abs(current_a) < 1);
      CHECK(std::isfinite(drives->battery_v));
    }
  }
  // a moment of inertia without an inverse is one still: it goes wrong again, and says so again
  world.teleport(id, {});
  CHECK(world.fault(id).empty());
  CHECK(world.truth(id).X_WB.p.allFinite());
  run(world, 1);
  CHECK_THAT(world.fault(id), Contains("not a number"));
}

TEST_CASE("A loose box under a robot that is no number stays a box, and carries the next robot") {
  const RobotDescription wild = without_inertia();
  World world(ground(), {}, 1);
  const Pose X_WBox{{0, 0, 0.1}, Eigen::Quaterniond::Identity()};
  const BoxId box = world.add_box(loose_box({2, 2, 0.2}, X_WBox, 10, 1));
  const RobotId broken = world.add_robot(wild, "a", {{0, 0, 0.2}, Eigen::Quaterniond::Identity()});
  world.set_command(broken, drive(0.3, 0.3));
  run(world, 1);
  REQUIRE_THAT(world.fault(broken), Contains("not a number"));
  CHECK((world.box_pose(box).p - X_WBox.p).norm() < 1e-3);
  world.remove_robot(broken);
  // its top is at 0.2 m, the belly 0.09 m below the robot's centre. 30 kg press four points by 0.4 mm into the ground
  const RobotId next = world.add_robot(load_robot("kenaf"), "b", {{0, 0, 0.2}, Eigen::Quaterniond::Identity()});
  run(world, 1);
  CHECK(world.fault(next).empty());
  CHECK(world.truth(next).X_WB.p.z() == Approx(0.29).margin(1e-3));
}
