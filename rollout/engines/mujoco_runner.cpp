#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <cstring>
#include <optional>
#include <stdexcept>

#include "rollout/engines/runner.hpp"

namespace kenaf::engines {
namespace {

using namespace physics;

// Shapes of a belt: two cylinders with a row of boxes or one box between them, or one convex mesh.
enum class Shapes { boxes, box, hull };

struct Options {
  const char* solver;
  const char* cone;
  Shapes shapes;
  int iterations = 100;  // at most; MuJoCo's default
};

// Damping of the servo; with more, explicit integration would be close to its stability limit at 1 ms.
constexpr double kServoDamping_nms = 5;

std::string text(const Eigen::Vector3d& v) {
  return fmt::format("{} {} {}", v.x(), v.y(), v.z());
}
std::string placed(const Pose& X) {
  return fmt::format("pos=\"{}\" quat=\"{} {} {} {}\"", text(X.p), X.q.w(), X.q.x(), X.q.y(), X.q.z());
}
std::string inertial(double mass_kg, const Eigen::Vector3d& com, const Eigen::Vector3d& inertia) {
  return fmt::format("<inertial pos=\"{}\" mass=\"{}\" diaginertia=\"{}\"/>", text(com), mass_kg, text(inertia));
}

// MuJoCo takes a contact's friction from one of its two geoms and cannot multiply both: all ground must be alike.
double friction_of_all_ground(const WorldDescription& world) {
  std::optional<double> friction;
  const auto add = [&](double other) {
    if (friction.value_or(other) != other)
      throw std::invalid_argument(
          fmt::format("MuJoCo: the ground must have one friction, this world has {} and {}", *friction, other));
    friction = other;
  };
  for (const GroundPlane& plane : world.planes) add(plane.friction);
  for (const Box& box : world.boxes) add(box.friction);
  return friction.value_or(1);
}

// The scene as MJCF. A geom's `user` is 1 + the track whose belt it is, or 0. A contact has the friction of the side
// with the higher priority: robot and block, whose coefficients are already multiplied by the terrain's.
class ModelText {
 public:
  ModelText(const EngineScene& scene, const Options& options)
      : options_(options), friction_(friction_of_all_ground(scene.world)) {
    for (const GroundPlane& plane : scene.world.planes) {
      terrain_ +=
          fmt::format("<geom type=\"plane\" size=\"0 0 1\" {} contype=\"2\" conaffinity=\"1\"/>", placed(plane.X_WP));
    }
    for (const Box& box : scene.world.boxes) {
      terrain_ += fmt::format("<geom type=\"box\" size=\"{}\" {} contype=\"2\" conaffinity=\"1\"/>",
                              text(box.size_m / 2), placed(box.X_WBox));
    }
    if (scene.robot)
      add_robot(scene);
    else
      add_block(*scene.block);
    xml = fmt::format(
        "<mujoco><option timestep=\"{}\" gravity=\"{}\" solver=\"{}\" cone=\"{}\" iterations=\"{}\"/>"
        "<size nconmax=\"300\" njmax=\"1500\" nuser_geom=\"1\"/><asset>{}</asset>"
        "<worldbody>{}{}</worldbody><actuator>{}</actuator><equality>{}</equality></mujoco>",
        scene.time_step_s, text(scene.world.gravity_W_mps2), options.solver, options.cone, options.iterations, assets_,
        terrain_, bodies_, actuators_, held_);
  }
  std::string xml;

 private:
  void add_block(const Box& block) {
    const Eigen::Vector3d& s = block.size_m;
    const Eigen::Vector3d inertia =
        block.mass_kg / 12 *
        Eigen::Vector3d(s.y() * s.y() + s.z() * s.z(), s.x() * s.x() + s.z() * s.z(), s.x() * s.x() + s.y() * s.y());
    bodies_ = fmt::format("<body {}><freejoint/>{}{}</body>", placed(block.X_WBox),
                          inertial(block.mass_kg, Eigen::Vector3d::Zero(), inertia),
                          geom("box", "", Eigen::Vector3d::Zero(), s / 2, block.friction, 0));
  }

