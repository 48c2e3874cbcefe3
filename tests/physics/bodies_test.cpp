// A block falls, slides, holds, rests and turns as mechanics predicts. The references are closed forms: the sum of
// semi-implicit Euler steps, g (sin a - mu cos a) on a slope, the friction angle, and the moments of inertia of a
// uniform box.
#include <catch2/catch.hpp>

#include "physics/dynamics/scene.hpp"
#include "tests/physics/scenes.hpp"

using namespace kenaf::physics;

namespace {

// How far a block slides down a slope of 30 degrees in `time_s`, from rest.
double slide_m(double friction, double time_s) {
  const double slope = std::numbers::pi / 6;
  World world(ground(friction, slope), {}, 1);
  const Pose X_WP{Eigen::Vector3d::Zero(), rotation_from({0, slope, 0})};
  const BoxId box =
      world.add_box(loose_box({0.2, 0.2, 0.1}, compose(X_WP, {{0, 0, 0.05}, Eigen::Quaterniond::Identity()}), 2, 1));
  run(world, time_s);
  return (inverse(X_WP).q * world.box_pose(box).p).x();
}

}  // namespace

TEST_CASE("A body falls as semi-implicit Euler integrates gravity") {
  WorldDescription empty;
  World world(empty, {}, 1);
  const BoxId box = world.add_box(loose_box({0.1, 0.1, 0.1}, {{0, 0, 100}, Eigen::Quaterniond::Identity()}, 1, 1));
  run(world, 1);
  // v after n steps is g h n, so the way is g h^2 n (n + 1) / 2
  CHECK(world.box_pose(box).p.z() == Approx(100 - kGravity * 1e-6 * 1000 * 1001 / 2).epsilon(1e-12));
}

TEST_CASE("A block slides with g (sin a - mu cos a)") {
  for (const double mu : {0.0, 0.3, 0.5}) {
    const double a = kGravity * (0.5 - mu * std::sqrt(3.0) / 2);
    // 1 %: the first millimetres while it settles
    CHECK(slide_m(mu, 1) == Approx(a / 2).epsilon(0.01));
  }
}

TEST_CASE("A block holds where mu is above the slope's tangent, 0.577, and slides below") {
  CHECK(std::abs(slide_m(0.6, 5)) < 1e-4);
  CHECK(slide_m(0.55, 2) == Approx(kGravity * (0.5 - 0.55 * std::sqrt(3.0) / 2) * 2).epsilon(0.05));
}

TEST_CASE("A block at rest on level ground stays") {
  World world(ground(), {}, 1);
  const BoxId box = world.add_box(loose_box({0.3, 0.2, 0.1}, {{1, 2, 0.05}, rotation_from({0, 0, 0.4})}, 5, 1));
  run(world, 10);
  CHECK((world.box_pose(box).p - Eigen::Vector3d(1, 2, 0.05)).norm() < 1e-4);
}

TEST_CASE("A loose box turns as a uniform box of its size does, from its first step on") {
  for (const bool turned : {false, true}) {
    Scene scene({}, {});
    const Pose X_WBox{{0, 0, 5}, rotation_from({0, 0, turned ? std::numbers::pi / 2 : 0})};
    scene.add_box(BoxId{1}, loose_box({0.1, 0.2, 0.3}, X_WBox, 12, 1));
    btRigidBody* const box = btRigidBody::upcast(scene.dynamics().getCollisionObjectArray()[0]);
    REQUIRE(box);
    // m / 12 (0.2^2 + 0.3^2), (0.1^2 + 0.3^2), (0.1^2 + 0.2^2) about its own axes
    const Eigen::Vector3d inertia_W_kgm2 =
        turned ? Eigen::Vector3d(0.10, 0.13, 0.05) : Eigen::Vector3d(0.13, 0.10, 0.05);
    for (int axis = 0; axis < 3; ++axis) {
      btVector3 impulse_nms(0, 0, 0);
      impulse_nms[axis] = 0.01;
      box->setAngularVelocity({0, 0, 0});
      box->applyTorqueImpulse(impulse_nms);
      CHECK(box->getAngularVelocity()[axis] == Approx(0.01 / inertia_W_kgm2[axis]).epsilon(1e-9));
    }
  }
}
