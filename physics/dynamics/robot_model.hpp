// One robot as Bullet bodies: hull with main tracks or wheels, its flippers on joints, and the belts' drives.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "physics/dynamics/battery.hpp"
#include "physics/dynamics/belt_ground.hpp"
#include "physics/dynamics/bullet.hpp"
#include "physics/dynamics/command_channel.hpp"
#include "physics/dynamics/contact_solver.hpp"
#include "physics/dynamics/drive.hpp"
#include "physics/dynamics/flipper_joint.hpp"
#include "physics/pose.hpp"
#include "physics/prescribed_motion.hpp"
#include "physics/robot_description.hpp"
#include "physics/world_values.hpp"
#include "robot/command.hpp"

namespace kenaf::physics {

class RobotModel {
 public:
  // `name` and `world_seed` seed the random numbers; all later steps have this time step.
  RobotModel(const RobotDescription& description, const std::string& name, std::uint64_t world_seed, double time_step_s,
             RobotId id, btDiscreteDynamicsWorld& world, ContactSolver& solver);
  ~RobotModel();
  RobotModel(const RobotModel&) = delete;
  RobotModel& operator=(const RobotModel&) = delete;

  // Places it at rest, with joints at their start angles if `start_joints`, else at their present ones.
  void place(const Pose& X_WB, bool start_joints);

  void send(const robot::Command& command) { channel_.send(command); }
  // See World.
  void set_in_motion(const RobotMotion& motion, const robot::Command& command);
  void prescribe(const PrescribedMotion& motion) { prescribed_ = motion; }
  void before_step(double time_step_s);
  void after_step(double time_step_s);

  RobotTruth truth(double time_step_s) const;
  double track_current_a(robot::Track track, double time_step_s) const;
  double flipper_current_a(robot::Flipper flipper, double time_step_s) const;

  const std::vector<btRigidBody*>& bodies() const { return body_list_; }

  // Takes it out of the dynamics, where it stands still and nothing collides with it; place() puts it back.
  void leave_dynamics();

  const RobotDescription description;

 private:
  struct FlipperBody {
    std::unique_ptr<btConvexHullShape> shape;
    std::unique_ptr<btRigidBody> body;
    std::unique_ptr<FlipperJoint> joint;
    Collider collider;
    BeltShape belt;
    ShapeTag tag;
    btTransform X_FlipperCom;  // the flipper's frame (x out along the arm) to its centre of mass
    btTransform X_BodyPivot;   // pose of that frame in B at angle 0
  };

  void enter_dynamics();
  void make_hull(RobotId id);
  void add_to_hull(std::unique_ptr<btConvexHullShape> shape, const Surface& surface);
  void add_belt_to_hull(const TrackDescription& track, const Eigen::Vector3d& p_BT_m, const Surface& surface);
  void make_flipper(robot::Flipper which, RobotId id);
  FlipperServoDescription servo_now() const;
  // Factor on a track's commanded speed.
  double favour(robot::Track side) const { return side_factor(side, description.effects.drive_asymmetry); }
  double battery_current_a(double time_step_s) const;

  btDiscreteDynamicsWorld& world_;
  ContactSolver& solver_;
  std::vector<std::unique_ptr<btCollisionShape>> hull_pieces_;
  // A part of the hull: a track, a wheel or a caster.
  struct TaggedBelt {
    BeltShape belt;
    ShapeTag tag;
  };
  std::vector<std::unique_ptr<TaggedBelt>> hull_belts_;
  std::unique_ptr<btCompoundShape> hull_shape_;
  std::unique_ptr<btRigidBody> hull_;
  Collider hull_collider_;
  btTransform X_BCom_;
  std::array<FlipperBody, robot::kFlipperCount> flippers_;
  std::array<Belt, robot::kTrackCount> belts_;
  CommandChannel channel_;
  PrescribedMotion prescribed_;
  std::array<TrackDrive, robot::kTrackCount> drives_;
  Battery battery_;
  std::vector<btRigidBody*> body_list_;
  bool in_dynamics_ = false;
};

}  // namespace kenaf::physics
