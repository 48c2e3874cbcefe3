// M1 steps of a driving robot allocate nothing; M2 nor does reading sensors other than range scanners.
// A program of its own, because it counts every allocation of the process: Bullet's, C++'s and C's all end in these
// functions, which stand before those of the C library. Not built with sanitizers, which do the same.
#include <catch2/catch.hpp>
#include <cerrno>
#include <cstddef>

#include "tests/physics/scenes.hpp"

using namespace kenaf::physics;

namespace {

thread_local long allocations = 0;

}  // namespace

// The C library's own; __libc_ names are glibc's for whoever puts a function before them.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

[[gnu::visibility("default")]] void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
[[gnu::visibility("default")]] void* calloc(std::size_t count, std::size_t size) {
  ++allocations;
  return __libc_calloc(count, size);
}
[[gnu::visibility("default")]] void* realloc(void* memory, std::size_t size) {
  ++allocations;
  return __libc_realloc(memory, size);
}
[[gnu::visibility("default")]] void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++allocations;
  return __libc_memalign(alignment, size);
}
[[gnu::visibility("default")]] int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  ++allocations;
  *memory = __libc_memalign(alignment, size);
  return *memory ? 0 : ENOMEM;
}
}

namespace {

// How often `time_s` of simulation allocate; `readings` null: sensors are not read.
long allocations_in(World& world, double time_s, RobotId robot, std::vector<SensorSample>* readings) {
  const auto steps = std::lround(time_s / world.settings().time_step_s);
  const long before = allocations;
  for (long i = 0; i < steps; ++i) {
    world.step();
    if (!readings) continue;
    readings->clear();
    world.read_sensors(robot, *readings);
  }
  return allocations - before;
}

}  // namespace

TEST_CASE("M0: an allocation is counted") {
  const long before = allocations;
  const std::vector<int> memory(1000);
  CHECK(memory.size() == 1000);
  CHECK(allocations == before + 1);
}

TEST_CASE("M1: steps of a robot that climbs allocate nothing") {
  std::vector<std::string> unsupported;
  World world(load_world("step-100", unsupported), {}, 1);
  const RobotId robot = world.add_robot(load_robot("kenaf"), "robot", {{0.45, 0, 0.1}, Eigen::Quaterniond::Identity()});
  world.set_command(robot, drive(0.3, 0.3, 0.8, 0));
  allocations_in(world, 1, robot, nullptr);              // it falls, stands and drives
  CHECK(allocations_in(world, 2, robot, nullptr) == 0);  // meets the step and climbs
  CHECK(world.truth(robot).X_WB.p.z() > 0.12);
}

TEST_CASE("M1: a robot that crosses a trench allocates nothing but Bullet's two lists for a pair of bodies") {
  WorldDescription platforms;
  for (const double x_m : {-1.5, 1.8}) platforms.boxes.push_back(fixed_box({3, 2, 0.5}, {x_m, 0, -0.25}));
  World world(platforms, {}, 1);
  const RobotId robot = world.add_robot(load_robot("kenaf"), "robot", {{-0.8, 0, 0.1}, Eigen::Quaterniond::Identity()});
  world.set_command(robot, drive(0.4, 0.4, 0, 0));
  allocations_in(world, 1, robot, nullptr);
  // btCompoundCollisionAlgorithm makes them when the robot's hull first comes near the second platform
  CHECK(allocations_in(world, 3, robot, nullptr) <= 2);
  CHECK(world.truth(robot).X_WB.p.x() > 0.5);
}

TEST_CASE("M2: reading sensors allocates nothing but what a range scan holds") {
  World world(ground(), {}, 1);
  RobotDescription description = load_robot("kenaf");
  std::erase_if(description.sensors, [](const SensorDescription& s) { return s.type == SensorType::range_scanner; });
  const RobotId robot = world.add_robot(description, "robot", {{0, 0, 0.1}, Eigen::Quaterniond::Identity()});
  world.set_command(robot, drive(0.2, 0.2));
  std::vector<SensorSample> readings;
  allocations_in(world, 1.1, robot, &readings);  // the slowest reports once a second
  CHECK(allocations_in(world, 2, robot, &readings) == 0);
}
