// Masses that are moved, added and taken apart, against textbook bodies.
#include "tools/describe/mass_properties.hpp"

#include <catch2/catch.hpp>
#include <numbers>

using namespace kenaf;
using namespace kenaf::describe;
using Eigen::Matrix3d;
using Eigen::Vector3d;

TEST_CASE("Two halves of a box are the box") {
  // 2 kg of 0.6 x 0.2 x 0.1 m: m (y^2 + z^2) / 12 and so on. Each half is 1 kg, 0.3 m long, its centre 0.15 m away.
  const auto box = [](double m, double x, double y, double z) {
    return Matrix3d(Vector3d(y * y + z * z, x * x + z * z, x * x + y * y).asDiagonal() * (m / 12));
  };
  const MassProperties front{1, {0.15, 0, 0}, box(1, 0.3, 0.2, 0.1)}, rear{1, {-0.15, 0, 0}, box(1, 0.3, 0.2, 0.1)};
  const MassProperties whole = sum(front, rear);
  CHECK(whole.mass_kg == 2);
  CHECK(whole.p_ACm_m.norm() < 1e-15);
  CHECK((whole.inertia_kgm2 - box(2, 0.6, 0.2, 0.1)).norm() < 1e-15);
  const MassProperties left_over = difference(whole, rear);
  CHECK((left_over.p_ACm_m - front.p_ACm_m).norm() < 1e-15);
  CHECK((left_over.inertia_kgm2 - front.inertia_kgm2).norm() < 1e-15);
}

TEST_CASE("A quarter turn about z swaps the moments about x and y, and turns the centre") {
  const MassProperties body{3, {0.1, 0, 0}, Vector3d(1, 2, 2.5).asDiagonal()};
  const physics::Pose X_AB{{0, 0, 0.5}, physics::rotation_from({0, 0, std::numbers::pi / 2})};
  const MassProperties turned = moved(body, X_AB);
  CHECK((turned.p_ACm_m - Vector3d(0, 0.1, 0.5)).norm() < 1e-15);
  CHECK((turned.inertia_kgm2 - Matrix3d(Vector3d(2, 1, 2.5).asDiagonal())).norm() < 1e-14);
}

TEST_CASE("The moment about an axle beside the centre has m d^2 more") {
  const MassProperties wheel{2, {0, 0.3, 0.1}, cylinder_inertia(2, 0.1, 0.05)};
  CHECK(moment_about(wheel, {0, 0, 0.1}, Vector3d::UnitY()) == Approx(2 * 0.01 / 2));  // m r^2 / 2
  CHECK(moment_about(wheel, {0, 0, 0}, Vector3d::UnitY()) == Approx(0.01 + 2 * 0.01));
}

TEST_CASE("Moments that no rigid body has are told apart from those of a rod and a plate") {
  CHECK(inertia_fault(Vector3d(1, 1, 1).asDiagonal()).empty());
  CHECK(inertia_fault(Vector3d(1e-6, 1, 1).asDiagonal()).empty());  // nearly a rod
  CHECK(inertia_fault(Vector3d(1, 1, 2).asDiagonal()).empty());     // a plate: z is the sum of the others
  CHECK_THAT(inertia_fault(Vector3d(1, 1, 2.1).asDiagonal()),
             Catch::Contains("1, 1 and 2.1") && Catch::Contains("sum"));
  CHECK_THAT(inertia_fault(Vector3d(1, 1, 0).asDiagonal()), Catch::Contains("0 or less"));
  Matrix3d products = Matrix3d::Identity();
  products(0, 1) = products(1, 0) = 1.5;  // principal moments 1 - 1.5, 1, 1 + 1.5
  CHECK_THAT(inertia_fault(products), Catch::Contains("-0.5"));
}
