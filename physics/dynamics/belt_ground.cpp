#include "physics/dynamics/belt_ground.hpp"

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btConvexConvexAlgorithm.h>

#include <algorithm>
#include <map>
#include <new>
#include <utility>

#include "physics/dynamics/touching.hpp"

namespace kenaf::physics {
namespace {

constexpr std::size_t kReserved = 128;  // contacts; a track on a step has about 20, on triangles of 5 mm above 48
constexpr btScalar kFlat = 1e-4;        // sine of the angle between two triangles that are one surface
// Cosine of 20 degrees (chosen): the facets of a round shape narrower than a belt meet at more.
constexpr btScalar kSharp = 0.94;

const ShapeTag* tag_of(const btCollisionObjectWrapper& object) {
  return static_cast<const ShapeTag*>(object.getCollisionShape()->getUserPointer());
}

}  // namespace

MeshEdges::MeshEdges(const std::vector<btVector3>& vertices,
                     const std::vector<std::array<std::uint32_t, 3>>& triangles) {
  // Vertices at the same place are one vertex, whatever the file says.
  std::map<std::array<btScalar, 3>, std::uint32_t> places;
  std::vector<std::uint32_t> place;
  for (const btVector3& v : vertices)
    place.push_back(places.try_emplace({v.x(), v.y(), v.z()}, static_cast<std::uint32_t>(places.size())).first->second);

  // The first of two triangles owns their edge, if the surface is convex there; an edge of one triangle has no owner.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<std::size_t, int>> edge_owner;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    TriangleInT& t = triangles_.emplace_back();
    t.index = static_cast<std::uint32_t>(i);
    for (std::size_t k = 0; k < 3; ++k) t.corner[k] = vertices[triangles[i][k]];
    t.normal = (t.corner[1] - t.corner[0]).cross(t.corner[2] - t.corner[0]).normalized();
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = place[triangles[i][static_cast<std::size_t>(k)]];
      const std::uint32_t b = place[triangles[i][static_cast<std::size_t>((k + 1) % 3)]];
      t.owns_edge[k] = false;
      const auto [found, first] = edge_owner.try_emplace({std::min(a, b), std::max(a, b)}, i, k);
      if (first) continue;
      TriangleInT& owner = triangles_[found->second.first];
      const int edge = found->second.second;
      const btVector3 along = (owner.corner[(edge + 1) % 3] - owner.corner[edge]).normalized();
      // Convex: the neighbour's normal is turned away from the owner's about the edge, (n1 x n2) . edge > 0.
      owner.owns_edge[edge] = owner.normal.cross(t.normal).dot(along) > kFlat;
      owner.neighbour_normal[edge] = t.normal;
      if (owner.owns_edge[edge] && owner.normal.dot(t.normal) < kSharp) owner.at_ridge = t.at_ridge = true;
    }
  }
}

struct BeltGround::Pair : BeltPair {
  std::vector<BeltContact> before;
};

class BeltGround::Algorithm : public btCollisionAlgorithm {
 public:
  Algorithm(const btCollisionAlgorithmConstructionInfo& info, BeltGround& owner, bool swapped)
      : btCollisionAlgorithm(info), owner_(owner), swapped_(swapped) {
    if (owner_.spare_.empty()) owner_.add_spare();
    pair_ = std::move(owner_.spare_.back());
    owner_.spare_.pop_back();
    owner_.pairs_.push_back(pair_.get());
  }
  ~Algorithm() override {
    std::erase(owner_.pairs_, pair_.get());
    pair_->contacts.clear();
    owner_.spare_.push_back(std::move(pair_));
  }

  void processCollision(const btCollisionObjectWrapper* body0, const btCollisionObjectWrapper* body1,
                        const btDispatcherInfo&, btManifoldResult*) override {
    const btCollisionObjectWrapper& body = swapped_ ? *body1 : *body0;
    const btCollisionObjectWrapper& ground = swapped_ ? *body0 : *body1;
    pair_->body = body.getCollisionObject();
    pair_->ground = ground.getCollisionObject();
    pair_->belt = tag_of(body)->belt;
    const btTransform& X_WBody = body.getWorldTransform();
    pair_->X_WT = btTransform(X_WBody.getBasis(), X_WBody * pair_->belt->p_BodyT);
    owner_.touches_.clear();
    touch(ground, pair_->X_WT.inverse() * ground.getWorldTransform());
    remember();
  }

