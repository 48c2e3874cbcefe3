// What a contact sees of an impulse follows from the equations of the base and of the arms whose servos yield,
//   [ diag(M, I)  c_j ] [ v, w   ]   [ impulse, moment ]
//   [ c_j^T       d_j ] [ rate_j ] = [ lever . impulse ]
// Here they are solved as they stand, by a dense matrix, for contacts on the base, on an arm that yields, on one that
// holds, and between two arms.
#include "physics/dynamics/contact_patch.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <memory>
#include <vector>

#include "physics/dynamics/contact_iterations.hpp"
#include "physics/dynamics/friction_creep.hpp"

using namespace kenaf::physics;

namespace {

Eigen::Vector3d to_eigen(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}

// A base of 15 kg with three arms: the first and the last yield, the one between them holds.
struct ThreeArms {
  static constexpr std::size_t kArms = 3;
  btSphereShape shape{0.1};
  btRigidBody base{btRigidBody::btRigidBodyConstructionInfo(1, nullptr, &shape, {1, 1, 1})};
  std::vector<std::unique_ptr<FlipperJoint>> joints;
  std::vector<Arm> arms{kArms};
  ArticulatedBody body{};
  Collider collider{{Surface{}}, 1};
  Surface surface;

  ThreeArms() {
    base.setUserPointer(&collider);
    body.base = &base;
    body.v = {0.3, -0.1, 0.2};
    body.w = {0.5, 0.4, -0.2};
    body.p_WC = {0.1, -0.2, 0.3};
    body.inverse_mass = 1 / 15.0;
    body.inverse_inertia_W = btMatrix3x3(0.4, 0.05, -0.02, 0.05, 0.6, 0.03, -0.02, 0.03, 0.8).inverse();
    for (std::size_t j = 0; j < kArms; ++j) {
      Arm& arm = arms[j];
      joints.push_back(std::make_unique<FlipperJoint>(base, base, btTransform::getIdentity(),
                                                      btTransform::getIdentity(), ServoCoupling{}));
      const auto k = static_cast<double>(j);
      arm.joint = joints.back().get();
      arm.body = &base;
      arm.pivot_W = body.p_WC + btVector3(0.2 - 0.3 * k, 0.15, -0.05 * k);
      arm.axis_W = btVector3(0.1 * k, -1, 0.05).normalized();
      arm.bias_v = {0.01, 0, -0.02};
      arm.bias_w = {0, 0.03, 0.01 * k};
      arm.coupling = side_by_side(btVector3(0.05, 0.01 * k, 0.12 - 0.06 * k), btVector3(0.002, -0.03, 0.004));
      arm.inertia = 0.02 + 0.01 * k;
      arm.momentum = 0.001;
      arm.joint->servo = {.target = 0.7, .low = -1e-3, .high = 1e-3};
      if (j != 1) arm.joint->servo.limit = LimitedDrive::Limit::high;
    }
    body.arms = arms;
    begin_anew(body);
  }

  // Base, then a rate for each arm.
  using Matrix = Eigen::Matrix<double, 6 + kArms, 6 + kArms>;
  using Vector = Eigen::Matrix<double, 6 + kArms, 1>;
  Vector row(const Arm* arm, const btVector3& p_W, const btVector3& direction) const {
    Vector j = Vector::Zero();
    j.head<3>() = to_eigen(direction);
    j.segment<3>(3) = to_eigen((p_W - body.p_WC).cross(direction));
    if (arm) j[6 + (arm - arms.data())] = arm->axis_W.cross(p_W - arm->pivot_W).dot(direction);
    return j;
  }
  // Velocities by generalized impulses; an arm that holds has no rate of its own.
  Vector response(Vector impulse) const {
    Matrix m = Matrix::Zero();
    m.topLeftCorner<3, 3>() = Eigen::Matrix3d::Identity() / body.inverse_mass;
    const btMatrix3x3 inertia = body.inverse_inertia_W.inverse();
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) m(3 + i, 3 + k) = inertia[i][k];
    for (std::size_t j = 0; j < kArms; ++j) {
      const auto at = static_cast<Eigen::Index>(6 + j);
      if (arms[j].mobility == 0) {
        m(at, at) = 1;
        impulse[at] = 0;
        continue;
      }
      m(at, at) = 1 / arms[j].mobility;
      const TwoVectors& c = arms[j].coupling;
      for (int lane = 0; lane < 2; ++lane) {
        const Eigen::Vector3d part = to_eigen(vector_of(c, lane));
        m.block<3, 1>(3 * lane, at) = part;
        m.block<1, 3>(at, 3 * lane) = part.transpose();
      }
    }
    return m.fullPivLu().solve(impulse);
  }
};

struct Case {
  const char* name;
  int arm_a, arm_b;  // -1: the base; -2: fixed ground
};

}  // namespace

