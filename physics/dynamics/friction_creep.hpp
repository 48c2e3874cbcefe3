// What the friction of a body's contacts loses to creep within a step, and how they get it back. Rubber that sticks
// creeps, so tracks that once pulled against each other do not do so for ever; what holds the body has to stay. So the
// contacts that stick give back the six components of what is lost, each as a spring as stiff as it is loaded would:
// only what they pull against each other is gone. With the impulses l_i that fade, the normal impulses p_i and the rows
// J_i (2 x 6) of friction's two axes
//   y = (sum p_i J_i^T J_i)^-1 sum J_i^T l_i,   contact i gets back p_i J_i y
#pragma once

#include <Eigen/Core>

#include "physics/dynamics/two_vectors.hpp"

namespace kenaf::physics {

class FrictionCreep {
 public:
  // First every contact, with its rows and its impulses.
  void lose(const TwoVectors (&rows)[2], Two lost_ns, btScalar pressing_ns);
  // Whether what is lost is more than the iterations leave open. Where friction does not hold the body it is nothing.
  bool matters() const;
  // Then, if it matters, every contact again; y, in the order of a row.
  void add_spring(const TwoVectors (&rows)[2], btScalar pressing_ns);
  TwoVectors given_back() const;

 private:
  Eigen::Matrix<double, 6, 6> stiffness_ = Eigen::Matrix<double, 6, 6>::Zero();
  TwoVectors lost_{};
  btScalar pressing_ns_ = 0;
};

}  // namespace kenaf::physics
