// Pictures are checked against geometry: edges, occlusion, shadows, the lugs of a running belt and the robot's own hull
// lie where projection by hand puts them. A ray through every pixel is the reference for the faster rendering by cells,
// and a scene built anew is the reference for one that has followed changes. Ground that is far away keeps its colour
// while the camera moves.
#include <catch2/catch.hpp>
#include <numbers>

#include "tests/camera/scenes.hpp"

using namespace kenaf::camera;
namespace physics = kenaf::physics;
using Eigen::Vector3d;
using std::numbers::pi;

namespace {

View front_view(const RobotSnapshot& robot) {
  return camera_view(robot, *find_camera(*robot.description, "Camera"), 1.05);
}

View birds_eye_view(const RobotSnapshot& robot) {
  return camera_view(robot, *find_camera(*robot.description, "BirdsEye"), 1.4);
}

// The first row from above that is as dark as anything in the column: of a box only the 12 mm of its front face below
// its upper edge are; on its top, in full light, they are half as bright again, and the sky is bright.
int upper_edge_row(const Picture& picture, int column) {
  double darkest = 255;
  for (int row = 0; row < picture.height; ++row) darkest = std::min(darkest, brightness(picture, column, row));
  int row = 0;
  while (brightness(picture, column, row) > 1.15 * darkest) ++row;
  return row;
}

}  // namespace

TEST_CASE("The upper edge of a step is within 2 pixels of where geometry projects it") {
  struct Place {
    const char* world;
    double height_m, x, z, pitch, yaw;
  };
  // B is 0.09 m above level ground; the platforms' faces are at x = 1 m. Before a step of 200 mm the camera looks from
  // below its edge, before 50 and 100 mm from above.
  const auto place = GENERATE(Place{"step-200", 0.2, 0, 0.09, 0, 0}, Place{"step-200", 0.2, 0.3, 0.09, 0, 0.15},
                              Place{"step-200", 0.2, -1, 0.09, 0, -0.1}, Place{"step-200", 0.2, 0.3, 0.15, -0.2, 0},
                              Place{"step-100", 0.1, 0.2, 0.09, 0, 0.1}, Place{"step-50", 0.05, 0.2, 0.09, 0.1, 0});
  const auto world = world_of(place.world);
  WorldSnapshot snapshot = snapshot_of(world);
  snapshot.robots.push_back(kenaf_at(pose(place.x, 0, place.z, 0, place.pitch, place.yaw)));
  const View view = front_view(snapshot.robots[0]);
  const Picture picture = picture_of(world, snapshot, view);
  for (const double y : {-0.12, -0.07, 0.03, 0.13, 0.16}) {
    const Pixel edge = project(view, {1, y, place.height_m}).value();
    REQUIRE(in_picture(view.lens, edge));
    INFO(place.world << ", from x = " << place.x << ", edge at y = " << y);
    CHECK(upper_edge_row(picture, static_cast<int>(edge.u)) == Approx(edge.v).margin(2));
  }
}

TEST_CASE("A box hides what is behind it, and nothing else") {
  const auto world = level_ground();
  const View view = eye(pose(0, 0, 0.3));
  WorldSnapshot snapshot;
  snapshot.boxes = {box_at(1, {0.4, 1, 0.6}, pose(2, 0, 0.3), true)};
  const Picture alone = picture_of(world, snapshot, view);
  // behind, smaller, with its shadow away from the camera: not a pixel changes
  snapshot.boxes.push_back(box_at(2, {0.2, 0.2, 0.2}, pose(2.5, 0, 0.1), false));
  CHECK(picture_of(world, snapshot, view).rgb == alone.rgb);
  snapshot.boxes[1].X_WBox = pose(1.5, 0, 0.3);
  const Picture in_front = picture_of(world, snapshot, view);
  // its face, from u = 320 - 549 * 0.1 / 1.4 = 281 to 359, now shows; beside it the larger box still does
  CHECK(brightness(in_front, 330, 250) != brightness(alone, 330, 250));
  CHECK(brightness(in_front, 270, 180) == brightness(alone, 270, 180));
}