  void add_robot(const EngineScene& scene) {
    const RobotDescription& robot = *scene.robot;
    const RobotParts parts = parts_of(robot);
    bodies_ = fmt::format("<body {}><freejoint/>{}{}", placed(scene.X_start),
                          inertial(robot.body.mass_kg, robot.body.p_BBcm_m, robot.body.inertia_kgm2),
                          geom("box", "", Eigen::Vector3d::Zero(), robot.body.size_m / 2, robot.body.friction, 0));
    for (const Belted& track : parts.tracks) bodies_ += belted(track);
    for (const Arm& arm : parts.arms) {
      const std::string joint = fmt::format("flipper{}", joints_++);
      bodies_ +=
          fmt::format("<body {}><joint name=\"{}\" type=\"hinge\" axis=\"0 -1 0\"/>{}{}</body>", placed(arm.X_BArm),
                      joint, inertial(arm.mass_kg, arm.p_com_m, arm.inertia_kgm2), belted(arm.shape));
      // A prescribed arm is held rigidly, so that it is where the robot's columns say.
      if (!scene.prescribed.empty()) {
        held_ += fmt::format("<joint joint1=\"{}\" solref=\"{} 1\" solimp=\"0.999 0.999 0.001\"/>", joint,
                             2 * scene.time_step_s);
        continue;
      }
      actuators_ += fmt::format(
          "<general joint=\"{0}\" gainprm=\"{1}\" biastype=\"affine\" biasprm=\"0 0 -{1}\" forcelimited=\"true\" "
          "forcerange=\"-{2} {2}\"/>",
          joint, kServoDamping_nms, robot.servo.max_torque_nm);
    }
    bodies_ += "</body>";
  }

  std::string geom(const char* type, const std::string& more, const Eigen::Vector3d& p, const Eigen::Vector3d& size,
                   double friction, int belt) {
    return fmt::format(
        "<geom type=\"{}\" {} pos=\"{}\" size=\"{}\" friction=\"{} 0.005 0.0001\" user=\"{}\" priority=\"1\" "
        "contype=\"1\" conaffinity=\"2\"/>",
        type, more, text(p), text(size), friction * friction_, belt);
  }

  std::string belted(const Belted& b) {
    const int belt = b.belt ? 1 + static_cast<int>(*b.belt) : 0;
    if (options_.shapes == Shapes::hull) {
      const std::string name = fmt::format("hull{}", meshes_++);
      std::string vertices;
      for (const Eigen::Vector3d& p : b.hull_m) vertices += text(p) + " ";
      assets_ += fmt::format("<mesh name=\"{}\" vertex=\"{}\"/>", name, vertices);
      return geom("mesh", fmt::format("mesh=\"{}\"", name), Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones(),
                  b.friction_along, belt);
    }
    std::string geoms;
    for (const Cuboid& c : straight_part(b, options_.shapes == Shapes::boxes ? b.boxes : 1))
      geoms += geom("box", "", c.center_m, c.size_m / 2, b.friction_along, belt);
    const std::string along_y = "euler=\"90 0 0\"";
    geoms += geom("cylinder", along_y, b.p_rear_m, {b.rear_radius_m, b.width_m / 2, 0}, b.friction_along, belt);
    if (b.boxes == 0) return geoms;  // a wheel
    return geoms + geom("cylinder", along_y, b.p_front_m, {b.front_radius_m, b.width_m / 2, 0}, b.friction_along, belt);
  }

  Options options_;
  std::string assets_, terrain_, bodies_, actuators_, held_;
  double friction_;  // of all ground
  int joints_ = 0, meshes_ = 0;
};

class MujocoRunner : public Runner {
 public:
  MujocoRunner(const EngineScene& scene, const Options& options)
      : drives_(scene), pyramidal_(std::strcmp(options.cone, "pyramidal") == 0) {
    const ModelText text(scene, options);
    auto files = std::make_unique<mjVFS>();  // a megabyte
    mj_defaultVFS(files.get());
    constexpr const char* kName = "scene.xml";
    mj_makeEmptyFileVFS(files.get(), kName, static_cast<int>(text.xml.size()));
    // NOLINTNEXTLINE(bugprone-not-null-terminated-result): a file has its size
    std::memcpy(files->filedata[mj_findFileVFS(files.get(), kName)], text.xml.data(), text.xml.size());
    char error[1000] = "";
    model_.reset(mj_loadXML(kName, files.get(), error, sizeof error));
    mj_deleteVFS(files.get());
    if (!model_) throw std::runtime_error(fmt::format("MuJoCo: {}", error));
    data_.reset(mj_makeData(model_.get()));
    servos_ = static_cast<std::size_t>(model_->nu);
    held_ = static_cast<std::size_t>(model_->neq);
    for (std::size_t i = 0; i < servos_ + held_; ++i) data_->qpos[7 + i] = flipper_at_start(scene, i);
  }

