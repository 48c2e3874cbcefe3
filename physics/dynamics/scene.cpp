#include "physics/dynamics/scene.hpp"

#include <BulletCollision/NarrowPhaseCollision/btRaycastCallback.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "physics/dynamics/contact_iterations.hpp"
#include "physics/dynamics/rays.hpp"
#include "physics/robot_shapes.hpp"

namespace kenaf::physics {
namespace {

constexpr double kJointCorrection = 0.2;  // share of a joint's position error that is removed in a step
constexpr double kFree_m = 1e-5;
// The last iteration is the first that changes no velocity by more than this share of gravity's change in a step. With
// a thirtieth of it all drives end at the same poses (docs/physics.md).
constexpr double kSolved = 3e-4;

// Moments of inertia of a uniform box of half size a, b, c: m / 3 (b^2 + c^2), ... Bullet's own, for a hull, are those
// of a box that is larger by its margins.
btVector3 box_inertia(double mass_kg, const btVector3& half) {
  const btVector3 squares = half * half;
  return mass_kg / 3 * btVector3(squares.y() + squares.z(), squares.x() + squares.z(), squares.x() + squares.y());
}

}  // namespace

Scene::Scene(const WorldDescription& description, const PhysicsSettings& settings)
    : dispatcher_(&configuration_),
      hull_plane_(dispatcher_),
      belt_ground_(dispatcher_, configuration_, hull_plane_, hull_solid_),
      compound_contacts_(dispatcher_),
      broadphase_(&pairs_),
      solver_({settings.contact_stiffness_npm, settings.contact_damping_nspm}, belt_ground_),
      world_(dispatcher_, broadphase_, configuration_, solver_) {
  btContactSolverInfo& info = world_.getSolverInfo();
  info.m_numIterations = settings.solver_iterations;
  info.m_erp = kJointCorrection;
  const double solved_mps = kSolved * description.gravity_W_mps2.norm() * settings.time_step_s;
  info.m_leastSquaresResidualThreshold = solved_mps * solved_mps;
  world_.setForceUpdateAllAabbs(false);
  world_.setGravity(to_bullet(description.gravity_W_mps2));
  try {
    for (const GroundPlane& plane : description.planes) {
      Fixture& fixture = planes_.emplace_back();
      fixture.shape = std::make_unique<btStaticPlaneShape>(btVector3(0, 0, 1), 0);
      add_fixture(fixture, 0, plane.friction, plane.X_WP, 0);
    }
    for (const TriangleMesh& mesh : description.meshes) add_mesh(mesh);
  } catch (...) {  // the bodies end before Bullet's world
    clear();
    throw;
  }
}

Scene::~Scene() {
  clear();
}

void Scene::clear() {
  const auto remove = [this](const Fixture& fixture) {
    if (fixture.body) world_.removeRigidBody(fixture.body.get());
  };
  for (const auto& [id, box] : boxes_) remove(box);
  for (const MeshFixture& mesh : meshes_) remove(mesh.fixture);
  for (const Fixture& plane : planes_) remove(plane);
}

void Scene::add_mesh(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return;
  MeshFixture& added = meshes_.emplace_back();
  added.mesh = mesh;

  // Bullet's tree over the triangles, which stay in `added`.
  btIndexedMesh layout;
  layout.m_numTriangles = static_cast<int>(mesh.triangles.size());
  layout.m_triangleIndexBase = reinterpret_cast<const unsigned char*>(added.mesh.triangles.data());
  layout.m_triangleIndexStride = sizeof(added.mesh.triangles[0]);
  layout.m_numVertices = static_cast<int>(mesh.vertices_W.size());
  layout.m_vertexBase = reinterpret_cast<const unsigned char*>(added.mesh.vertices_W.data());
  layout.m_vertexStride = sizeof(added.mesh.vertices_W[0]);
  layout.m_vertexType = PHY_DOUBLE;
  added.triangles.addIndexedMesh(layout, PHY_INTEGER);
  constexpr bool kQuantized = true;  // of the tree's boxes, not of the vertices
  added.fixture.shape = std::make_unique<btBvhTriangleMeshShape>(&added.triangles, kQuantized);

  // Neighbours across edges, for the contacts of belts.
  std::vector<btVector3> vertices;
  for (const Eigen::Vector3d& p_W : mesh.vertices_W) vertices.push_back(to_bullet(p_W));
  added.edges = std::make_unique<MeshEdges>(vertices, mesh.triangles);
  added.tag.mesh = added.edges.get();
  added.fixture.shape->setUserPointer(&added.tag);
  add_fixture(added.fixture, 0, mesh.friction, {}, 0);
}

void Scene::add_fixture(Fixture& fixture, double mass_kg, double friction, const Pose& X_W, int kind) {
  fixture.collider = std::make_unique<Collider>();
  fixture.collider->surfaces = {{.friction_along = friction, .friction_across = friction}};
  const btVector3 inertia = mass_kg > 0 ? box_inertia(mass_kg, fixture.half) : btVector3(0, 0, 0);
  fixture.body = std::make_unique<btRigidBody>(
      btRigidBody::btRigidBodyConstructionInfo(mass_kg, nullptr, fixture.shape.get(), inertia));
  fixture.body->setActivationState(DISABLE_DEACTIVATION);
  fixture.body->setUserPointer(fixture.collider.get());
  fixture.body->setWorldTransform(to_bullet(X_W));
  fixture.body->setInterpolationWorldTransform(to_bullet(X_W));
  fixture.body->updateInertiaTensor();
  // Fixed bodies do not meet each other.
  constexpr int kFixed = btBroadphaseProxy::StaticFilter, kMoves = btBroadphaseProxy::DefaultFilter;
  constexpr int kAll = btBroadphaseProxy::AllFilter;
  const bool moves = mass_kg > 0;
  try {
    world_.addRigidBody(fixture.body.get(), (moves ? kMoves : kFixed) | kind, moves ? kAll : kAll & ~(kFixed | kBoxes));
    world_.updateSingleAabb(fixture.body.get());  // the box of the steps, which is larger than the one of adding
  } catch (...) {                                 // Bullet may know half of it already
    world_.removeRigidBody(fixture.body.get());
    throw;
  }
}

void Scene::step(double time_step_s) {
  world_.stepSimulation(time_step_s, 0);
}

void Scene::add_box(BoxId id, const Box& box) {
  std::map<BoxId, Fixture> added;  // joins the others when it is whole, which cannot fail
  Fixture& fixture = added[id];
  if (box.mass_kg > 0) {
    // A hull, not a box, so that it meets planes as robots do.
    const Eigen::Vector2d half(box.size_m.x() / 2, box.size_m.z() / 2);
    fixture.shape = make_prism({{half.x(), -half.y()}, half, {-half.x(), half.y()}, -half}, box.size_m.y(), {0, 0, 0});
    fixture.half = to_bullet(Eigen::Vector3d(box.size_m / 2));
    fixture.tag.box_half = &fixture.half;
    fixture.shape->setUserPointer(&fixture.tag);
  } else {
    fixture.shape = make_box(box.size_m);
  }
  add_fixture(fixture, box.mass_kg, box.friction, box.X_WBox, kBoxes);
  boxes_.merge(added);
}

void Scene::remove_box(BoxId id) {
  const auto found = boxes_.find(id);
  if (found == boxes_.end()) throw std::out_of_range("no such box");
  solver_.forget_contacts_of(*found->second.body);
  world_.removeRigidBody(found->second.body.get());
  boxes_.erase(found);
}

void Scene::move_box(BoxId id, const Pose& X_WBox) {
  btRigidBody& body = *boxes_.at(id).body;
  body.setWorldTransform(to_bullet(X_WBox));
  body.setInterpolationWorldTransform(to_bullet(X_WBox));
  body.setLinearVelocity({0, 0, 0});
  body.setAngularVelocity({0, 0, 0});
  body.updateInertiaTensor();
  broadphase_.getOverlappingPairCache()->cleanProxyFromPairs(body.getBroadphaseHandle(), &dispatcher_);
  world_.updateSingleAabb(&body);
}

Pose Scene::box_pose(BoxId id) const {
  return from_bullet(boxes_.at(id).body->getWorldTransform());
}

double Scene::lift_needed(RobotModel& robot, double search_step_m) {
  // The largest way up that frees the robot from a penetrating contact with anything but itself: depth / n_z.
  struct Deepest : btCollisionWorld::ContactResultCallback {
    const btCollisionObject* self = nullptr;
    const std::vector<btRigidBody*>* own = nullptr;
    double search_step_m = 0, lift_m = 0;
    bool needsCollision(btBroadphaseProxy* proxy) const override {
      return std::find(own->begin(), own->end(), proxy->m_clientObject) == own->end();
    }
    btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper* object0, int, int,
                             const btCollisionObjectWrapper*, int, int) override {
      const double depth = -point.getDistance();
      if (depth <= 0) return 0;
      const double up = (object0->getCollisionObject() == self ? 1 : -1) * point.m_normalWorldOnB.z();
      // A wall beside it, or an obstacle's underside: up in steps, until the robot is above it.
      constexpr double kSteepest = 0.3;
      lift_m = std::max(lift_m, up > kSteepest ? depth / up : search_step_m);
      return 0;
    }
  } deepest;

