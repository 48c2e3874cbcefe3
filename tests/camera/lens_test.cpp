// The lens model projects points to the pixels that trigonometry gives: the axis to the middle, y to the left, z
// upward, and 45 degrees to the edge of a field of view of 90 degrees. Projection and ray undo each other, and points
// behind the camera have no pixel.
#include <catch2/catch.hpp>
#include <numbers>

#include "tests/camera/scenes.hpp"

using namespace kenaf::camera;
using std::numbers::pi;

TEST_CASE("Ahead is the middle, left is left, above is above") {
  const View view = eye(pose(1, 2, 3));
  const auto middle = project(view, {6, 2, 3});
  CHECK(middle->u == Approx(320));
  CHECK(middle->v == Approx(240));
  CHECK(project(view, {6, 2.1, 3})->u < 320);  // y to the left
  CHECK(project(view, {6, 2.1, 3})->v == Approx(240));
  CHECK(project(view, {6, 2, 3.1})->v < 240);
  CHECK(project(view, {6, 2, 3.1})->u == Approx(320));
  // who looks to the left, along y, has what was ahead on his right
  CHECK(project(eye(pose(1, 2, 3, 0, 0, pi / 4)), {6, 2, 3})->u > 320);
  CHECK(project(eye(pose(1, 2, 3, 0, 0.1, 0)), {6, 2, 3})->v < 240);  // nose down: what was ahead is above
}

TEST_CASE("A field of view of 90 degrees ends at 45 degrees, and a pixel is as high as wide") {
  const View view{{640, 480, pi / 2}, {}};
  CHECK(focal_length_px(view.lens) == Approx(320));
  CHECK(project(view, {1, 1, 0})->u == Approx(0).margin(1e-9));
  CHECK(project(view, {1, -1, 0})->u == Approx(640));
  CHECK(project(view, {2, 0, 1})->v == Approx(240 - 160));
  CHECK(in_picture(view.lens, {0, 479.9}));
  CHECK_FALSE(in_picture(view.lens, {-0.1, 100}));
  CHECK_FALSE(in_picture(view.lens, {100, 480}));
}

TEST_CASE("Half of the pixels show the same, at half of the distances from the middle") {
  const View full{{640, 480, pi / 2}, {}}, half{half_size(full.lens), {}};
  CHECK(half.lens.width == 320);
  CHECK(half.lens.height == 240);
  CHECK(half.lens.field_of_view_rad == Approx(pi / 2));
  const Eigen::Vector3d p_W(2, 0.5, -0.25);
  CHECK(project(half, p_W)->u - 160 == Approx((project(full, p_W)->u - 320) / 2));
  CHECK(project(half, p_W)->v - 120 == Approx((project(full, p_W)->v - 240) / 2));
  // 5 pixels of focal length 5 / 2: three of 5 / 4 are a field of view of 2 atan(1.5 / 1.25)
  const Lens odd = half_size({5, 1, pi / 2});
  CHECK(odd.width == 3);
  CHECK(odd.height == 1);
  CHECK(odd.field_of_view_rad == Approx(2 * std::atan(1.2)));
}

TEST_CASE("A point on a pixel's ray is projected onto the pixel") {
  const View view{{320, 200, 1.3}, pose(-3, 1, 0.4, 0.3, -0.5, 2.1)};
  for (const double depth : {0.01, 1.0, 300.0}) {
    for (const Pixel pixel : {Pixel{0.5, 0.5}, {160, 100}, {319.5, 12.25}, {-40, 260}}) {
      const Eigen::Vector3d along = ray(view, pixel);
      CHECK((view.X_WC.q.conjugate() * along).x() == Approx(1));  // so that `depth` is depth
      const auto back = project(view, view.X_WC.p + depth * along);
      REQUIRE(back);
      CHECK(back->u == Approx(pixel.u).margin(1e-6));
      CHECK(back->v == Approx(pixel.v).margin(1e-6));
    }
  }
}

TEST_CASE("What is behind the camera or beside it has no picture") {
  const View view = eye(pose(0, 0, 1));
  CHECK_FALSE(project(view, {-1, 0, 1}));
  CHECK_FALSE(project(view, {0, 3, 1}));
  CHECK(project(view, {1e-6, 0, 1}));
}
