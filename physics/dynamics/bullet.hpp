// Conversions between Eigen and Bullet (double precision). Only implementation files of this room include Bullet.
#pragma once

#include <btBulletCollisionCommon.h>
#include <btBulletDynamicsCommon.h>

#include "physics/pose.hpp"

namespace kenaf::physics {

inline btVector3 to_bullet(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}
inline Eigen::Vector3d from_bullet(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}
inline btQuaternion to_bullet(const Eigen::Quaterniond& q) {
  return {q.x(), q.y(), q.z(), q.w()};
}
inline btTransform to_bullet(const Pose& X) {
  return btTransform(to_bullet(X.q), to_bullet(X.p));
}
inline Pose from_bullet(const btTransform& X) {
  const btQuaternion q = X.getRotation();
  return {from_bullet(X.getOrigin()), Eigen::Quaterniond(q.w(), q.x(), q.y(), q.z())};
}

}  // namespace kenaf::physics
