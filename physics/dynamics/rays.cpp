#include "physics/dynamics/rays.hpp"

#include <BulletCollision/CollisionShapes/btConvexPolyhedron.h>
#include <BulletCollision/NarrowPhaseCollision/btRaycastCallback.h>

#include <algorithm>

#include "physics/dynamics/surface.hpp"

namespace kenaf::physics {
namespace {

using Found = std::optional<RayMeeting>;

// A convex shape is where it is behind all of its faces: a ray is within from where it crosses the last of those that
// it comes from ahead of until it crosses the first of the others.
class ConvexClip {
 public:
  explicit ConvexClip(const Ray& ray) : from_(ray.from), along_(ray.to - ray.from) {}

  // The half space normal . p <= offset.
  void cut(const btVector3& normal, btScalar offset) {
    const btScalar ahead = normal.dot(from_) - offset, closing = -normal.dot(along_);
    if (closing > 0) {
      if (ahead <= closing * enters_) return;
      enters_ = ahead / closing;
      normal_ = normal;
      from_outside_ = true;
    } else if (closing < 0) {
      leaves_ = std::min(leaves_, ahead / closing);
    } else if (ahead > 0) {
      leaves_ = -1;
    }
  }
  Found result() const {
    if (!from_outside_ || enters_ > leaves_ || enters_ > 1) return std::nullopt;
    return RayMeeting{enters_, normal_};
  }

 private:
  btVector3 from_, along_, normal_{0, 0, 0};
  btScalar enters_ = 0, leaves_ = 1;
  bool from_outside_ = false;
};

Found with_box(const Ray& ray, const btVector3& half) {
  ConvexClip clip(ray);
  for (int k = 0; k < 3; ++k) {
    btVector3 axis(0, 0, 0);
    axis[k] = 1;
    clip.cut(axis, half[k]);
    clip.cut(-axis, half[k]);
  }
  return clip.result();
}

Found with_hull(const Ray& ray, const btConvexPolyhedron& hull) {
  ConvexClip clip(ray);
  for (int i = 0; i < hull.m_faces.size(); ++i) {
    const btScalar* plane = hull.m_faces[i].m_plane;  // normal . p + plane[3] = 0
    clip.cut({plane[0], plane[1], plane[2]}, -plane[3]);
  }
  return clip.result();
}

Found with_plane(const Ray& ray, const btVector3& normal, btScalar offset) {
  const btScalar ahead = normal.dot(ray.from) - offset, closing = -normal.dot(ray.to - ray.from);
  if (closing == 0) return std::nullopt;
  const btScalar fraction = ahead / closing;
  if (!(fraction >= 0 && fraction <= 1)) return std::nullopt;
  return RayMeeting{fraction, closing > 0 ? normal : -normal};
}

Found with_mesh(const Ray& ray, const btBvhTriangleMeshShape& mesh) {
  struct First : btTriangleRaycastCallback {
    using btTriangleRaycastCallback::btTriangleRaycastCallback;
    Found found;
    btScalar reportHit(const btVector3& normal, btScalar fraction, int, int) override {
      found = RayMeeting{fraction, normal.normalized()};
      return fraction;
    }
  } first(ray.from, ray.to);
  // It only reads the shape; Bullet does not say so.
  const_cast<btBvhTriangleMeshShape&>(mesh).performRaycast(&first, ray.from, ray.to);  // NOLINT
  return first.found;
}

// With the ray in the shape's frame.
Found in_shape(const Ray& ray, const btCollisionShape& shape) {
  switch (shape.getShapeType()) {
    case STATIC_PLANE_PROXYTYPE: {
      const auto& plane = static_cast<const btStaticPlaneShape&>(shape);
      return with_plane(ray, plane.getPlaneNormal(), plane.getPlaneConstant());
    }
    case BOX_SHAPE_PROXYTYPE:
      return with_box(ray, static_cast<const btBoxShape&>(shape).getHalfExtentsWithMargin());
    case CONVEX_HULL_SHAPE_PROXYTYPE:
      return with_hull(ray, *static_cast<const btConvexHullShape&>(shape).getConvexPolyhedron());
    case TRIANGLE_MESH_SHAPE_PROXYTYPE:
      return with_mesh(ray, static_cast<const btBvhTriangleMeshShape&>(shape));
    case COMPOUND_SHAPE_PROXYTYPE: {
      const auto& compound = static_cast<const btCompoundShape&>(shape);
      Found first;
      for (int i = 0; i < compound.getNumChildShapes(); ++i) {
        const Found at = meeting_of(ray, *compound.getChildShape(i), compound.getChildTransform(i));
        if (at && (!first || at->fraction < first->fraction)) first = at;
      }
      return first;
    }
    default:
      return std::nullopt;
  }
}

}  // namespace

std::optional<RayMeeting> meeting_of(const Ray& ray, const btCollisionShape& shape, const btTransform& X_shape) {
  Found at = in_shape({X_shape.invXform(ray.from), X_shape.invXform(ray.to)}, shape);
  if (at) at->normal = X_shape.getBasis() * at->normal;
  return at;
}

std::optional<RayMeeting> first_meeting(const Ray& ray_W, btBroadphaseInterface& objects, std::uint32_t ignored_robot) {
  // Called by Bullet for each object near the ray.
  struct First : btBroadphaseRayCallback {
    Ray ray;
    std::uint32_t ignored = 0;
    Found found;
    bool process(const btBroadphaseProxy* proxy) override {
      const auto& object = *static_cast<const btCollisionObject*>(proxy->m_clientObject);
      if (ignored != 0 && static_cast<const Collider*>(object.getUserPointer())->robot == ignored) return true;
      const Found at = meeting_of(ray, *object.getCollisionShape(), object.getWorldTransform());
      if (at && (!found || at->fraction < found->fraction)) found = at;
      return true;
    }
  } first;
  first.ray = ray_W;
  first.ignored = ignored_robot;

  // As btSingleRayCallback fills it.
  const btVector3 along = ray_W.to - ray_W.from, direction = along.normalized();
  for (int k = 0; k < 3; ++k) {
    first.m_rayDirectionInverse[k] = direction[k] == 0 ? btScalar(BT_LARGE_FLOAT) : 1 / direction[k];
    first.m_signs[k] = first.m_rayDirectionInverse[k] < 0;
  }
  first.m_lambda_max = direction.dot(along);
  objects.rayTest(ray_W.from, ray_W.to, first);
  return first.found;
}

}  // namespace kenaf::physics
