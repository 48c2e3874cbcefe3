#include "physics/dynamics/robot_model.hpp"

#include <algorithm>
#include <cmath>

#include "physics/body_effects.hpp"
#include "physics/robot_shapes.hpp"

namespace kenaf::physics {
namespace {

constexpr int kFlipperPieces = 2;  // of a straight run, with contacts at the ends of each

// `lug_height_m` is the description's.
Surface belt_surface(const RobotDescription& robot, robot::Track side, double friction_along, double friction_across,
                     double lug_height_m, Belt* belt, double axis_y, TouchingPart part) {
  const Effects& effects = robot.effects;
  const double grip = side_factor(side, effects.friction_asymmetry);
  return {.friction_along = friction_along * effects.friction_along_scale * grip,
          .friction_across = friction_across * effects.friction_across_scale * grip,
          .belt = belt,
          .axis_y = axis_y,
          .lug_height_m = lug_height_m * effects.lug_height_scale,
          .shear_deformation_m = robot.track.front().shear_deformation_m + effects.shear_deformation_m,
          .compliance_scale = effects.ground_compliance_scale,
          .damping_scale = effects.ground_damping_scale,
          .part = part};
}

TouchingPart part_of(robot::Track side) {
  return side == robot::kLeft ? TouchingPart::left_track : TouchingPart::right_track;
}

TouchingPart part_of(robot::Flipper which) {
  const bool left = robot::side_of(which) == robot::kLeft;
  if (robot::is_front(which)) return left ? TouchingPart::front_left_flipper : TouchingPart::front_right_flipper;
  return left ? TouchingPart::rear_left_flipper : TouchingPart::rear_right_flipper;
}

std::unique_ptr<btRigidBody> make_body(double mass_kg, btCollisionShape& shape, const btVector3& inertia,
                                       Collider& collider) {
  auto body =
      std::make_unique<btRigidBody>(btRigidBody::btRigidBodyConstructionInfo(mass_kg, nullptr, &shape, inertia));
  body->setActivationState(DISABLE_DEACTIVATION);  // a track at 3 mm/s must not fall asleep
  body->setUserPointer(&collider);
  return body;
}

// Total current of all drives at standstill with full force.
double stalled_a(const RobotDescription& robot) {
  const Effects& effects = robot.effects;
  const double track = robot.drive.amperes_per_newton * robot.drive.max_force_n * effects.drive_torque_scale;
  const double flipper = robot.servo.amperes_per_nm * robot.servo.max_torque_nm * effects.flipper_torque_scale;
  return static_cast<double>(robot::kTrackCount) * track + static_cast<double>(robot.flipper_count()) * flipper;
}

}  // namespace

RobotModel::RobotModel(const RobotDescription& robot, const std::string& name, std::uint64_t world_seed,
                       double time_step_s, RobotId id, btDiscreteDynamicsWorld& world, ContactSolver& solver)
    : description(robot),
      world_(world),
      solver_(solver),
      channel_(robot.effects, world_seed, name, robot.track_gauge_m(), time_step_s),
      drives_{TrackDrive(robot::kLeft, robot.drive, robot.effects),
              TrackDrive(robot::kRight, robot.drive, robot.effects)},
      battery_(robot.battery, robot.effects.battery_resistance_ohm, stalled_a(robot)) {
  for (Belt& belt : belts_) belt.slip_spm = description.effects.slip_with_speed_spm;
  make_hull(id);
  for (const robot::Flipper which : {robot::kFrontLeft, robot::kFrontRight, robot::kRearLeft, robot::kRearRight})
    if (description.has(which)) make_flipper(which, id);
  enter_dynamics();
}

RobotModel::~RobotModel() {
  leave_dynamics();
}

void RobotModel::enter_dynamics() {
  if (in_dynamics_) return;
  in_dynamics_ = true;
  try {
    for (Belt& belt : belts_) solver_.add_belt(&belt, hull_.get());
    for (btRigidBody* body : body_list_) world_.addRigidBody(body);
    // The solver works in this order.
    for (const robot::Flipper which : {robot::kRearLeft, robot::kRearRight, robot::kFrontLeft, robot::kFrontRight})
      if (const auto& joint = flippers_[which].joint)
        world_.addConstraint(joint.get(), true);  // true: it does not collide with the hull
  } catch (...) {                                 // Bullet would keep pointers to what is in it already
    leave_dynamics();
    throw;
  }
}

// Also of a robot that is only partly in the dynamics.
void RobotModel::leave_dynamics() {
  if (!in_dynamics_) return;
  for (FlipperBody& flipper : flippers_)
    if (flipper.joint) world_.removeConstraint(flipper.joint.get());
  for (btRigidBody* body : body_list_) {
    solver_.forget_contacts_of(*body);
    world_.removeRigidBody(body);
  }
  for (Belt& belt : belts_) solver_.remove_belt(&belt);
  in_dynamics_ = false;
}

void RobotModel::make_hull(RobotId id) {
  const BodyDescription body = with_body_effects(description.body, description.effects);
  X_BCom_ = btTransform(btQuaternion::getIdentity(), to_bullet(body.p_BBcm_m));
  hull_collider_.robot = static_cast<std::uint32_t>(id);
  hull_shape_ = std::make_unique<btCompoundShape>(false);  // without a tree: it has few pieces

  // Main tracks or wheels; all of a side run with its belt.
  for (const robot::Track side : {robot::kLeft, robot::kRight}) {
    for (const TrackDescription& track : description.track) {
      add_belt_to_hull(track, track.center_m(side),
                       belt_surface(description, side, track.friction_along, track.friction_across, track.lug_height_m,
                                    &belts_[side], 1, part_of(side)));
    }
  }

  // Casters are wheels that slide, on a surface without a belt; the body between the tracks slides too.
  const auto sliding = [this](double friction, TouchingPart part) {
    return Surface{.friction_along = friction,
                   .friction_across = friction,
                   .compliance_scale = description.effects.ground_compliance_scale,
                   .damping_scale = description.effects.ground_damping_scale,
                   .part = part};
  };
  for (const CasterDescription& caster : description.caster)
    add_belt_to_hull(caster.as_wheel(), caster.p_BC_m, sliding(caster.friction, TouchingPart::caster));

  // A hull, not a btBoxShape, so that all of a robot meets the ground by the same algorithm.
  const Eigen::Vector2d half(body.size_m.x() / 2, body.size_m.z() / 2);
  add_to_hull(make_prism({{half.x(), -half.y()}, half, {-half.x(), half.y()}, -half}, body.size_m.y(), {0, 0, 0}),
              sliding(body.friction, TouchingPart::body));
  hull_ = make_body(body.mass_kg, *hull_shape_, to_bullet(body.inertia_kgm2), hull_collider_);
  body_list_.push_back(hull_.get());
}

void RobotModel::add_to_hull(std::unique_ptr<btConvexHullShape> shape, const Surface& surface) {
  hull_shape_->addChildShape(X_BCom_.inverse(), shape.get());
  hull_pieces_.push_back(std::move(shape));
  hull_collider_.surfaces.push_back(surface);
}

// A belt for the ground, and a prism for everything else.
void RobotModel::add_belt_to_hull(const TrackDescription& track, const Eigen::Vector3d& p_BT_m,
                                  const Surface& surface) {
  TaggedBelt& tagged = *hull_belts_.emplace_back(std::make_unique<TaggedBelt>());
  tagged.belt = {.radius = {track.end_radius_m, track.end_radius_m},
                 .length = track.straight_m(),
                 .half_width = track.width_m / 2,
                 .p_BodyT = to_bullet(Eigen::Vector3d(p_BT_m - Eigen::Vector3d(track.straight_m() / 2, 0, 0))),
                 .pieces = track.pieces,
                 .surface = surface};
  tagged.tag.belt = &tagged.belt;
  auto shape = make_prism(track_outline(track), track.width_m, p_BT_m);
  shape->setUserPointer(&tagged.tag);
  add_to_hull(std::move(shape), surface);
}

void RobotModel::make_flipper(robot::Flipper which, RobotId id) {
  const FlipperDescription& f = description.flipper.front();
  FlipperBody& flipper = flippers_[which];
  const Outline outline = flipper_outline(f);
  const OutlineMoments m = moments(outline);
  const Eigen::Vector3d com(m.centroid.x(), 0, m.centroid.y());
  const robot::Track side = robot::side_of(which);

  // A rear flipper is a front one turned by 180 degrees: x out along the arm, tip up about -y for all four.
  const bool front = robot::is_front(which);
  const Eigen::Vector3d pivot(front ? f.p_BPivot_m.x() : -f.p_BPivot_m.x(),
                              side == robot::kLeft ? f.p_BPivot_m.y() : -f.p_BPivot_m.y(), f.p_BPivot_m.z());
  const btQuaternion turn = front ? btQuaternion::getIdentity() : btQuaternion(0, 0, 1, 0);
  flipper.X_BodyPivot = btTransform(turn, to_bullet(pivot));
  flipper.X_FlipperCom = btTransform(btQuaternion::getIdentity(), to_bullet(com));

  // Collision shape and belt, with the centre of mass as origin.
  flipper.shape = make_prism(outline, f.width_m, -com);
  flipper.collider.robot = static_cast<std::uint32_t>(id);
  const Surface surface =
      belt_surface(description, side, f.friction_along, f.friction_across, description.track.front().lug_height_m,
                   f.belt_driven ? &belts_[side] : nullptr, front ? 1 : -1, part_of(which));
  flipper.collider.surfaces = {surface};
  flipper.belt = {.radius = {f.pivot_radius_m, f.tip_radius_m},
                  .length = f.length_m,
                  .half_width = f.width_m / 2,
                  .p_BodyT = to_bullet(Eigen::Vector3d(-com)),
                  .pieces = kFlipperPieces,
                  .surface = surface};
  flipper.tag.belt = &flipper.belt;
  flipper.shape->setUserPointer(&flipper.tag);

  // Body of uniform density, from the outline's second moments per area, and its joint to the hull.
  const double xx = m.Ixx / m.area, zz = m.Izz / m.area, yy = f.width_m * f.width_m / 12;
  flipper.body =
      make_body(f.mass_kg, *flipper.shape, f.mass_kg * btVector3(zz + yy, xx + zz, xx + yy), flipper.collider);
  body_list_.push_back(flipper.body.get());
  flipper.joint = std::make_unique<FlipperJoint>(
      *hull_, *flipper.body, X_BCom_.inverse() * flipper.X_BodyPivot, flipper.X_FlipperCom.inverse(),
      ServoCoupling{.lag_s = description.effects.flipper_lag_s,
                    .play_rad = description.effects.flipper_backlash_rad,
                    .compliance_radpnm = description.effects.flipper_compliance_radpnm});
}

void RobotModel::place(const Pose& X_WB, bool start_joints) {
  enter_dynamics();
  const auto put = [this](btRigidBody& body, const btTransform& X) {
    body.setWorldTransform(X);
    body.setInterpolationWorldTransform(X);
    body.setLinearVelocity({0, 0, 0});
    body.setAngularVelocity({0, 0, 0});
    body.setInterpolationLinearVelocity({0, 0, 0});
    body.setInterpolationAngularVelocity({0, 0, 0});
    body.clearForces();
    body.updateInertiaTensor();
    // Contacts of the old place must neither pull on it nor be felt by a sensor.
    solver_.forget_contacts_of(body);
    world_.getBroadphase()->getOverlappingPairCache()->cleanProxyFromPairs(body.getBroadphaseHandle(),
                                                                           world_.getDispatcher());
    world_.updateSingleAabb(&body);
  };

  // Bodies, belts and drives at rest.
  const btTransform X = to_bullet(X_WB);
  put(*hull_, X * X_BCom_);
  for (FlipperBody& flipper : flippers_) {
    if (!flipper.body) continue;
    const double angle = start_joints ? description.flipper.front().start_angle_rad : flipper.joint->angle_rad();
    const btTransform tip_up(btQuaternion(btVector3(0, -1, 0), angle));
    put(*flipper.body, X * flipper.X_BodyPivot * tip_up * flipper.X_FlipperCom);
    if (start_joints)
      flipper.joint->restart(angle);
    else
      flipper.joint->come_to_rest();
  }
  for (const robot::Track side : {robot::kLeft, robot::kRight}) {
    belts_[side].speed_mps = 0;
    belts_[side].motor_impulse_ns = 0;
    drives_[side].turn_at(0);
  }

  // Commands: a fresh start holds the start angles; otherwise commands that are under way still arrive.
  prescribed_ = {};
  channel_.stop_ramp();
  if (start_joints) {
    robot::Command rest;
    for (robot::JointCommand& joint : rest.flipper)
      joint = {robot::JointMode::angle, description.has_flippers() ? description.flipper.front().start_angle_rad : 0.0};
    channel_.restart(rest);
  }
}

void RobotModel::set_in_motion(const RobotMotion& motion, const robot::Command& command) {
  // All bodies move as one rigid body: v + w x (p_com - p_WB).
  const btVector3 v = to_bullet(motion.v_WB_mps), w = to_bullet(motion.w_WB_radps);
  const btVector3 p_WB = (hull_->getWorldTransform() * X_BCom_.inverse()).getOrigin();
  for (btRigidBody* body : body_list_) {
    const btVector3 v_com = v + w.cross(body->getWorldTransform().getOrigin() - p_WB);
    body->setLinearVelocity(v_com);
    body->setAngularVelocity(w);
    body->setInterpolationLinearVelocity(v_com);
    body->setInterpolationAngularVelocity(w);
  }

  // Belts at their speeds, with drives and channel as if they had been commanded so for long.
  std::array<double, robot::kTrackCount> output_mps{};  // the channel's output for these speeds
  for (const robot::Track side : {robot::kLeft, robot::kRight}) {
    belts_[side].speed_mps = motion.track_mps[side];
    belts_[side].motor_impulse_ns = 0;
    drives_[side].turn_at(motion.track_mps[side]);
    output_mps[side] = motion.track_mps[side] / favour(side);
  }
  channel_.begin(command, output_mps);
}

// A servo's speed and torque scale with the voltage, as a track motor's do.
FlipperServoDescription RobotModel::servo_now() const {
  FlipperServoDescription servo = description.servo;
  servo.max_torque_nm *= description.effects.flipper_torque_scale * battery_.voltage_share();
  servo.max_speed_radps *= battery_.voltage_share();
  return servo;
}

void RobotModel::before_step(double time_step_s) {
  const robot::Command& command = channel_.step();
  for (const robot::Track side : {robot::kLeft, robot::kRight}) {
    if (prescribed_.track_mps[side])
      drives_[side].prescribe(belts_[side], *prescribed_.track_mps[side]);
    else
      drives_[side].before_step(belts_[side], command.track_speed_mps[side] * favour(side), battery_.voltage_share(),
                                time_step_s);
  }
  if (!description.has_flippers()) return;
  const FlipperServoDescription servo = servo_now();
  for (std::size_t i = 0; i < robot::kFlipperCount; ++i) {
    if (!flippers_[i].joint) continue;
    if (prescribed_.flipper_rad[i])
      flippers_[i].joint->prescribe(*prescribed_.flipper_rad[i], time_step_s);
    else
      flippers_[i].joint->drive(command.flipper[i], description.flipper.front(), servo, time_step_s);
  }
}

void RobotModel::after_step(double time_step_s) {
  for (const robot::Track side : {robot::kLeft, robot::kRight}) drives_[side].after_step(belts_[side], time_step_s);
  for (FlipperBody& flipper : flippers_)
    if (flipper.joint) flipper.joint->after_step(time_step_s);
  battery_.after_step(battery_current_a(time_step_s), time_step_s);
}

double RobotModel::track_current_a(robot::Track track, double time_step_s) const {
  return drives_[track].current_a(belts_[track], time_step_s);
}

double RobotModel::flipper_current_a(robot::Flipper flipper, double time_step_s) const {
  const auto& joint = flippers_[flipper].joint;
  return joint ? description.servo.amperes_per_nm * std::abs(joint->servo_nm(time_step_s)) : 0;
}

double RobotModel::battery_current_a(double time_step_s) const {
  const double voltage = battery_.voltage_share();
  double current = 0;
  for (const robot::Track side : {robot::kLeft, robot::kRight})
    current += drives_[side].battery_current_a(belts_[side], voltage, time_step_s);
  const double most_nm = description.servo.max_torque_nm * description.effects.flipper_torque_scale;
  for (const robot::Flipper which : {robot::kFrontLeft, robot::kFrontRight, robot::kRearLeft, robot::kRearRight}) {
    const auto& joint = flippers_[which].joint;
    if (!joint) continue;
    const double torque = joint->servo_nm(time_step_s), speed = joint->speed_radps();
    current +=
        physics::battery_current_a(flipper_current_a(which, time_step_s), std::abs(torque) / most_nm,
                                   std::copysign(speed / description.servo.max_speed_radps, torque * speed), voltage);
  }
  return current;
}

RobotTruth RobotModel::truth(double time_step_s) const {
  RobotTruth truth{};
  const btTransform X_WB = hull_->getWorldTransform() * X_BCom_.inverse();
  truth.X_WB = from_bullet(X_WB);
  truth.w_WB_radps = from_bullet(hull_->getAngularVelocity());
  truth.v_WB_mps =
      from_bullet(hull_->getVelocityInLocalPoint(X_WB.getOrigin() - hull_->getWorldTransform().getOrigin()));
  for (const robot::Track side : {robot::kLeft, robot::kRight}) {
    truth.track_mps[side] = belts_[side].speed_mps;
    truth.track_m[side] = drives_[side].travel_m();
    truth.track_force_n[side] = belts_[side].motor_impulse_ns / time_step_s;
  }
  for (std::size_t i = 0; i < robot::kFlipperCount; ++i) {
    if (!flippers_[i].joint) continue;
    truth.flipper_rad[i] = flippers_[i].joint->angle_rad();
    truth.servo_rad[i] = flippers_[i].joint->servo_rad();
    truth.flipper_radps[i] = flippers_[i].joint->speed_radps();
    truth.flipper_nm[i] = flippers_[i].joint->torque_nm(time_step_s);
  }
  truth.battery_v = battery_.voltage_v();
  truth.battery_left_s = battery_.left_s();
  return truth;
}

}  // namespace kenaf::physics