  // While probing, belts meet the ground as hulls do, which finds deep penetrations too.
  deepest.own = &robot.bodies();
  deepest.search_step_m = search_step_m;
  const struct Probing {
    BeltGround& belts;
    explicit Probing(BeltGround& ground) : belts(ground) { belts.set_probing(true); }
    ~Probing() { belts.set_probing(false); }
    Probing(const Probing&) = delete;
    Probing& operator=(const Probing&) = delete;
  } probing(belt_ground_);
  for (btRigidBody* body : robot.bodies()) {
    deepest.self = body;
    world_.contactTest(body, deepest);
  }
  return deepest.lift_m;
}

double Scene::depth_in_mesh(const Eigen::Vector3d& p_W) const {
  // Inside a solid, a ray upward meets the nearest surface from below: from the side against its normal.
  struct MeshAbove : btCollisionWorld::ClosestRayResultCallback {
    using ClosestRayResultCallback::ClosestRayResultCallback;
    bool needsCollision(btBroadphaseProxy* proxy) const override {
      const auto* object = static_cast<const btCollisionObject*>(proxy->m_clientObject);
      return object->getCollisionShape()->getShapeType() == TRIANGLE_MESH_SHAPE_PROXYTYPE;
    }
  };
  constexpr double kHighest_m = 1000;
  const btVector3 from_W = to_bullet(p_W), to_W = from_W + btVector3(0, 0, kHighest_m);
  MeshAbove above(from_W, to_W);
  above.m_flags |= btTriangleRaycastCallback::kF_KeepUnflippedNormal;
  world_.rayTest(from_W, to_W, above);
  return above.hasHit() && above.m_hitNormalWorld.z() > 0 ? above.m_closestHitFraction * kHighest_m : 0;
}

