// After the first step no step allocates: for a robot on any ground, with and without effects, for robots that meet,
// the boxes that they push and bodies that come near later, and for many robots. Reading sensors other than range
// scanners allocates nothing either. This is a program of its own, because it counts every allocation of the process:
// Bullet's, C++'s and C's all end in these functions, which stand before those of the C library. It is not built with
// sanitizers, which replace them too.
#include <catch2/catch.hpp>
#include <new>

#include "tests/physics/scenes.hpp"
#include "tests/support/heap_calls.hpp"

using namespace kenaf;
using namespace kenaf::physics;
using kenaf::test::heap_calls;

namespace {

// How often `time_s` of simulation allocate; `readings` null: sensors are not read.
long allocations_in(World& world, double time_s, RobotId robot, std::vector<SensorSample>* readings) {
  const auto steps = std::lround(time_s / world.settings().time_step_s);
  const long before = heap_calls();
  for (long i = 0; i < steps; ++i) {
    world.step();
    if (!readings) continue;
    readings->clear();
    world.read_sensors(robot, *readings);
  }
  return heap_calls() - before;
}

}  // namespace

TEST_CASE("An allocation is counted") {
  const long before = heap_calls();
  void* memory = ::operator new(1000);  // called by its name, so that no compiler leaves it out
  const long counted = heap_calls() - before;
  ::operator delete(memory);
  CHECK(counted == 1);
}

namespace {

struct Drive {
  const char* world;
  double start_x_m;  // beyond the world's own start
  robot::Command command;
  double time_s;
  double reached_x_m;  // so far it comes: it met what the world is about
};

// What a robot meets in the worlds that ship: arcs, bellies and flippers on edges, walls, faces and meshes.
const Drive kDrives[] = {
    {"flat", 0, drive(0.3, 0.3, -0.3, -0.3), 2, 0.3},        {"step-100", 0.4, drive(0.3, 0.3, 0.8, 0), 4, 1.2},
    {"step-200", 0.4, drive(0.3, 0.3, 0.8, -0.2), 4, 1.2},   {"step-350", 0.4, drive(0.3, 0.3, 0.8, -0.5), 4, 0.45},
    {"trench-300", 0.4, drive(0.3, 0.3, 0, 0), 4, 1.2},      {"rubble-mesh", 0.2, drive(0.3, 0.3, 0.8, -0.3), 4, 1},
    {"hills", 0.2, drive(0.3, 0.2, -0.2, -0.2), 4, 0.8},     {"stairs", 0.2, drive(0.3, 0.3, 0.7, 0), 5, 1.2},
    {"step-field", 0.2, drive(0.3, 0.25, 0.8, -0.3), 5, 0.8}};

// One of every stage, and those that act in a contact or a joint.
Effects some_effects() {
  Effects effects;
  effects.command_delay_s = 0.05;
  effects.drive_coulomb_n = 5;
  effects.flipper_backlash_rad = 0.02;
  effects.flipper_compliance_radpnm = 0.001;
  effects.pitch_inertia_scale = 1.2;
  effects.slip_with_speed_spm = 0.1;
  effects.shear_deformation_m = 0.003;
  effects.rolling_resistance = 0.02;
  effects.ground_compliance_scale = 2;
  effects.encoder_scale = 1.01;
  effects.posture_delay_s = 0.05;
  return effects;
}

long allocations_of(const Drive& way, const Effects& effects) {
  std::vector<std::string> unsupported;
  RobotDescription robot = load_robot("kenaf");
  robot.effects = effects;
  const WorldDescription world_description = load_world(way.world, unsupported);
  World world(world_description, {}, 1);
  const StartPose& start = world_description.start_poses.front();
  Pose X_WB = start.X_WB;
  X_WB.p.x() += way.start_x_m;
  const RobotId id = world.add_robot(robot, "robot", X_WB);
  world.set_command(id, way.command);
  world.step();
  const long count = allocations_in(world, way.time_s, id, nullptr);
  CHECK(world.truth(id).X_WB.p.x() > way.reached_x_m);
  return count;
}

}  // namespace

TEST_CASE("After the first, no step allocates") {
  for (const Drive& way : kDrives) {
    INFO(way.world);
    CHECK(allocations_of(way, {}) == 0);
  }
}

TEST_CASE("No step allocates with effects") {
  for (const Drive& way : kDrives) {
    INFO(way.world);
    CHECK(allocations_of(way, some_effects()) == 0);
  }
}

