#include "physics/dynamics/friction_creep.hpp"

#include <Eigen/Cholesky>

#include <utility>

namespace kenaf::physics {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

Vector6 to_vector6(const TwoVectors& row) {
  return {row.x[0], row.y[0], row.z[0], row.x[1], row.y[1], row.z[1]};
}

}  // namespace

// With r = (r_0, r_1, h) the rows of along and across are (1, 0, 0, 0, h, -r_1) and (0, 1, 0, -h, 0, r_0).
Eigen::Matrix<double, 6, 6> SpringsInPatch::stiffness() const {
  Eigen::Matrix<double, 6, 6> k = Eigen::Matrix<double, 6, 6>::Zero();
  k(0, 0) = k(1, 1) = pressing_ns_;
  k(0, 4) = k(4, 0) = first_height_;
  k(1, 3) = k(3, 1) = -first_height_;
  k(0, 5) = k(5, 0) = first_[0];
  k(1, 5) = k(5, 1) = first_[1];
  k(3, 3) = k(4, 4) = second_height_;
  k(3, 5) = k(5, 3) = -with_height_[1];
  k(4, 5) = k(5, 4) = with_height_[0];
  k(5, 5) = second_;
  return k;
}

void FrictionCreep::lose(const ContactPatch& patch, const InPatch& lost_ns, btScalar pressing_ns) {
  lost_ += patch.in_W(lost_ns);
  pressing_ns_ += pressing_ns;
}

bool FrictionCreep::matters() const {
  constexpr btScalar kTrifle = 1e-6;  // of what presses; far less than the iterations leave
  return sum_of_lanes(dot(lost_, lost_)) > kTrifle * kTrifle * pressing_ns_ * pressing_ns_;
}

void FrictionCreep::add_springs(const ContactPatch& patch, const SpringsInPatch& springs) {
  Eigen::Matrix3d R_WF;
  R_WF << patch.along_W.x(), patch.across_W.x(), patch.normal_W.x(),  //
      patch.along_W.y(), patch.across_W.y(), patch.normal_W.y(),      //
      patch.along_W.z(), patch.across_W.z(), patch.normal_W.z();
  const Eigen::Matrix<double, 6, 6> in_patch = springs.stiffness();
  // The lower triangle, all that the decomposition reads.
  for (const auto& [i, j] : {std::pair{0, 0}, {3, 0}, {3, 3}})
    stiffness_.block<3, 3>(i, j) += R_WF * in_patch.block<3, 3>(i, j) * R_WF.transpose();
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