TEST_CASE("A shadow lies on the side away from the sun, as far as the box is high") {
  const auto world = level_ground();
  const View view = eye(pose(0, 0, 4, 0, pi / 2));  // from above
  Scene scene(world, {-1, 1, 2});  // sun behind to the left: a shadow of 0.4 m goes 0.2 m ahead and 0.2 m to the right
  const Picture without = picture_of(scene, view);
  WorldSnapshot snapshot;
  snapshot.boxes = {box_at(1, {0.4, 0.4, 0.4}, pose(0, 0, 0.2), true)};
  scene.update(snapshot);
  const Picture with = picture_of(scene, view);
  for (const Vector3d& p : {Vector3d(0.37, -0.1, 0), Vector3d(0.1, -0.37, 0), Vector3d(0.38, -0.38, 0)})
    CHECK(brightness_at(with, view, p) < 0.6 * brightness_at(without, view, p));
  for (const Vector3d& p :
       {Vector3d(0.43, -0.1, 0), Vector3d(0.1, -0.43, 0), Vector3d(-0.5, 0.5, 0), Vector3d(0.37, 0.3, 0)})
    CHECK(brightness_at(with, view, p) == brightness_at(without, view, p));
}

TEST_CASE("The upper run of a belt goes forward where the track drives forward, and repeats after a lug") {
  const auto world = level_ground();
  WorldSnapshot snapshot;
  snapshot.robots.push_back(kenaf_at(pose(0, 0, 0.09)));
  const View view = eye(pose(0, 0.1, 0.6, 0, pi / 2));
  // brightness along the top of the left track, 0.13 m above the ground, a value a millimetre
  const auto profile = [&](double track_m) {
    snapshot.robots[0].track_m.fill(track_m);
    const Picture picture = picture_of(world, snapshot, view);
    std::vector<double> values;
    for (int mm = -100; mm <= 100; ++mm) values.push_back(brightness_at(picture, view, {mm * 1e-3, 0.1, 0.13}));
    return values;
  };
  const auto still = profile(0), moved = profile(0.006);
  const auto difference = [&](int shift_mm) {
    double sum = 0;
    for (int i = 20; i < 180; ++i)
      sum += std::abs(moved[static_cast<std::size_t>(i + shift_mm)] - still[static_cast<std::size_t>(i)]);
    return sum;
  };
  CHECK(difference(6) < 0.2 * difference(0));
  CHECK(difference(6) < 0.2 * difference(-6));
  // both runs of 0.45 m and two half circles of 16 chords each, 0.8577 m in all, have 29 lugs: one each 29.58 mm
  const double chords_m = 2 * 16 * 2 * 0.065 * std::sin(pi / 32);
  const auto lug_on = profile((2 * 0.45 + chords_m) / std::round((2 * 0.45 + chords_m) / 0.03));
  double largest = 0;
  for (std::size_t i = 0; i < still.size(); ++i) largest = std::max(largest, std::abs(lug_on[i] - still[i]));
  CHECK(largest <= 2);
}

TEST_CASE("Looking ahead the front camera sees nothing of its robot, tilted down, its hull") {
  const auto world = level_ground();
  WorldSnapshot snapshot;
  const RobotSnapshot robot = kenaf_at(pose(0, 0, 0.09));
  const View ahead = front_view(robot);
  Scene scene(world, {0, 0, 1});  // no shadow ahead
  scene.update(snapshot);
  const Picture nobody = picture_of(scene, ahead);
  snapshot.robots.push_back(robot);
  scene.update(snapshot);
  CHECK(picture_of(scene, ahead).rgb == nobody.rgb);
  // 10 mm above the hull's top and 20 mm behind its end: straight down there is yellow
  snapshot.robots[0].mission_link_rad[0] = {0, 1.2};
  const Picture down = picture_of(scene, front_view(snapshot.robots[0]));
  const std::uint8_t* rgb = down.at(320, 400);
  CHECK(rgb[0] > 2 * rgb[2]);
}

TEST_CASE("Only the flippers that a robot has are in a picture") {
  const auto world = level_ground();
  const auto shown = [&](const RobotSnapshot& placed) {
    WorldSnapshot snapshot;
    snapshot.robots.push_back(placed);
    // from the robot's right, where a front and a rear flipper are seen
    return picture_of(world, snapshot, eye(pose(0, -2, 0.3, 0, 0, 1.5708))).rgb;
  };
  RobotSnapshot placed = kenaf_at(pose(0, 0, 0.09));
  RobotSnapshot turned = placed;
  turned.flipper_rad[kenaf::robot::kRearLeft] = turned.flipper_rad[kenaf::robot::kRearRight] = 0;
  CHECK(shown(placed) != shown(turned));

  // where there is no rear pair, no angle of it shows
  auto front = std::make_shared<physics::RobotDescription>(*placed.description);
  front->flipper_pairs = {.front = true, .rear = false};
  placed.description = turned.description = front;
  CHECK(shown(placed) == shown(turned));
  turned.flipper_rad[kenaf::robot::kFrontLeft] = 0;
  CHECK(shown(placed) != shown(turned));
}

