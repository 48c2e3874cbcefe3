#include <ode/ode.h>

#include <array>
#include <cmath>
#include <cstdarg>
#include <mutex>
#include <stdexcept>

#include "rollout/engines/runner.hpp"

namespace kenaf::engines {
namespace {

using namespace physics;

enum class Stepper { quick, world };  // projected Gauss-Seidel, or Dantzig's exact solver

struct Options {
  Stepper stepper;
  int iterations;
  bool boxes;  // a row of boxes between the drums instead of one
  bool repeatable = false;
};

std::mutex& generator_in_use() {
  static std::mutex mutex;
  return mutex;
}

// The same contact compliance as Kenaf's (PhysicsSettings). In ODE's terms, with a step h:
//   ERP = h k / (h k + d)      CFM = 1 / (h k + d)
constexpr double kStiffness_npm = 2e5, kDamping_nspm = 1000;

struct Surface {
  double friction_along = 1, friction_across = 1;
  std::optional<robot::Track> belt;
};

void quaternion(const Eigen::Quaterniond& q, dQuaternion out) {
  out[0] = q.w(), out[1] = q.x(), out[2] = q.y(), out[3] = q.z();
}
Eigen::Vector3d vector(const dReal* v) {
  return {v[0], v[1], v[2]};
}
Eigen::Quaterniond rotation(const dReal* q) {
  return {q[0], q[1], q[2], q[3]};
}

class OdeRunner : public Runner {
 public:
  OdeRunner(const EngineScene& scene, const Options& options)
      : options_(options), time_step_s_(scene.time_step_s), drives_(scene) {
    static const bool initialised = [] {
      // WorldStep reports "LCP internal error" for redundant contacts, thousands of times, and goes on
      dSetMessageHandler([](int, const char*, va_list) {});
      return dInitODE2(0) != 0;
    }();
    if (!initialised) throw std::runtime_error("ODE does not start");

    // The world; terrain and moving bodies in spaces of their own, which are collided with each other only.
    world_ = dWorldCreate();
    terrain_ = dSimpleSpaceCreate(nullptr);
    moving_ = dSimpleSpaceCreate(nullptr);
    contacts_ = dJointGroupCreate(0);
    const Eigen::Vector3d& g = scene.world.gravity_W_mps2;
    dWorldSetGravity(world_, g.x(), g.y(), g.z());
    dWorldSetQuickStepNumIterations(world_, options.iterations);
    const double stiffness = kStiffness_npm * time_step_s_ + kDamping_nspm;
    soft_erp_ = kStiffness_npm * time_step_s_ / stiffness;
    soft_cfm_ = 1 / stiffness;

    // Ground: each piece has its own friction, which multiplies that of what touches it.
    ground_friction_.reserve(scene.world.planes.size() + scene.world.boxes.size());
    const auto add_ground = [&](dGeomID geom, double friction) {
      ground_friction_.push_back(friction);
      dGeomSetData(geom, &ground_friction_.back());
    };
    for (const GroundPlane& plane : scene.world.planes) {
      const Eigen::Vector3d n = plane.X_WP.q * Eigen::Vector3d::UnitZ();
      add_ground(dCreatePlane(terrain_, n.x(), n.y(), n.z(), n.dot(plane.X_WP.p)), plane.friction);
    }
    for (const Box& box : scene.world.boxes) {
      dGeomID geom = dCreateBox(terrain_, box.size_m.x(), box.size_m.y(), box.size_m.z());
      dQuaternion q;
      quaternion(box.X_WBox.q, q);
      dGeomSetPosition(geom, box.X_WBox.p.x(), box.X_WBox.p.y(), box.X_WBox.p.z());
      dGeomSetQuaternion(geom, q);
      add_ground(geom, box.friction);
    }
    if (scene.robot)
      add_robot(scene);
    else
      add_block(*scene.block);
  }
  ~OdeRunner() override {
    dJointGroupDestroy(contacts_);
    dWorldDestroy(world_);
    dSpaceDestroy(terrain_);
    dSpaceDestroy(moving_);
  }
  OdeRunner(const OdeRunner&) = delete;
  OdeRunner& operator=(const OdeRunner&) = delete;

  void step() override {
    drives_.advance();
    for (std::size_t i = 0; i < hinges_.size(); ++i)
      dJointSetHingeParam(hinges_[i], dParamVel,
                          drives_.flipper_radps(i, start_rad_[i] + dJointGetHingeAngle(hinges_[i])));
    belt_axis_W_ = rotation(dBodyGetQuaternion(main_)) * Eigen::Vector3d::UnitY();
    contact_count_ = 0;
    dSpaceCollide2(reinterpret_cast<dGeomID>(moving_), reinterpret_cast<dGeomID>(terrain_), this, &near);
    if (options_.stepper == Stepper::quick)
      quick_step();
    else
      dWorldStep(world_, time_step_s_);
    dJointGroupEmpty(contacts_);
  }
  std::size_t contacts() const override { return contact_count_; }
  Pose pose() const override {
    const Eigen::Quaterniond q = rotation(dBodyGetQuaternion(main_));
    return {vector(dBodyGetPosition(main_)) - q * p_com_m_, q};
  }

