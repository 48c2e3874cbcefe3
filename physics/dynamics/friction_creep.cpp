#include "physics/dynamics/friction_creep.hpp"

#include <Eigen/Cholesky>

namespace kenaf::physics {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

Vector6 to_vector6(const TwoVectors& row) {
  return {row.x[0], row.y[0], row.z[0], row.x[1], row.y[1], row.z[1]};
}

}  // namespace

void FrictionCreep::lose(const TwoVectors (&rows)[2], Two lost_ns, btScalar pressing_ns) {
  lost_ += rows[0] * lost_ns[0] + rows[1] * lost_ns[1];
  pressing_ns_ += pressing_ns;
}

bool FrictionCreep::matters() const {
  constexpr btScalar kTrifle = 1e-6;  // of what presses; the iterations leave 1e-5
  return sum_of_lanes(dot(lost_, lost_)) > kTrifle * kTrifle * pressing_ns_ * pressing_ns_;
}

void FrictionCreep::add_spring(const TwoVectors (&rows)[2], btScalar pressing_ns) {
  for (const TwoVectors& row : rows) {
    const Vector6 j = to_vector6(row);
    stiffness_.noalias() += (pressing_ns * j) * j.transpose();
  }
}

TwoVectors FrictionCreep::given_back() const {
  // Where the contacts cannot push there is no stiffness, and nothing is lost: a trifle on the diagonal keeps it at 0.
  constexpr double kTrifle = 1e-9;
  Eigen::Matrix<double, 6, 6> stiffness = stiffness_;
  stiffness.diagonal().array() += kTrifle * stiffness_.trace();
  const Vector6 y = stiffness.ldlt().solve(to_vector6(lost_));
  return {Two{y[0], y[3]}, Two{y[1], y[4]}, Two{y[2], y[5]}};
}

}  // namespace kenaf::physics