TEST_CASE("The picture is that of a ray through each pixel, but for a few") {
  const auto [name, limit] =
      GENERATE(table<const char*, double>({{"step-200", 0.0005}, {"step-field", 0.001}, {"hills", 0.002}}));
  const auto world = world_of(name);
  WorldSnapshot snapshot = snapshot_of(world);
  snapshot.robots.push_back(kenaf_at(pose(0, 0, 0.09)));
  Scene scene(world);
  scene.update(snapshot);
  for (const View& view : {front_view(snapshot.robots[0]), birds_eye_view(snapshot.robots[0])}) {
    const double share = differing_share(picture_of(scene, view), picture_of(scene, view, true), 8);
    INFO(name << ": " << 100 * share << " %");
    CHECK(share < limit);
  }
}

TEST_CASE("What is smaller than a cell is not missed, wherever in a cell it is") {
  const auto world = level_ground();
  WorldSnapshot snapshot;
  for (int i = 0; i < 9; ++i)  // 12 to 44 m away, 1.2 to 5 pixels wide
    snapshot.boxes.push_back(
        box_at(static_cast<std::uint32_t>(i), {0.1, 0.1, 0.1}, pose(12 + 4 * i, i - 4.3, 0.05), i % 2 == 0));
  Scene scene(world);
  scene.update(snapshot);
  const View view = eye(pose(0, 0, 0.3));
  CHECK(differing_share(picture_of(scene, view), picture_of(scene, view, true), 8) == 0);
  CHECK(differing_share(picture_of(scene, view), picture_of(world, {}, view), 8) > 0);
}

TEST_CASE("A speck that is hardly ahead of the camera's plane and far to the side changes nothing") {
  const auto world = level_ground();
  const View view = eye(pose(0, 0, 0.3));
  // 549 * 4e6 / 0.02 = 1e11 pixels to the right, 24 pixels wide
  WorldSnapshot snapshot;
  snapshot.boxes.push_back(box_at(1, {0.0005, 0.0005, 0.0005}, pose(0.02, -4e6, 0.3), false));
  CHECK(picture_of(world, snapshot, view).rgb == picture_of(world, {}, view).rgb);
}

TEST_CASE("Far ground keeps its colour when the camera moves, near ground shows it") {
  const Scene scene(level_ground());
  const Picture a = picture_of(scene, eye(pose(0, 0, 0.18))), b = picture_of(scene, eye(pose(0.25, 0.25, 0.18)));
  // the horizon is row 240; 549 * 0.18 / 5 = 20 rows below it the ground is 5 m away
  const auto largest = [&](int first_row, int last_row) {
    double most = 0;
    for (int row = first_row; row <= last_row; ++row)
      for (int column = 0; column < 640; ++column)
        most = std::max(most, std::abs(brightness(a, column, row) - brightness(b, column, row)));
    return most;
  };
  CHECK(largest(240, 242) < 3);
  CHECK(largest(300, 479) > 30);
}

TEST_CASE("A scene that has followed changes shows the same as a new one") {
  const auto world = world_of("step-200");
  WorldSnapshot first = snapshot_of(world), last = first;
  first.boxes.push_back(box_at(7, {0.2, 0.2, 0.2}, pose(0.7, 0.1, 0.1), false));
  first.robots.push_back(kenaf_at(pose(0.5, -0.3, 0.09)));
  last.boxes[0].X_WBox.p.x() += 0.2;  // the platform is moved
  last.boxes.push_back(box_at(8, {0.1, 0.3, 0.2}, pose(0.8, -0.1, 0.1), false));
  last.robots = {kenaf_at(pose(0.4, 0.3, 0.09, 0, 0, 0.4), 0.2), kenaf_at(pose(-2, 0, 0.09))};
  last.robots[1].id = physics::RobotId{2};
  const View view = eye(pose(-0.5, 0, 0.4, 0, 0.2));
  Scene scene(world);
  for (const WorldSnapshot* snapshot : {&first, &last, &first, &last}) scene.update(*snapshot);
  CHECK(picture_of(scene, view).rgb == picture_of(world, last, view).rgb);
  scene.update(snapshot_of(world));
  CHECK(picture_of(scene, view).rgb == picture_of(world, snapshot_of(world), view).rgb);
  CHECK_THROWS_AS(Scene(world, {1, 0, 0}), std::invalid_argument);
}
