// Arithmetic on two numbers at once, in one register (vector extensions of g++ and clang). Both lanes are independent
// and computed in the written order, so each has the same bits as scalar code.
#pragma once

#include "physics/dynamics/bullet.hpp"

namespace kenaf::physics {

using Two = double __attribute__((vector_size(16)));

// Two vectors side by side, or a linear part in lane 0 and an angular part in lane 1.
struct TwoVectors {
  Two x, y, z;
};

inline TwoVectors side_by_side(const btVector3& a, const btVector3& b) {
  return {Two{a.x(), b.x()}, Two{a.y(), b.y()}, Two{a.z(), b.z()}};
}
inline btVector3 vector_of(const TwoVectors& v, int lane) {
  return {v.x[lane], v.y[lane], v.z[lane]};
}

inline btScalar sum_of_lanes(const Two& parts) {
  return parts[0] + parts[1];
}

// In the order of btVector3.
inline Two dot(const TwoVectors& a, const TwoVectors& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Two dot(const btVector3& a, const TwoVectors& b) {
  return a.x() * b.x + a.y() * b.y + a.z() * b.z;
}
inline TwoVectors operator*(const TwoVectors& v, Two s) {
  return {v.x * s, v.y * s, v.z * s};
}
inline TwoVectors operator*(const TwoVectors& v, btScalar s) {
  return {v.x * s, v.y * s, v.z * s};
}
inline TwoVectors operator+(const TwoVectors& a, const TwoVectors& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline void operator+=(TwoVectors& a, const TwoVectors& b) {
  a = a + b;
}
inline void operator-=(TwoVectors& a, const TwoVectors& b) {
  a = {a.x - b.x, a.y - b.y, a.z - b.z};
}

}  // namespace kenaf::physics
