// Memory that is out in the middle of something: with the heap failing at each of its calls in turn, a world either has
// done what it was asked, or has not begun it, and steps on as if it had not been asked.
#include <catch2/catch.hpp>
#include <functional>
#include <new>
#include <vector>

#include "physics/robot_description.hpp"
#include "physics/world.hpp"
#include "tests/support/heap_calls.hpp"

namespace kenaf::physics {

namespace {

const RobotDescription kKenaf = load_robot("kenaf");

World with_robot() {
  std::vector<std::string> unsupported;
  World world(load_world("flat", unsupported), {}, 1);
  world.add_robot(kKenaf, "first", {{0, 0, 0}, Eigen::Quaterniond::Identity()});
  Box box;
  box.name = "box";
  box.mass_kg = 1;
  box.size_m = {0.3, 0.3, 0.3};
  box.X_WBox.p = {0, 1, 0.2};
  world.add_box(box);
  return world;
}

// Where the first robot and all boxes are after some steps.
std::vector<double> course_of(World& world) {
  robot::Command ahead;
  ahead.track_speed_mps = {0.3, 0.2};
  world.set_command(world.robots().front(), ahead);
  for (int i = 0; i < 20; ++i) world.step();
  const Pose X_WB = world.truth(world.robots().front()).X_WB;
  std::vector<double> course{X_WB.p.x(), X_WB.p.y(), X_WB.p.z(), X_WB.q.w(), X_WB.q.z()};
  for (const BoxId id : world.boxes()) course.push_back(world.box_pose(id).p.z());
  return course;
}

// Has every call of the heap within `work` fail in turn, until none does. Returns how many there were. A world in which
// they failed is as one that was not asked, to the bit.
long fail_each_call(const std::function<void(World&)>& work) {
  World world = with_robot(), untouched = with_robot();
  for (long n = 1;; ++n) {
    const std::size_t robots = world.robots().size(), boxes = world.boxes().size();
    bool threw = false;
    test::fail_heap_call(n);
    try {
      work(world);
    } catch (const std::bad_alloc&) {
      threw = true;
    }
    const bool failed = test::heap_call_failed();
    test::fail_heap_call(0);
    INFO("call " << n);
    REQUIRE(threw == failed);
    if (!failed) {
      if (world.robots().size() > robots) world.remove_robot(world.robots().back());
      if (world.boxes().size() > boxes) world.remove_box(world.boxes().back());
      CHECK(course_of(world) == course_of(untouched));
      return n - 1;
    }
    REQUIRE(world.robots().size() == robots);
    REQUIRE(world.boxes().size() == boxes);
  }
}

}  // namespace

TEST_CASE("A robot for which there is no memory is not in the world", "[hostile]") {
  CHECK(fail_each_call([](World& world) {
          world.add_robot(kKenaf, "second", {{3, 0, 0}, Eigen::Quaterniond::Identity()});
        }) > 50);
}

TEST_CASE("Instruments for which there is no memory are not on the robot", "[hostile]") {
  CHECK(fail_each_call([](World& world) { world.add_instruments(world.robots().front(), kKenaf); }) > 5);
}

TEST_CASE("A box for which there is no memory is not in the world", "[hostile]") {
  CHECK(fail_each_call([](World& world) {
          Box box;
          box.mass_kg = 1;
          box.size_m = {0.3, 0.3, 0.3};
          box.X_WBox.p = {5, 0, 2};
          world.add_box(box);
        }) > 5);
}

TEST_CASE("A reset for which there is no memory has not begun", "[hostile]") {
  CHECK(fail_each_call([](World& world) { world.reset(); }) > 100);
}

TEST_CASE("A step in which memory is out leaves a world that can be stepped on", "[hostile]") {
  World world = with_robot();
  long n = 1;
  for (bool failed = true; failed; ++n) {
    world.reset();
    test::fail_heap_call(n);
    try {
      for (int i = 0; i < 3; ++i) world.step();  // the first ones make contacts
    } catch (const std::bad_alloc&) {
    }
    failed = test::heap_call_failed();
    test::fail_heap_call(0);
    INFO("call " << n);
    for (int i = 0; i < 3; ++i) world.step();
    REQUIRE(world.truth(world.robots().front()).X_WB.p.allFinite());
  }
}

}  // namespace kenaf::physics