  void step() override {
    drives_.advance();
    for (std::size_t i = 0; i < servos_; ++i) data_->ctrl[i] = drives_.flipper_radps(i, data_->qpos[7 + i]);
    for (std::size_t i = 0; i < held_; ++i) model_->eq_data[mjNEQDATA * i] = drives_.flipper_rad(i);
    mj_step1(model_.get(), data_.get());
    move_belts();
    mj_step2(model_.get(), data_.get());
  }
  std::size_t contacts() const override { return static_cast<std::size_t>(data_->ncon); }
  Pose pose() const override {
    const mjtNum* q = data_->qpos;
    return {{q[0], q[1], q[2]}, Eigen::Quaterniond(q[3], q[4], q[5], q[6])};
  }

 private:
  // MuJoCo 2.2.2 has no surface velocity. Between the two halves of its step, each friction row holds its reference
  // acceleration, -damping * slip, to which the belt's part of the slip is added. The rest of the step is MuJoCo's.
  void move_belts() {
    const mjModel& m = *model_;
    mjData& d = *data_;
    const Eigen::Vector3d belt_axis_W(d.xmat[9 + 1], d.xmat[9 + 4], d.xmat[9 + 7]);  // y of the first body, B
    for (int i = 0; i < d.ncon; ++i) {
      const mjContact& c = d.contact[i];
      if (c.efc_address < 0) continue;
      const int belt1 = static_cast<int>(m.geom_user[c.geom1]), belt2 = static_cast<int>(m.geom_user[c.geom2]);
      if (!belt1 && !belt2) continue;
      const Eigen::Map<const Eigen::Vector3d> normal(c.frame);  // from geom 1 to geom 2
      const double speed = drives_.belt_mps(static_cast<robot::Track>((belt1 ? belt1 : belt2) - 1));
      // The surface moves with -speed * (outward normal x axis). On geom 1 the outward normal is `normal` and the sign
      // in the slip (of 2 relative to 1) is negative; on geom 2 both are reversed.
      const Eigen::Vector3d slip_W = speed * normal.cross(belt_axis_W);
      for (int k = 0; k < c.dim - 1; ++k) {
        const double slip = slip_W.dot(Eigen::Map<const Eigen::Vector3d>(c.frame + 3 * (k + 1)));
        if (pyramidal_) {
          const int row = c.efc_address + 2 * k;
          d.efc_aref[row] -= d.efc_KBIP[4 * row + 1] * c.friction[k] * slip;
          d.efc_aref[row + 1] += d.efc_KBIP[4 * row + 5] * c.friction[k] * slip;
        } else {
          const int row = c.efc_address + 1 + k;
          d.efc_aref[row] -= d.efc_KBIP[4 * row + 1] * slip;
        }
      }
    }
  }

  struct Free {
    void operator()(mjModel* m) const { mj_deleteModel(m); }
    void operator()(mjData* d) const { mj_deleteData(d); }
  };
  Drives drives_;
  bool pyramidal_;
  std::unique_ptr<mjModel, Free> model_;
  std::unique_ptr<mjData, Free> data_;
  std::size_t servos_ = 0, held_ = 0;  // numbers of flippers; either all are driven or all are held
};

}  // namespace

std::vector<Engine> mujoco_engines() {
  const auto engine = [](const char* setting, const Options& options) {
    return Engine{"MuJoCo", mj_versionString(), setting, options.shapes == Shapes::boxes,
                  [options](const EngineScene& scene) -> std::unique_ptr<Runner> {
                    return std::make_unique<MujocoRunner>(scene, options);
                  }};
  };
  return {engine("Newton, elliptic", {"Newton", "elliptic", Shapes::boxes}),
          engine("Newton, pyramidal", {"Newton", "pyramidal", Shapes::boxes}),
          engine("CG, elliptic", {"CG", "elliptic", Shapes::boxes}),
          engine("CG, pyramidal", {"CG", "pyramidal", Shapes::boxes}),
          engine("PGS, pyramidal, 20 iterations", {"PGS", "pyramidal", Shapes::boxes, 20}),
          engine("Newton, elliptic; 1 box a belly", {"Newton", "elliptic", Shapes::box}),
          engine("Newton, pyramidal; 1 box a belly", {"Newton", "pyramidal", Shapes::box}),
          engine("Newton, elliptic; meshes", {"Newton", "elliptic", Shapes::hull}),
          engine("Newton, pyramidal; meshes", {"Newton", "pyramidal", Shapes::hull})};
}

}  // namespace kenaf::engines
