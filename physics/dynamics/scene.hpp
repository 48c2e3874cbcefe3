// The Bullet side of a world: solver, ground and boxes, ray casts, and lifting a robot until it is free.
#pragma once

#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "physics/dynamics/bullet.hpp"
#include "physics/dynamics/compound_contacts.hpp"
#include "physics/dynamics/contact_solver.hpp"
#include "physics/dynamics/contact_tables.hpp"
#include "physics/dynamics/dynamics_world.hpp"
#include "physics/dynamics/hull_plane.hpp"
#include "physics/dynamics/hull_solid.hpp"
#include "physics/dynamics/robot_model.hpp"
#include "physics/pose.hpp"
#include "physics/world_description.hpp"
#include "physics/world_values.hpp"

namespace kenaf::physics {

class Scene {
 public:
  Scene(const WorldDescription& description, const PhysicsSettings& settings);
  ~Scene();
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  void step(double time_step_s);

  void add_box(BoxId id, const Box& box);
  void remove_box(BoxId id);
  void move_box(BoxId id, const Pose& X_WBox);
  Pose box_pose(BoxId id) const;

  // Places the robot at `X_WB`, moved straight up until nothing touches it.
  void place_free(RobotModel& robot, Pose X_WB, bool start_joints);
  std::optional<RayHit> cast_ray(const Eigen::Vector3d& from_W, const Eigen::Vector3d& direction_W, double max_m,
                                 std::uint32_t ignored_robot) const;
  struct Touch {
    RobotId robot;
    Eigen::Vector3d p_W;
  };
  // The points where robots are pressed upon; one between two robots is there for both.
  void touches(std::vector<Touch>& out) const;
  // See World; the last step's length.
  void contacts(RobotId robot, double time_step_s, std::vector<ContactPoint>& out) const;
  std::size_t contact_count() const { return solver_.contacts().size(); }
  std::size_t pair_count() const { return static_cast<std::size_t>(pairs_.getNumOverlappingPairs()); }
  std::uint64_t pairs_left_out() const { return pairs_.left_out(); }  // so far

  btDiscreteDynamicsWorld& dynamics() { return world_; }
  ContactSolver& solver() { return solver_; }

 private:
  struct Fixture {
    std::unique_ptr<btCollisionShape> shape;
    std::unique_ptr<btRigidBody> body;
    std::unique_ptr<Collider> collider;
    btVector3 half;  // of a loose box
    ShapeTag tag;
  };
  // A fixed body of triangles; Bullet reads vertices and indices in place.
  struct MeshFixture {
    TriangleMesh mesh;
    btTriangleIndexVertexArray triangles;
    std::unique_ptr<MeshEdges> edges;
    ShapeTag tag;
    Fixture fixture;
  };
  void clear();  // of all bodies but robots'
  void add_mesh(const TriangleMesh& mesh);
  // A body without mass is fixed; otherwise it is a loose box. `kind`: 0, or kBoxes.
  void add_fixture(Fixture& fixture, double mass_kg, double friction, const Pose& X_W, int kind);
  // How far up the robot must go to be free, 0 if it is. Returns `search_step_m` if up is not the way out of a contact.
  double lift_needed(RobotModel& robot, double search_step_m);
  // Depth of a point below the surface of a mesh's solid, 0 outside of it.
  double depth_in_mesh(const Eigen::Vector3d& p_W) const;

  CollisionConfiguration configuration_;
  Dispatcher dispatcher_;
  HullPlaneContacts hull_plane_;
  HullSolidContacts hull_solid_;
  BeltGround belt_ground_;
  CompoundContacts compound_contacts_;
  PairTable pairs_;
  mutable btDbvtBroadphase broadphase_;  // rays only read it, which Bullet does not say
  ContactSolver solver_;
  DynamicsWorld world_;
  std::vector<Fixture> planes_;
  std::list<MeshFixture> meshes_;  // a list, as Bullet keeps pointers to them
  std::map<BoxId, Fixture> boxes_;
};

}  // namespace kenaf::physics
