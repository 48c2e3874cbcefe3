// Scanned distances equal those worked out by hand for a flat wall and for level ground, and those of the physics' own
// rays in uneven worlds. A scanner looks through the robot that it is told to ignore.
#include <catch2/catch.hpp>
#include <numbers>

#include "camera/range_scan.hpp"
#include "tests/camera/scenes.hpp"

using namespace kenaf::camera;
namespace physics = kenaf::physics;
using std::numbers::pi;

namespace {

std::vector<double> scan_of(const Scene& scene, const RangeScan& request) {
  std::vector<double> out;
  RangeScanner().scan(scene, request, out);
  return out;
}

}  // namespace

TEST_CASE("A wall at 1 m is 1 / cos of the angle away, from the left to the right, beyond the range is nothing") {
  // the step of 200 mm has its face at x = 1 m, 2 m wide
  const auto world = world_of("step-200");
  Scene scene(world);
  scene.update(snapshot_of(world));
  const auto distance = scan_of(scene, {pose(0, 0.3, 0.1), pi / 2, 91, 1.35, std::nullopt});
  REQUIRE(distance.size() == 91);
  for (int degrees = -29; degrees <= 34; ++degrees)  // it ends 35 degrees to the left
    CHECK(distance[static_cast<std::size_t>(45 - degrees)] == Approx(1 / std::cos(degrees * pi / 180)).margin(2e-4));
  CHECK(std::isinf(distance[0]));                                  // to the left the wall ends at y = 1
  CHECK(distance[90] == std::numeric_limits<double>::infinity());  // to the right it is 1.41 m away, beyond the range
  // pitched down, the ground is 0.1 / sin(30 degrees) away
  CHECK(scan_of(scene, {pose(0, 0, 0.1, 0, pi / 6), 1, 1, 10, std::nullopt})[0] == Approx(0.2).margin(1e-5));
}

TEST_CASE("In a step field and on hills the rays end where the physics' rays end") {
  for (const char* name : {"step-field", "hills"}) {
    physics::World world(world_of(name), {}, 1);
    WorldSnapshot snapshot;
    SnapshotTaker().take(world, snapshot);
    Scene scene(world.description());
    scene.update(snapshot);
    const RangeScan request{pose(0.8, 0.1, 0.12, 0, 0.03, 0), pi, 181, 6, std::nullopt};
    const auto distance = scan_of(scene, request);
    int hits = 0;
    for (std::size_t i = 0; i < distance.size(); ++i) {
      const double angle = pi / 2 - static_cast<double>(i) * pi / 180;
      const auto hit =
          world.cast_ray(request.X_WS.p, request.X_WS.q * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0), 6);
      INFO(name << ", ray " << i);
      REQUIRE(hit.has_value() == std::isfinite(distance[i]));
      if (!hit) continue;
      ++hits;
      CHECK(distance[i] == Approx(hit->distance_m).margin(1e-3));
    }
    CHECK(hits > 60);
  }
}

TEST_CASE("A ray passes through the robot that it is to ignore, and meets what is behind") {
  const auto world = world_of("step-200");
  WorldSnapshot snapshot = snapshot_of(world);
  snapshot.robots.push_back(kenaf_at(pose(0, 0, 0.09)));
  Scene scene(world);
  scene.update(snapshot);
  RangeScan request{pose(-1, 0.1, 0.065), 1, 1, 10, std::nullopt};
  // the left track's rear end: 0.29 m behind B at the height of its axis
  CHECK(scan_of(scene, request)[0] == Approx(0.71).margin(1e-3));
  request.ignored = snapshot.robots[0].id;
  CHECK(scan_of(scene, request)[0] == Approx(2).margin(1e-4));
}
