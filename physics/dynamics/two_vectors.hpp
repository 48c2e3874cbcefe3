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
inline TwoVectors lanes(const TwoVectors& a, const TwoVectors& b, int lane) {
  return {Two{a.x[lane], b.x[lane]}, Two{a.y[lane], b.y[lane]}, Two{a.z[lane], b.z[lane]}};
}

struct TwoMatrices {
  TwoVectors rows[3];
};
inline TwoMatrices side_by_side(const btMatrix3x3& a, const btMatrix3x3& b) {
  return {{side_by_side(a[0], b[0]), side_by_side(a[1], b[1]), side_by_side(a[2], b[2])}};
}

inline btScalar sum_of_lanes(const Two& parts) {
  return parts[0] + parts[1];
}

// In the order of btVector3 and btMatrix3x3.
inline Two dot(const TwoVectors& a, const TwoVectors& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Two dot(const btVector3& a, const TwoVectors& b) {
  return a.x() * b.x + a.y() * b.y + a.z() * b.z;
}
inline TwoVectors cross(const btVector3& a, const TwoVectors& b) {
  return {a.y() * b.z - a.z() * b.y, a.z() * b.x - a.x() * b.z, a.x() * b.y - a.y() * b.x};
}
inline TwoVectors operator*(const btMatrix3x3& m, const TwoVectors& v) {
  return {dot(m[0], v), dot(m[1], v), dot(m[2], v)};
}
inline TwoVectors operator*(const TwoMatrices& m, const TwoVectors& v) {
  return {dot(m.rows[0], v), dot(m.rows[1], v), dot(m.rows[2], v)};
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