TEST_CASE("No step allocates where robots meet head on and climb each other") {
  World world(ground(), {}, 1);
  const RobotDescription kenaf = load_robot("kenaf");
  const RobotId a = world.add_robot(kenaf, "a", {{-0.8, 0.05, 0.1}, Eigen::Quaterniond::Identity()});
  const RobotId b = world.add_robot(kenaf, "b", {{0.8, -0.05, 0.1}, rotation_from({0, 0, std::numbers::pi})});
  world.set_command(a, drive(0.4, 0.4, 0.6, 0));
  world.set_command(b, drive(0.3, 0.3, -0.2, 0));
  world.step();
  CHECK(allocations_in(world, 4, a, nullptr) == 0);
  const RobotTruth truth_a = world.truth(a), truth_b = world.truth(b);
  CHECK((truth_a.X_WB.p - truth_b.X_WB.p).norm() < 0.8);
  CHECK(std::abs(roll_pitch_yaw(truth_a.X_WB.q).y()) + std::abs(roll_pitch_yaw(truth_b.X_WB.q).y()) > 0.1);
}

TEST_CASE("No step allocates where a robot falls on another, and on its back") {
  World world(ground(), {}, 1);
  const RobotDescription kenaf = load_robot("kenaf");
  const RobotId below = world.add_robot(kenaf, "below", {{0, 0, 0.1}, Eigen::Quaterniond::Identity()});
  const RobotId above = world.add_robot(kenaf, "above", {{0.1, 0.1, 0.8}, rotation_from({2.5, 0.3, 1})});
  world.set_command(below, drive(0.3, -0.3));
  world.set_command(above, drive(0.3, 0.3));
  world.step();
  CHECK(allocations_in(world, 3, below, nullptr) == 0);
}

TEST_CASE("No step allocates where a robot pushes boxes on each other and against a wall") {
  WorldDescription description = ground();
  description.boxes.push_back(fixed_box({0.2, 2, 0.4}, {1.3, 0, 0.2}));
  for (const double x_m : {0.75, 1.0})
    description.boxes.push_back(loose_box({0.2, 0.5, 0.2}, {{x_m, 0, 0.1}, Eigen::Quaterniond::Identity()}, 2, 0.5));
  World world(description, {}, 1);
  const RobotId robot = world.add_robot(load_robot("kenaf"), "robot", {{0, 0, 0.1}, Eigen::Quaterniond::Identity()});
  world.set_command(robot, drive(0.4, 0.4, 0.3, 0));
  world.step();
  CHECK(allocations_in(world, 3, robot, nullptr) == 0);
}

TEST_CASE("No step allocates where three robots fall on each other in a field of pallets") {
  std::vector<std::string> unsupported;
  const WorldDescription description = load_world("step-field", unsupported);
  World world(description, {}, 1);
  const RobotDescription kenaf = load_robot("kenaf");
  Pose X_WB = description.start_poses.front().X_WB;
  X_WB.p.x() += 0.5;
  for (const char* name : {"a", "b", "c"}) {
    world.set_command(world.add_robot(kenaf, name, X_WB), drive(0.4, 0.3, 0.8, -0.8));
    X_WB.p += Eigen::Vector3d(0.3, 0.2, 0.4);
  }
  world.step();
  CHECK(allocations_in(world, 2, world.robots().front(), nullptr) == 0);
}

TEST_CASE("No step allocates where sixteen robots turn among each other") {
  World world(ground(), {}, 1);
  const RobotDescription kenaf = load_robot("kenaf");
  for (int i = 0; i < 16; ++i) {
    const Eigen::Vector3d p_WB(i % 4 * 0.9, i / 4 * 0.7, 0.1);  // NOLINT(bugprone-integer-division): rows of four
    const RobotId robot = world.add_robot(kenaf, "robot" + std::to_string(i), {p_WB, Eigen::Quaterniond::Identity()});
    world.set_command(robot, drive(-0.3, 0.3, 0.5, 0.5));
  }
  world.step();
  CHECK(allocations_in(world, 1, world.robots().front(), nullptr) == 0);
}

TEST_CASE("Contacts are read without allocation into a list that has room") {
  World world(ground(), {}, 1);
  const RobotId robot = world.add_robot(load_robot("kenaf"), "robot", {{0, 0, 0.1}, Eigen::Quaterniond::Identity()});
  std::vector<ContactPoint> points;
  points.reserve(256);
  world.step();
  const long before = heap_calls();
  for (int i = 0; i < 1000; ++i) {
    world.step();
    world.contacts(robot, points);
  }
  CHECK(heap_calls() == before);
  CHECK_FALSE(points.empty());
}

TEST_CASE("Reading sensors allocates nothing but what a range scan holds") {
  World world(ground(), {}, 1);
  RobotDescription description = load_robot("kenaf");
  std::erase_if(description.sensors, [](const SensorDescription& s) { return s.type == SensorType::range_scanner; });
  const RobotId robot = world.add_robot(description, "robot", {{0, 0, 0.1}, Eigen::Quaterniond::Identity()});
  world.set_command(robot, drive(0.2, 0.2));
  std::vector<SensorSample> readings;
  allocations_in(world, 1.1, robot, &readings);  // the slowest reports once a second
  CHECK(allocations_in(world, 2, robot, &readings) == 0);
}