void Scene::place_free(RobotModel& robot, Pose X_WB, bool start_joints) {
  constexpr int kMaxLifts = 1000;
  constexpr int kLiftsToDouble = 100;  // the search step doubles after so many lifts: over 2 km in all
  double search_step_m = 0.02;
  // Deep inside a mesh, the robot would touch none of its triangles.
  X_WB.p.z() += depth_in_mesh(X_WB.p);
  robot.place(X_WB, start_joints);
  for (int i = 1; i <= kMaxLifts; ++i) {
    const double lift_m = lift_needed(robot, search_step_m);
    if (lift_m <= 0) return;
    if (i % kLiftsToDouble == 0) search_step_m *= 2;  // for tall obstacles
    X_WB.p.z() += lift_m + kFree_m;
    robot.place(X_WB, start_joints);
  }
}

std::optional<RayHit> Scene::cast_ray(const Eigen::Vector3d& from_W, const Eigen::Vector3d& direction_W, double max_m,
                                      std::uint32_t ignored_robot) const {
  const double length = direction_W.norm();
  if (!(length > 0) || !(max_m > 0) || !from_W.allFinite()) return std::nullopt;
  const Eigen::Vector3d to_W = from_W + direction_W * (max_m / length);
  const auto meeting = first_meeting({to_bullet(from_W), to_bullet(to_W)}, broadphase_, ignored_robot);
  if (!meeting) return std::nullopt;
  return RayHit{meeting->fraction * max_m, from_bullet(meeting->normal)};
}

void Scene::touches(std::vector<Touch>& out) const {
  out.clear();
  for_each_patch(solver_.patches(), solver_.contacts(), [&](const ContactPatch& patch, auto contacts) {
    const std::uint32_t a = patch.collider_a->robot, b = patch.collider_b->robot;  // 0: of no robot
    for (const Contact& contact : contacts) {
      if (!contact.pressed()) continue;
      const Eigen::Vector3d p_W = from_bullet(contact.p_W());
      if (a != 0) out.push_back({RobotId{a}, p_W});
      if (b != 0 && b != a) out.push_back({RobotId{b}, p_W});
    }
  });
}

void Scene::contacts(RobotId robot, double time_step_s, std::vector<ContactPoint>& out) const {
  out.clear();
  const auto id = static_cast<std::uint32_t>(robot);
  for_each_patch(solver_.patches(), solver_.contacts(), [&](const ContactPatch& patch, auto contacts) {
    for (const Contact& contact : contacts) {
      if (!contact.pressed()) continue;
      // Two of one robot's own parts may meet: then it is in the list twice, and cancels.
      const Eigen::Vector3d p_W = from_bullet(contact.p_W());
      const btVector3 impulse_W = patch.in_W(contact.normal_impulse(), contact.friction_impulse());
      const Eigen::Vector3d force_W_n = from_bullet(impulse_W / time_step_s);
      if (patch.collider_a->robot == id) out.push_back({p_W, force_W_n, patch.part_a});
      if (patch.collider_b->robot == id) out.push_back({p_W, -force_W_n, patch.part_b});
    }
  });
}

}  // namespace kenaf::physics