  btScalar calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                 btManifoldResult*) override {
    return 1;
  }
  void getAllContactManifolds(btManifoldArray&) override {}

 private:
  void touch(const btCollisionObjectWrapper& ground, const btTransform& X_TG) {
    const BeltShape& belt = *pair_->belt;
    const btCollisionShape& shape = *ground.getCollisionShape();
    if (shape.getShapeType() == STATIC_PLANE_PROXYTYPE) {
      const auto& plane = static_cast<const btStaticPlaneShape&>(shape);
      const btVector3 normal = X_TG.getBasis() * plane.getPlaneNormal();
      touch_plane(belt, normal, plane.getPlaneConstant() + normal.dot(X_TG.getOrigin()), owner_.touches_);
    } else if (shape.getShapeType() == BOX_SHAPE_PROXYTYPE) {
      const auto& box = static_cast<const btBoxShape&>(shape);
      touch_box(belt, {X_TG.getBasis(), X_TG.getOrigin(), box.getHalfExtentsWithMargin()}, owner_.touches_);
    } else if (const ShapeTag* tag = tag_of(ground); tag->box_half) {
      touch_box(belt, {X_TG.getBasis(), X_TG.getOrigin(), *tag->box_half}, owner_.touches_);
    } else {
      touch_mesh(static_cast<const btBvhTriangleMeshShape&>(shape), *tag->mesh, X_TG);
    }
  }

  void touch_mesh(const btBvhTriangleMeshShape& shape, const MeshEdges& edges, const btTransform& X_TG) {
    // Called by Bullet for each triangle near the belt: brings it into T and collects its contacts.
    const BeltShape& belt = *pair_->belt;
    struct Each : btTriangleCallback {
      const BeltShape* belt;
      const MeshEdges* edges;
      const btTransform* X_TG;
      std::vector<BeltTouch>* out;
      void processTriangle(btVector3*, int, int index) override {
        TriangleInT t = edges->triangle(static_cast<std::size_t>(index));
        for (btVector3& corner : t.corner) corner = *X_TG * corner;
        t.normal = X_TG->getBasis() * t.normal;
        for (btVector3& normal : t.neighbour_normal) normal = X_TG->getBasis() * normal;
        touch_triangle(*belt, t, *out);
      }
    } each;
    each.belt = &belt;
    each.edges = &edges;
    each.X_TG = &X_TG;
    each.out = &owner_.touches_;

    // The belt's bounding box, in the mesh's frame, selects the triangles.
    const BoundingBox around = bounding_box(belt);
    btVector3 low_G, high_G;
    btTransformAabb(around.low, around.high, 0, X_TG.inverse(), low_G, high_G);
    shape.processAllTriangles(&each, low_G, high_G);
  }

  // Gives each contact of this step the impulses that it had in the last one. They mostly come in the same order.
  void remember() {
    pair_->before.swap(pair_->contacts);
    pair_->contacts.clear();
    const std::vector<BeltContact>& before = pair_->before;
    std::size_t next = 0;
    for (const BeltTouch& touch : owner_.touches_) {
      BeltContact& contact = pair_->contacts.emplace_back(BeltContact{touch, {}});
      for (std::size_t tried = 0; tried < before.size(); ++tried) {
        const BeltContact& old = before[next];
        next = next + 1 < before.size() ? next + 1 : 0;
        if (old.touch.feature != touch.feature) continue;
        contact.impulse = old.impulse;
        break;
      }
    }
  }

  BeltGround& owner_;
  std::unique_ptr<Pair> pair_;  // not a member by value: Bullet's pool has room for its own algorithms' size only
  bool swapped_;
};

struct BeltGround::Create : btCollisionAlgorithmCreateFunc {
  BeltGround* owner;
  btCollisionAlgorithmCreateFunc* otherwise;

  btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                 const btCollisionObjectWrapper* body0,
                                                 const btCollisionObjectWrapper* body1) override {
    const ShapeTag *tag0 = tag_of(*body0), *tag1 = tag_of(*body1);
    const bool first = tag0 && tag0->belt && meets(*body1, tag1), second = tag1 && tag1->belt && meets(*body0, tag0);
    if (owner->probing_ || (!first && !second)) return otherwise->CreateCollisionAlgorithm(info, body0, body1);
    static_assert(sizeof(Algorithm) <= sizeof(btConvexConvexAlgorithm));
    void* memory = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(Algorithm));
    return new (memory) Algorithm(info, *owner, !first);
  }

  static bool meets(const btCollisionObjectWrapper& ground, const ShapeTag* tag) {
    const int type = ground.getCollisionShape()->getShapeType();
    return type == STATIC_PLANE_PROXYTYPE || type == BOX_SHAPE_PROXYTYPE || (tag && (tag->box_half || tag->mesh));
  }
};

BeltGround::BeltGround(btCollisionDispatcher& dispatcher, btCollisionConfiguration& configuration,
                       HullPlaneContacts& hull_plane, HullSolidContacts& hull_solid) {
  touches_.reserve(kReserved);
  const int hull = CONVEX_HULL_SHAPE_PROXYTYPE;
  for (const int other :
       {STATIC_PLANE_PROXYTYPE, BOX_SHAPE_PROXYTYPE, CONVEX_HULL_SHAPE_PROXYTYPE, TRIANGLE_MESH_SHAPE_PROXYTYPE}) {
    for (const auto& [a, b] : {std::pair{hull, other}, std::pair{other, hull}}) {
      auto& create = *create_.emplace_back(std::make_unique<Create>());
      create.owner = this;
      if (other == STATIC_PLANE_PROXYTYPE)
        create.otherwise = &hull_plane.create(a == other);
      else if (other == TRIANGLE_MESH_SHAPE_PROXYTYPE)
        create.otherwise = configuration.getCollisionAlgorithmCreateFunc(a, b);
      else
        create.otherwise = &hull_solid.create();
      dispatcher.registerCollisionCreateFunc(a, b, &create);
    }
  }
}

BeltGround::~BeltGround() = default;

void BeltGround::make_room(std::size_t pairs) {
  spare_.reserve(pairs);
  pairs_.reserve(pairs);
  while (spare_.size() + pairs_.size() < pairs) add_spare();
}

void BeltGround::add_spare() {
  auto pair = std::make_unique<Pair>();
  pair->contacts.reserve(kReserved);
  pair->before.reserve(kReserved);
  spare_.push_back(std::move(pair));
  // Room for all of them at once on either list.
  const std::size_t all = spare_.size() + pairs_.size();
  spare_.reserve(all);
  pairs_.reserve(all);
}

}  // namespace kenaf::physics