 private:
  // `X_WCom` is the pose of the centre of mass, ODE's body origin.
  dBodyID add_body(double mass_kg, const Eigen::Vector3d& inertia, const Pose& X_WCom) {
    dBodyID body = dBodyCreate(world_);
    dMass mass;
    dMassSetParameters(&mass, mass_kg, 0, 0, 0, inertia.x(), inertia.y(), inertia.z(), 0, 0, 0);
    dBodySetMass(body, &mass);
    dQuaternion q;
    quaternion(X_WCom.q, q);
    dBodySetPosition(body, X_WCom.p.x(), X_WCom.p.y(), X_WCom.p.z());
    dBodySetQuaternion(body, q);
    return body;
  }

  void add_geom(dGeomID geom, dBodyID body, const Eigen::Vector3d& p_ComGeom, const Surface& surface) {
    dGeomSetBody(geom, body);
    dGeomSetOffsetPosition(geom, p_ComGeom.x(), p_ComGeom.y(), p_ComGeom.z());
    surfaces_.push_back(std::make_unique<Surface>(surface));
    dGeomSetData(geom, surfaces_.back().get());
  }

  void add_belted(const Belted& b, dBodyID body, const Eigen::Vector3d& p_com) {
    const Surface surface{b.friction_along, b.friction_across, b.belt};
    for (const Cuboid& c : straight_part(b, options_.boxes ? b.boxes : 1))
      add_geom(dCreateBox(moving_, c.size_m.x(), c.size_m.y(), c.size_m.z()), body, c.center_m - p_com, surface);
    const auto drum = [&](const Eigen::Vector3d& p, double radius) {
      dGeomID geom = dCreateCylinder(moving_, radius, b.width_m);
      add_geom(geom, body, p - p_com, surface);
      dQuaternion along_y;
      dQFromAxisAndAngle(along_y, 1, 0, 0, M_PI / 2);
      dGeomSetOffsetQuaternion(geom, along_y);
    };
    drum(b.p_rear_m, b.rear_radius_m);
    if (b.boxes > 0) drum(b.p_front_m, b.front_radius_m);
  }

  void add_block(const Box& block) {
    const Eigen::Vector3d& s = block.size_m;
    const Eigen::Vector3d inertia =
        block.mass_kg / 12 *
        Eigen::Vector3d(s.y() * s.y() + s.z() * s.z(), s.x() * s.x() + s.z() * s.z(), s.x() * s.x() + s.y() * s.y());
    main_ = add_body(block.mass_kg, inertia, block.X_WBox);
    add_geom(dCreateBox(moving_, s.x(), s.y(), s.z()), main_, {0, 0, 0}, {block.friction, block.friction, {}});
  }

  void add_robot(const EngineScene& scene) {
    // The hull with its tracks is one body. ODE's bodies have their origin at the centre of mass.
    const RobotDescription& robot = *scene.robot;
    const RobotParts parts = parts_of(robot);
    const auto com_at = [](const Pose& X, const Eigen::Vector3d& p) { return Pose{X.p + X.q * p, X.q}; };
    p_com_m_ = robot.body.p_BBcm_m;
    main_ = add_body(robot.body.mass_kg, robot.body.inertia_kgm2, com_at(scene.X_start, p_com_m_));
    const Eigen::Vector3d& s = robot.body.size_m;
    add_geom(dCreateBox(moving_, s.x(), s.y(), s.z()), main_, -p_com_m_,
             {robot.body.friction, robot.body.friction, {}});
    for (const Belted& track : parts.tracks) add_belted(track, main_, p_com_m_);

    // Each flipper is a body on a hinge about -y, positive tip up, whose motor has the servo's torque.
    for (const Arm& arm : parts.arms) {
      start_rad_.push_back(flipper_at_start(scene, start_rad_.size()));
      const Eigen::Quaterniond tip_up(Eigen::AngleAxisd(start_rad_.back(), -Eigen::Vector3d::UnitY()));
      const Pose X_WArm = compose(scene.X_start, {arm.X_BArm.p, arm.X_BArm.q * tip_up});
      dBodyID body = add_body(arm.mass_kg, arm.inertia_kgm2, com_at(X_WArm, arm.p_com_m));
      add_belted(arm.shape, body, arm.p_com_m);
      dJointID hinge = dJointCreateHinge(world_, nullptr);
      dJointAttach(hinge, body, main_);
      dJointSetHingeAnchor(hinge, X_WArm.p.x(), X_WArm.p.y(), X_WArm.p.z());
      const Eigen::Vector3d axis = X_WArm.q * -Eigen::Vector3d::UnitY();
      dJointSetHingeAxis(hinge, axis.x(), axis.y(), axis.z());
      dJointSetHingeParam(hinge, dParamFMax, servo_torque_nm(scene));
      hinges_.push_back(hinge);
    }
  }