TEST_CASE("A contact's mobility and what impulses change are those of the base and its arms") {
  for (const Case& c : {Case{"base on ground", -1, -2}, Case{"arm that yields on ground", 0, -2},
                        Case{"arm that holds on ground", 1, -2}, Case{"arm that yields against the base", 2, -1},
                        Case{"two arms that yield", 0, 2}, Case{"an arm that yields, and one that holds", 0, 1}}) {
    INFO(c.name);
    ThreeArms robot;
    const auto side = [&](int arm) {
      return arm == -2 ? ContactSide{}
                       : ContactSide{&robot.body, arm < 0 ? nullptr : &robot.arms[static_cast<std::size_t>(arm)]};
    };
    const ContactSide a = side(c.arm_a), b = side(c.arm_b);
    const Meeting meeting(robot.base, robot.base, a, b, robot.surface, robot.surface);
    const ContactPatch patch(meeting, btVector3(0.2, 0.1, 1).normalized(), false);
    const btVector3 p_W(0.35, 0.05, 0.1);
    const PlaceInPatch r = place_at(patch.in_patch(p_W - robot.body.p_WC));
    const btVector3 axes[3] = {patch.along_W, patch.across_W, patch.normal_W};
    CHECK(axes[0].cross(axes[1]).dot(axes[2]) == Approx(1));

    // J M^-1 J^T, with the row of A less that of B
    ThreeArms::Vector row[3];
    double expected[3][3];
    for (int i = 0; i < 3; ++i) {
      row[i] = robot.row(a.arm, p_W, axes[i]);
      if (b.body) row[i] -= robot.row(b.arm, p_W, axes[i]);
    }
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) expected[i][j] = row[i].dot(robot.response(row[j]));
    const MobilityAtPlace m = patch.mobility_at(r, r);
    CHECK(m.normal == Approx(expected[2][2]));
    CHECK(m.tangents[0] == Approx(expected[0][0]));
    CHECK(m.tangents[1] == Approx(expected[1][1]));
    CHECK(m.along_by_across == Approx(expected[0][1]).margin(1e-9));
    CHECK(m.tangents_by_normal[0] == Approx(expected[0][2]).margin(1e-9));
    CHECK(m.tangents_by_normal[1] == Approx(expected[1][2]).margin(1e-9));

    // an impulse, given to the bodies, changes what the contact sees by the same
    const double normal = 0.7;
    const Two friction{0.2, -0.4};
    const InPatch impulse = impulse_at(r, normal, friction);
    patch.give(patch.a, impulse);
    if (b.body) patch.give(patch.b, impulse * -1);
    const ThreeArms::Vector moved = robot.response(friction[0] * row[0] + friction[1] * row[1] + normal * row[2]);
    const InPatch seen = b.body ? patch.seen(patch.a) - patch.seen(patch.b) : patch.seen(patch.a);
    CHECK(normal_velocity(seen, r) == Approx(row[2].dot(moved)));
    CHECK(tangential_velocity(seen, r)[0] == Approx(row[0].dot(moved)).margin(1e-12));
    CHECK(tangential_velocity(seen, r)[1] == Approx(row[1].dot(moved)).margin(1e-12));

    // on the ground, the change is known without the bodies
    if (!b.body) {
      const InPatch change = patch.a.change_by(impulse);
      CHECK(normal_velocity(change, r) == Approx(normal_velocity(seen, r)));
      CHECK(tangential_velocity(change, r)[0] == Approx(tangential_velocity(seen, r)[0]).margin(1e-12));
      CHECK(tangential_velocity(change, r)[1] == Approx(tangential_velocity(seen, r)[1]).margin(1e-12));
    }

    // without contacts: the base's motion, and the arm's about its pivot
    btVector3 v_W = robot.body.v + robot.body.w.cross(p_W - robot.body.p_WC);
    if (const Arm* arm = a.arm) v_W += arm->bias_v + (arm->bias_w + arm->axis_W * arm->rate).cross(p_W - arm->pivot_W);
    CHECK(normal_velocity(patch.a.free_motion, r) == Approx(v_W.dot(axes[2])));
    CHECK(tangential_velocity(patch.a.free_motion, r)[0] == Approx(v_W.dot(axes[0])));
    CHECK(tangential_velocity(patch.a.free_motion, r)[1] == Approx(v_W.dot(axes[1])));
  }
}

TEST_CASE("Two arms that hold against each other have a finite, small mobility") {
  ThreeArms robot;
  for (Arm& arm : robot.arms) arm.joint->servo.limit = LimitedDrive::Limit::none;
  begin_anew(robot.body);
  const Meeting meeting(robot.base, robot.base, {&robot.body, &robot.arms[0]}, {&robot.body, &robot.arms[1]},
                        robot.surface, robot.surface);
  const ContactPatch patch(meeting, {0, 0, 1}, false);
  const PlaceInPatch r = place_at({0.1, 0.1, -0.1});
  const MobilityAtPlace m = patch.mobility_at(r, r);
  CHECK(m.normal > 0);
  CHECK(m.normal < 1e-6);
  CHECK(m.tangents[0] * m.tangents[1] - m.along_by_across * m.along_by_across > 0);
}

TEST_CASE("The springs of a patch are the sum of p J^T J of its contacts") {
  const PlaceInPatch places[] = {{Two{0.1, 0.3}, -0.2}, {Two{-0.2, 0.25}, -0.1}, {Two{0.05, -0.3}, -0.15}};
  const double pressing[] = {1.0, 0.5, 2.0};
  SpringsInPatch springs;
  Eigen::Matrix<double, 6, 6> expected = Eigen::Matrix<double, 6, 6>::Zero();
  for (int i = 0; i < 3; ++i) {
    springs.add(places[i], pressing[i]);
    const double along = places[i].turned[1], across = -places[i].turned[0], height = places[i].height;
    Eigen::Matrix<double, 2, 6> rows;
    rows << 1, 0, 0, 0, height, -across,  // (1, 0, 0) and r x (1, 0, 0)
        0, 1, 0, -height, 0, along;       // (0, 1, 0) and r x (0, 1, 0)
    expected += pressing[i] * rows.transpose() * rows;
  }
  CHECK((springs.stiffness() - expected).cwiseAbs().maxCoeff() < 1e-15);
}
