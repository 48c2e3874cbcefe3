// Where a ray meets a shape, exactly. Bullet's search for the boundary of a convex shape ends within a centimetre, so
// that rays which pass beside a box hit it.
//
// Thread safety: pure functions.
#pragma once

#include <cstdint>
#include <optional>

#include "physics/dynamics/bullet.hpp"

namespace kenaf::physics {

// From one point to another.
struct Ray {
  btVector3 from, to;
};

struct RayMeeting {
  btScalar fraction;  // of the way, 0 to 1
  btVector3 normal;   // unit, towards where the ray comes from
};

// Where it enters the shape, both in one frame: of planes and meshes from either side; nothing if it begins inside of
// a convex shape. Shapes: planes, boxes, hulls with polyhedral features, meshes, and compounds of these.
std::optional<RayMeeting> meeting_of(const Ray& ray, const btCollisionShape& shape, const btTransform& X_shape);

// The first of a world's objects that a ray meets; none of `ignored_robot` (Collider::robot) unless that is 0. Only
// reads them, which Bullet does not say.
std::optional<RayMeeting> first_meeting(const Ray& ray_W, btBroadphaseInterface& objects, std::uint32_t ignored_robot);

}  // namespace kenaf::physics
