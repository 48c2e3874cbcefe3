// The worlds that ship are what their names say, and standard_worlds.hpp makes the same ones.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "physics/standard_worlds.hpp"
#include "physics/triangle_surface.hpp"
#include "tests/physics/scenes.hpp"

using namespace kenaf::physics;

namespace {

WorldDescription shipped(const std::string& name) {
  std::vector<std::string> unsupported;
  WorldDescription world = load_world(name, unsupported);
  CHECK(unsupported.empty());
  return world;
}

// How high the ground is at (x, y).
double ground_at(const World& world, double x, double y = 0) {
  const auto hit = world.cast_ray({x, y, 5}, {0, 0, -1}, 10);
  return hit ? 5 - hit->distance_m : -5;
}

void check_same(const WorldDescription& a, const WorldDescription& b) {
  const auto same_pose = [](const Pose& p, const Pose& q) {
    return (p.p - q.p).norm() < 1e-12 && p.q.angularDistance(q.q) < 1e-12;
  };
  CHECK(a.name == b.name);
  CHECK(a.gravity_W_mps2 == b.gravity_W_mps2);
  CHECK(a.meshes.empty());
  CHECK(b.meshes.empty());
  REQUIRE(a.planes.size() == b.planes.size());
  for (std::size_t i = 0; i < a.planes.size(); ++i) {
    CHECK(same_pose(a.planes[i].X_WP, b.planes[i].X_WP));
    CHECK(a.planes[i].friction == b.planes[i].friction);
  }
  REQUIRE(a.boxes.size() == b.boxes.size());
  for (std::size_t i = 0; i < a.boxes.size(); ++i) {
    CHECK(a.boxes[i].name == b.boxes[i].name);
    CHECK(a.boxes[i].size_m.isApprox(b.boxes[i].size_m, 1e-12));
    CHECK(same_pose(a.boxes[i].X_WBox, b.boxes[i].X_WBox));
    CHECK(a.boxes[i].friction == b.boxes[i].friction);
    CHECK(a.boxes[i].mass_kg == b.boxes[i].mass_kg);
  }
  REQUIRE(a.start_poses.size() == b.start_poses.size());
  for (std::size_t i = 0; i < a.start_poses.size(); ++i) {
    CHECK(a.start_poses[i].name == b.start_poses[i].name);
    CHECK(same_pose(a.start_poses[i].X_WB, b.start_poses[i].X_WB));
  }
}

}  // namespace

TEST_CASE("All shipped worlds load completely, under their file's name, with a start at the origin") {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(KENAF_SOURCE_DIR "/share/worlds")) {
    if (entry.path().extension() != ".sdf") continue;
    const WorldDescription world = shipped(entry.path().stem());
    INFO(entry.path());
    CHECK(world.name == entry.path().stem());
    CHECK(world.planes.size() == 1);
    CHECK(world.start_poses.at(0).name == "start_00");
    CHECK(world.start_poses[0].X_WB.p.norm() == 0);
    ++count;
  }
  CHECK(count >= 25);
}

TEST_CASE("A step is as high as its name says and begins at x = 1 m") {
  for (int height_mm = 50; height_mm <= 350; height_mm += 50) {
    const World world(shipped("step-" + std::to_string(height_mm)), {}, 1);
    CHECK(ground_at(world, 0.999) == Approx(0).margin(1e-9));
    CHECK(ground_at(world, 1.001) == Approx(height_mm * 1e-3));
    CHECK(ground_at(world, 3.999, 0.999) == Approx(height_mm * 1e-3));
    CHECK(ground_at(world, 4.001) == Approx(0).margin(1e-9));
  }
}

TEST_CASE("A trench is as wide as its name says, 1 m deep, and begins at x = 1 m") {
  for (int width_mm = 100; width_mm <= 400; width_mm += 50) {
    const World world(shipped("trench-" + std::to_string(width_mm)), {}, 1);
    const double far_m = 1 + width_mm * 1e-3;
    CHECK(ground_at(world, 0) == Approx(0).margin(1e-9));
    CHECK(ground_at(world, 0.999) == Approx(0).margin(1e-9));
    CHECK(ground_at(world, 1.001) == Approx(-1));
    CHECK(ground_at(world, far_m - 0.001) == Approx(-1));
    CHECK(ground_at(world, far_m + 0.001, 1.999) == Approx(0).margin(1e-9));
  }
}

TEST_CASE("Steps and trenches of any measure are those that ship") {
  check_same(step_world(0.05), shipped("step-50"));
  check_same(step_world(0.2), shipped("step-200"));
  check_same(step_world(0.35), shipped("step-350"));
  check_same(trench_world(0.1), shipped("trench-100"));
  check_same(trench_world(0.35), shipped("trench-350"));
  CHECK(step_world(0.2135).name == "step-213.5");
  CHECK_THROWS_AS(step_world(0), std::invalid_argument);
  CHECK_THROWS_AS(trench_world(std::nan("")), std::invalid_argument);
}

