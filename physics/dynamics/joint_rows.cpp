#include "physics/dynamics/joint_rows.hpp"

namespace kenaf::physics {
namespace {

constexpr Two kApart{1, -1};  // first three rows: A's velocity minus B's

}  // namespace

// Here and in solve(): the arithmetic of btSequentialImpulseConstraintSolver (convertJoint,
// resolveSingleConstraintRowGeneric) in its order, without sums of zeros and products with 1, which have no effect.
JointRows::JointRows(FlipperJoint& joint, SolverBody& a, SolverBody& b, const btContactSolverInfo& info)
    : push_(kApart * Two{a.inverse_mass, b.inverse_mass}), joint_(&joint), a_(&a), b_(&b) {
  std::array<FlipperJoint::Row, FlipperJoint::kRows> equations;
  joint.rows(1 / info.m_timeStep * info.m_erp, equations);
  const TwoMatrices inverse_inertia = side_by_side(a.inverse_inertia_W, b.inverse_inertia_W);
  const TwoVectors v = side_by_side(a.v, b.v), w = side_by_side(a.w, b.w);
  const Two inverse_mass{a.inverse_mass, b.inverse_mass}, none{0, 0};
  const Two moving[] = {kApart * v.x, kApart * v.y, kApart * v.z, none, none, none};
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const FlipperJoint::Row& e = equations[i];
    Row& row = rows_[i];

    // Effective mass 1 / (J M^-1 J^T), and the impulse that brings the row from its velocity to the wanted one.
    row.angular = side_by_side(e.angular_a, e.angular_b);
    row.turn = inverse_inertia * row.angular;
    const Two moves = i < 3 ? inverse_mass : none, turns = dot(row.turn, row.angular);
    row.mass = 1 / (moves[0] + turns[0] + moves[1] + turns[1]);
    const Two velocity = moving[i] + dot(row.angular, w);
    row.velocity_impulse = e.velocity * row.mass + (0 - (velocity[0] + velocity[1])) * row.mass;
    row.softness = 0;
    if (e.softness > 0) {
      // The softness adds to the inverse mass. Bullet leaves it out, and its soft rows would not converge.
      const btScalar mass = 1 / (1 / row.mass + e.softness);
      row.velocity_impulse *= mass / row.mass;
      row.softness = e.softness * mass;
      row.mass = mass;
    }
    row.inverse_mass = 1 / row.mass;
    row.low = e.low;
    row.high = e.high;
    row.impulse = btClamped(joint.row_impulse[i], row.low, row.high);
  }
}

JointRows::Velocities JointRows::begin() const {
  return {lanes(a_->delta, b_->delta, 0), lanes(a_->delta, b_->delta, 1)};
}

void JointRows::end(const Velocities& v) {
  a_->delta = lanes(v.linear, v.angular, 0);
  b_->delta = lanes(v.linear, v.angular, 1);
}

void JointRows::warm_start() {
  Velocities v = begin();
  v.linear += TwoVectors{push_ * rows_[0].impulse, push_ * rows_[1].impulse, push_ * rows_[2].impulse};
  for (const Row& row : rows_) v.angular += row.turn * row.impulse;
  end(v);
}

inline btScalar JointRows::Row::change(Two velocity) {
  velocity *= mass;
  const btScalar before = impulse;
  const btScalar wanted = velocity_impulse - before * softness - velocity[0] - velocity[1];
  const btScalar sum = before + wanted;
  if (sum < low) {
    impulse = low;
    return low - before;
  }
  if (sum > high) {
    impulse = high;
    return high - before;
  }
  impulse = sum;
  return wanted;
}

btScalar JointRows::solve() {
  btScalar residual = 0;
  Velocities v = begin();
  const auto settle = [&](Row& row, btScalar impulse) {
    v.angular += row.turn * impulse;
    const btScalar changed = impulse * row.inverse_mass;
    residual = btMax(residual, changed * changed);
  };
  const auto hold_together = [&](Row& row, Two& linear) {
    const btScalar impulse = row.change(kApart * linear + dot(row.angular, v.angular));
    linear += push_ * impulse;
    settle(row, impulse);
  };
  hold_together(rows_[0], v.linear.x);
  hold_together(rows_[1], v.linear.y);
  hold_together(rows_[2], v.linear.z);
  for (std::size_t i = 3; i < rows_.size(); ++i) settle(rows_[i], rows_[i].change(dot(rows_[i].angular, v.angular)));
  end(v);
  return residual;
}

void JointRows::finish() {
  for (std::size_t i = 0; i < rows_.size(); ++i) joint_->row_impulse[i] = rows_[i].impulse;
}

}  // namespace kenaf::physics