  void quick_step() {
    std::unique_lock lock(generator_in_use(), std::defer_lock);
    if (options_.repeatable) {
      lock.lock();
      dRandSetSeed(1);
    }
    dWorldQuickStep(world_, time_step_s_);
  }

  static void near(void* self, dGeomID moving, dGeomID fixed) { static_cast<OdeRunner*>(self)->touch(moving, fixed); }

  // A contact joint for each point, valid for one step; a belt moves its surface along fdir1.
  void touch(dGeomID moving, dGeomID fixed) {
    if (!dGeomGetBody(moving)) std::swap(moving, fixed);
    constexpr int kMost = 8;
    dContact contact[kMost];
    const int count = dCollide(moving, fixed, kMost, &contact[0].geom, sizeof(dContact));
    const Surface& surface = *static_cast<const Surface*>(dGeomGetData(moving));
    const double ground = *static_cast<const double*>(dGeomGetData(fixed));
    for (int i = 0; i < count; ++i) {
      dSurfaceParameters& s = contact[i].surface;
      s.mode = dContactApprox1 | dContactSoftERP | dContactSoftCFM;
      s.soft_erp = soft_erp_;
      s.soft_cfm = soft_cfm_;
      s.mu = surface.friction_along * ground;
      if (surface.belt) {
        // ODE's normal points into the moving body, so the outward normal is its negative. ODE drives the first body's
        // speed along fdir1, relative to the second, towards motion1.
        const Eigen::Vector3d along = (-vector(contact[i].geom.normal)).cross(belt_axis_W_);
        const double length = along.norm();
        if (length > 0.1) {  // else a side face
          s.mode |= dContactMu2 | dContactFDir1 | dContactMotion1;
          s.mu2 = surface.friction_across * ground;
          s.motion1 = drives_.belt_mps(*surface.belt) * length;
          for (int k = 0; k < 3; ++k) contact[i].fdir1[k] = along[k] / length;
        }
      }
      dJointAttach(dJointCreateContact(world_, contacts_, &contact[i]), dGeomGetBody(moving), nullptr);
    }
    contact_count_ += static_cast<std::size_t>(count);
  }

  Options options_;
  double time_step_s_, soft_erp_ = 0, soft_cfm_ = 0;
  std::vector<double> start_rad_;  // of each flipper
  Drives drives_;
  dWorldID world_{};
  dSpaceID terrain_{}, moving_{};
  dJointGroupID contacts_{};
  dBodyID main_{};
  Eigen::Vector3d p_com_m_{0, 0, 0}, belt_axis_W_{0, 1, 0};
  std::vector<dJointID> hinges_;
  std::vector<std::unique_ptr<Surface>> surfaces_;
  std::vector<double> ground_friction_;  // of each piece; geoms point to its elements
  std::size_t contact_count_ = 0;
};

Engine engine(const char* setting, const Options& options) {
  return {"ODE", KENAF_ODE_VERSION, setting, options.boxes,
          [options](const EngineScene& scene) -> std::unique_ptr<Runner> {
            return std::make_unique<OdeRunner>(scene, options);
          }};
}
}  // namespace

Engine repeatable_ode_engine() {
  return engine("QuickStep, 50 iterations, repeatable", {Stepper::quick, 50, true, true});
}

std::vector<Engine> ode_engines() {
  return {engine("QuickStep, 10 iterations", {Stepper::quick, 10, true}),
          engine("QuickStep, 20 iterations", {Stepper::quick, 20, true}),
          engine("QuickStep, 50 iterations", {Stepper::quick, 50, true}),
          engine("WorldStep", {Stepper::world, 0, true}),
          engine("QuickStep, 10 it.; 1 box a belly", {Stepper::quick, 10, false}),
          engine("QuickStep, 20 it.; 1 box a belly", {Stepper::quick, 20, false}),
          engine("QuickStep, 50 it.; 1 box a belly", {Stepper::quick, 50, false}),
          engine("WorldStep; 1 box a belly", {Stepper::world, 0, false})};
}

}  // namespace kenaf::engines