TEST_CASE("The stairs are 12 steps of 75 mm by 175 mm") {
  const World world(shipped("stairs"), {}, 1);
  for (int i = 0; i < 12; ++i) {
    CHECK(ground_at(world, 1 + 0.175 * i + 0.001) == Approx(0.075 * (i + 1)));
    CHECK(ground_at(world, 1 + 0.175 * (i + 1) - 0.001) == Approx(0.075 * (i + 1)));
  }
  CHECK(ground_at(world, 1 + 0.175 * 11 + 1.999) == Approx(0.9));
}

TEST_CASE("A ramp rises from the ground at x = 1 m by its angle, to a plateau of 0.5 m") {
  for (const int degrees : {10, 20, 30}) {
    const World world(shipped("ramp-" + std::to_string(degrees)), {}, 1);
    const double slope = std::tan(degrees * std::numbers::pi / 180);
    CHECK(ground_at(world, 0.999) == Approx(0).margin(1e-6));
    CHECK(ground_at(world, 1.1) == Approx(0.1 * slope).margin(1e-6));
    CHECK(ground_at(world, 1 + 0.499 / slope) == Approx(0.499).margin(1e-6));
    CHECK(ground_at(world, 1 + 0.501 / slope) == Approx(0.5).margin(1e-6));
    CHECK(ground_at(world, 1 + 0.5 / slope + 2.999) == Approx(0.5).margin(1e-6));
  }
}

TEST_CASE("The step field is 36 x 12 posts of 100 mm, in multiples of 50 mm up to 200 mm") {
  const World world(shipped("step-field"), {}, 1);
  std::array<int, 5> posts_of{};
  for (int i = 0; i < 36; ++i) {
    for (int j = 0; j < 12; ++j) {
      const double x = 1.05 + 0.1 * i, y = -0.55 + 0.1 * j;
      const double levels = ground_at(world, x, y) / 0.05;
      const long level = std::lround(levels);
      CHECK(levels == Approx(static_cast<double>(level)));
      REQUIRE((level >= 1 && level <= 4));
      ++posts_of[static_cast<std::size_t>(level)];
      CHECK(ground_at(world, x + 0.049, y - 0.049) == Approx(0.05 * levels));
    }
  }
  for (std::size_t level = 1; level <= 4; ++level) CHECK(posts_of[level] > 20);  // none is rare
}

TEST_CASE("The tilted box has its edge at x = 1 m, 0.154 m up, and falls away behind it") {
  const World world(shipped("tilted-box"), {}, 1);
  CHECK(ground_at(world, 0.95) == Approx(0).margin(1e-9));
  CHECK(ground_at(world, 1.0005) == Approx(0.154).margin(1e-3));
  // 1.7821 rad - 90 degrees = 12.1 degrees
  CHECK(ground_at(world, 1.3) == Approx(0.1538 - 0.3 * std::tan(0.2113)).margin(1e-3));
}

TEST_CASE("The half cylinder is a circle of 150 mm about x = 1.15 m") {
  const World world(shipped("half-cylinder"), {}, 1);
  for (const double x : {1.02, 1.07, 1.15, 1.2, 1.28})
    CHECK(ground_at(world, x) == Approx(std::sqrt(0.15 * 0.15 - (x - 1.15) * (x - 1.15))).margin(3e-3));
  CHECK(ground_at(world, 1.15, 0.999) == Approx(0.15).margin(1e-3));
  CHECK(ground_at(world, 1.15, 1.001) == Approx(0).margin(1e-9));
}

TEST_CASE("The hills are up to 0.2 m high on 8 m by 8 m, and join the ground around them") {
  const WorldDescription description = shipped("hills");
  REQUIRE(description.meshes.size() == 1);
  double highest = 0;
  for (const Eigen::Vector3d& p : description.meshes[0].vertices_W) {
    const bool rim = p.x() < 1.001 || p.x() > 8.999 || std::abs(p.y()) > 3.999;
    if (rim) CHECK(p.z() == Approx(0).margin(1e-9));
    highest = std::max(highest, p.z());
  }
  CHECK(highest == Approx(0.2));
  CHECK(description.meshes[0].vertices_W.size() == 129 * 129);
}

TEST_CASE("The rubble is a closed body, up to 0.15 m high on 4 m by 3 m") {
  const WorldDescription description = shipped("rubble-mesh");
  REQUIRE(description.meshes.size() == 1);
  TriangleSurface surface{description.meshes[0].vertices_W, description.meshes[0].triangles};
  const TidySurface tidied = tidy(surface);
  CHECK(tidied.closed);
  CHECK(tidied.dropped == 0);
  // 0.1 m below the ground on 12 m^2, and something above it
  CHECK(volume_m3(surface) > 1.2);
  CHECK(volume_m3(surface) < 1.2 + 0.15 * 12);
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& p : surface.vertices) bounds.extend(p);
  CHECK((bounds.min() - Eigen::Vector3d(1, -1.5, -0.1)).norm() < 1e-6);
  CHECK(bounds.max().x() == Approx(5));
  CHECK(bounds.max().z() == Approx(0.15).margin(0.01));
}
