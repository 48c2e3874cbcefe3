// Drawing a picture allocates nothing once two pictures of the same size have been drawn. This is a program of its own,
// because it counts every allocation of the process. It is not built with sanitizers, which replace the same functions.
#include <catch2/catch.hpp>

#include "tests/camera/scenes.hpp"
#include "tests/support/heap_calls.hpp"

using namespace kenaf::camera;
using kenaf::test::heap_calls;

TEST_CASE("The third picture allocates nothing") {
  const auto world = world_of("step-200");
  WorldSnapshot snapshot = snapshot_of(world);
  snapshot.robots.push_back(kenaf_at(pose(0, 0, 0.09)));
  Scene scene(world);
  scene.update(snapshot);
  const RobotSnapshot& robot = snapshot.robots[0];
  const View view = camera_view(robot, *find_camera(*robot.description, "BirdsEye"), 1.4);
  Renderer renderer;
  Picture picture;
  const long start = heap_calls();
  renderer.render(scene, view, picture);
  CHECK(heap_calls() > start);  // they are counted
  renderer.render(scene, view, picture);
  const long before = heap_calls();
  renderer.render(scene, view, picture);
  CHECK(heap_calls() == before);
}
