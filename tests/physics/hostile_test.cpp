#include <catch2/catch.hpp>

#include "physics/world.hpp"

namespace kenaf::physics {

namespace {

World flat() {
  std::vector<std::string> unsupported;
  return World(load_world("flat", unsupported), {}, 1);
}

Box cube(double side_m, const Eigen::Vector3d& p_W, double mass_kg) {
  Box box;
  box.size_m = Eigen::Vector3d::Constant(side_m);
  box.mass_kg = mass_kg;
  box.X_WBox.p = p_W;
  return box;
}

}  // namespace

TEST_CASE("Boxes beyond the most pairs meet the ground alone, and none falls through it", "[hostile]") {
  World world = flat();
  constexpr std::size_t kBoxes = 300;  // 300 * 299 / 2 = 44850 pairs, if all were made
  for (std::size_t i = 0; i < kBoxes; ++i) world.add_box(cube(0.2, {0, 0, 0.5}, 1));
  CHECK(world.pairs_left_out() > 0);
  for (int i = 0; i < 20; ++i) {
    world.step();
    REQUIRE(world.pair_count() <= kMostPairs + kBoxes);  // and one each with the ground
  }
}

TEST_CASE("A thousand small boxes in a heap have too many neighbours, and none of them falls through the ground",
          "[hostile]") {
  // Cubes of 1 cm, 2 cm apart, fall onto each other: Bullet takes boxes within some centimetres for near.
  World world = flat();
  for (int i = 0; i < 1000; ++i) {
    const int column = i % 10, row = i / 10 % 10, layer = i / 100;
    world.add_box(cube(0.01, {0.02 * column, 0.02 * row, 0.006 + 0.02 * layer}, 0.1));
  }
  for (int i = 0; i < 150; ++i) world.step();
  CHECK(world.pairs_left_out() > 0);
  for (const BoxId id : world.boxes()) {
    REQUIRE(world.box_pose(id).p.allFinite());
    REQUIRE(world.box_pose(id).p.z() > 0.003);  // lying on the ground: 0.005
  }
}

TEST_CASE("The boxes that would overlap one are counted at their present and at their initial places", "[hostile]") {
  World world = flat();
  const BoxId first = world.add_box(cube(1, {0, 0, 0.5}, 1));
  world.add_box(cube(1, {1, 0, 0.5}, 0));  // touches the first, face to face
  const auto at = [&](double x, std::optional<BoxId> except = std::nullopt) {
    return world.overlapping_boxes({1, 1, 1}, {{x, 0, 0.5}, Eigen::Quaterniond::Identity()}, except);
  };
  CHECK(at(0) == 1);
  CHECK(at(0.5) == 2);
  CHECK(at(0.5, first) == 1);
  CHECK(at(5) == 0);
  world.move_box(first, {{5, 0, 0.5}, Eigen::Quaterniond::Identity()});
  CHECK(at(5) == 1);
  CHECK(at(0) == 1);  // a reset brings it back
  // A turned cube reaches farther: half its diagonal, 0.707 m, along x.
  const Pose turned{{2.1, 0, 0.5}, Eigen::Quaterniond(Eigen::AngleAxisd(0.785398, Eigen::Vector3d::UnitZ()))};
  CHECK(world.overlapping_boxes({1, 1, 1}, turned) == 1);
}

}  // namespace kenaf::physics
