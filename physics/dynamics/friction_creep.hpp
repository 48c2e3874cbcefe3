// What the friction of a body's contacts loses to creep within a step, and how they get it back. Rubber that sticks
// creeps, so tracks that once pulled against each other do not do so for ever; what holds the body has to stay. So the
// contacts that stick give back the six components of what is lost, each as a spring as stiff as it is loaded would:
// only what they pull against each other is gone. With the impulses l_i that fade, the normal impulses p_i and the rows
// J_i (2 x 6) of friction's two axes
//   y = (sum p_i J_i^T J_i)^-1 sum J_i^T l_i,   contact i gets back p_i J_i y
#pragma once

#include <Eigen/Core>

#include "physics/dynamics/contact_patch.hpp"

namespace kenaf::physics {

// The springs of contacts in one patch, sum p J^T J in its axes, by moments of what presses.
class SpringsInPatch {
 public:
  void add(const PlaceInPatch& r, btScalar pressing_ns) {
    const Two turned = pressing_ns * r.turned;
    pressing_ns_ += pressing_ns;
    first_ += turned;
    first_height_ += pressing_ns * r.height;
    second_ += sum_of_lanes(turned * r.turned);
    with_height_ += turned * r.height;
    second_height_ += pressing_ns * r.height * r.height;
  }
  // Linear before angular, in the patch's axes.
  Eigen::Matrix<double, 6, 6> stiffness() const;

 private:
  btScalar pressing_ns_ = 0, first_height_ = 0, second_ = 0, second_height_ = 0;
  Two first_{0, 0}, with_height_{0, 0};
};

class FrictionCreep {
 public:
  // First every patch, with what its contacts lose and what presses on them.
  void lose(const ContactPatch& patch, const InPatch& lost_ns, btScalar pressing_ns);
  // Whether what is lost is more than the iterations leave open. Where friction does not hold the body it is nothing.
  bool matters() const;
  // Then, if it matters, every patch again; y.
  void add_springs(const ContactPatch& patch, const SpringsInPatch& springs);
  TwoVectors given_back() const;

 private:
  Eigen::Matrix<double, 6, 6> stiffness_ = Eigen::Matrix<double, 6, 6>::Zero();
  TwoVectors lost_{};
  btScalar pressing_ns_ = 0;
};

}  // namespace kenaf::physics
