#include "physics/world.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <list>
#include <map>
#include <stdexcept>

#include "physics/dynamics/scene.hpp"
#include "physics/sensors/sensor_set.hpp"

namespace kenaf::physics {
namespace {

void check_pose(const Pose& X, const char* what) {
  constexpr double kWorldEdge_m = 1e6;  // beyond kFurthest_m, where a robot has a fault
  if (!X.p.allFinite() || !X.q.coeffs().allFinite() || X.p.norm() > kWorldEdge_m || std::abs(X.q.norm() - 1) > 1e-3)
    throw std::invalid_argument(std::string(what) +
                                ": the pose is not finite, too far away, or its rotation is not one");
}

// A robot in a scene, which it leaves when this ends.
struct RobotInScene {
  std::unique_ptr<RobotModel> model;
  std::vector<SensorSet> sensors;  // its own, then those of its instruments
  struct MissionLink {
    double angle_rad = 0, target_rad = 0;
  };
  std::vector<std::vector<MissionLink>> mission;
  std::string fault;
  RobotTruth last_whole{};                 // the last one before the fault
  DriveCurrents currents;                  // 0 after the fault
  std::vector<Eigen::Vector3d> touches_W;  // of the last step; none after a fault

  void forget_motion() {
    for (SensorSet& set : sensors) set.forget_motion();
  }
};

struct RobotEntry : RobotInScene {
  RobotDescription description;
  std::string name;
  Pose X_WB_first;
  std::list<RobotDescription> instruments;  // sensors refer to them
};

using Extent = Eigen::AlignedBox3d;

// Of a box, along W's axes. Boxes that only touch do not intersect: a micrometre less on each side.
Extent extent_of(const Eigen::Vector3d& size_m, const Pose& X_WBox) {
  constexpr double kTouching_m = 1e-6;
  const Eigen::Vector3d half_m = X_WBox.q.toRotationMatrix().cwiseAbs() * size_m / 2;
  const Eigen::Vector3d inner_m = (half_m.array() - kTouching_m).max(0);
  return {X_WBox.p - inner_m, X_WBox.p + inner_m};
}

bool is_number(const Pose& X) {
  return X.p.allFinite() && X.q.coeffs().allFinite();
}

// Beyond these limits a robot's simulation counts as failed: it exploded, or it left the world.
constexpr double kFastest_mps = 50;
constexpr double kFastest_radps = 500;
constexpr double kLowest_m = -100;
constexpr double kFurthest_m = 1e5;  // from the origin

std::string fault_of(const RobotTruth& truth, double t_s) {
  const double speed = truth.v_WB_mps.norm(), spin = truth.w_WB_radps.norm();
  const Eigen::Vector3d& p = truth.X_WB.p;
  if (!is_number(truth.X_WB) || !std::isfinite(speed) || !std::isfinite(spin))
    return fmt::format("its pose is not a number at {:.3f} s", t_s);
  if (speed > kFastest_mps || spin > kFastest_radps)
    return fmt::format("it exploded: {:.0f} m/s and {:.0f} rad/s at {:.3f} s", speed, spin, t_s);
  if (p.z() < kLowest_m || p.norm() > kFurthest_m)
    return fmt::format("it left the world: x {:.0f}, y {:.0f}, z {:.0f} m at {:.3f} s", p.x(), p.y(), p.z(), t_s);
  return {};
}

}  // namespace

struct World::Implementation {
  WorldDescription description;
  PhysicsSettings settings;
  std::uint64_t seed;
  std::uint64_t steps = 0;
  std::uint32_t next_id = 1;  // shared by robots and boxes, so that reset() can add them again in their order
  std::unique_ptr<Scene> scene;
  std::map<RobotId, RobotEntry> robots;  // declared after the scene, which they leave before it is destroyed
  std::map<BoxId, Box> boxes;
  std::vector<Scene::Touch> touches;  // of all robots, in a step

  double time_s() const { return static_cast<double>(steps) * settings.time_step_s; }

  RobotEntry& robot(RobotId id) {
    const auto found = robots.find(id);
    if (found == robots.end()) throw std::out_of_range("no such robot in this world");
    return found->second;
  }

  SensorSet sensors_of(const RobotDescription& instruments, const std::string& name) const {
    return {instruments, name, seed, settings.time_step_s, description.gravity_W_mps2};
  }

  // A robot with sensors and mission packages, as at the start, placed in `where`, and a first sample for the sensors.
  RobotInScene built(RobotId id, const RobotEntry& entry, const Pose& X_WB, Scene& where, double now_s) {
    RobotInScene robot;
    robot.model = std::make_unique<RobotModel>(entry.description, entry.name, seed, settings.time_step_s, id,
                                               where.dynamics(), where.solver());
    robot.sensors.push_back(sensors_of(robot.model->description, entry.name));
    for (const RobotDescription& instruments : entry.instruments)
      robot.sensors.push_back(sensors_of(instruments, entry.name));
    for (const MissionPackageDescription& package : entry.description.mission_packages) {
      auto& links = robot.mission.emplace_back();
      for (const auto& link : package.links) {
        const double rest = std::clamp(0.0, link.min_rad, link.max_rad);
        links.push_back({rest, rest});
      }
    }
    where.place_free(*robot.model, X_WB, true);
    constexpr std::size_t kManyTouches = 256;  // so that a step need not allocate
    robot.touches_W.reserve(kManyTouches);
    touches.reserve(kManyTouches * (robots.size() + 1));
    record(robot, now_s);
    return robot;
  }

  // Called before anything else can touch an invalid pose. The drives are dead: sensors read no speeds or currents.
  static void stop_at_fault(RobotInScene& entry) {
    entry.model->leave_dynamics();
    RobotTruth& truth = entry.last_whole;
    truth.v_WB_mps.setZero();
    truth.w_WB_radps.setZero();
    truth.track_mps = truth.track_force_n = {};
    truth.flipper_radps = truth.flipper_nm = {};
    entry.touches_W.clear();
  }

  // The robot's truth, faults and currents after a step, and its sample for the sensors.
  void record(RobotInScene& entry, double now_s) {
    const RobotModel& model = *entry.model;
    const double dt = settings.time_step_s;
    if (entry.fault.empty()) {
      const RobotTruth truth = model.truth(dt);
      entry.fault = fault_of(truth, now_s);
      if (entry.fault.empty())
        entry.last_whole = truth;
      else
        stop_at_fault(entry);
    }
    entry.currents = {};
    if (entry.fault.empty())
      entry.currents = {
          {model.track_current_a(robot::kLeft, dt), model.track_current_a(robot::kRight, dt)},
          {model.flipper_current_a(robot::kFrontLeft, dt), model.flipper_current_a(robot::kFrontRight, dt),
           model.flipper_current_a(robot::kRearLeft, dt), model.flipper_current_a(robot::kRearRight, dt)}};
    sample(entry, entry.sensors, now_s);
  }

  // Takes a sample for some of the robot's sensors.
  static void sample(const RobotInScene& entry, std::span<SensorSet> sensors, double now_s) {
    for (SensorSet& set : sensors)
      set.record(entry.last_whole, now_s, entry.currents.track_a, entry.currents.flipper_a, entry.touches_W);
  }

  // In one pass over the contacts, which are those of all robots.
  void find_touches() {
    for (auto& [id, entry] : robots) entry.touches_W.clear();
    scene->touches(touches);
    auto robot = robots.end();
    for (const Scene::Touch& touch : touches) {
      if (robot == robots.end() || robot->first != touch.robot) robot = robots.find(touch.robot);
      robot->second.touches_W.push_back(touch.p_W);
    }
  }

  // Puts loose boxes whose poses a faulty robot has made invalid back to their initial poses.
  void put_back_boxes() {
    for (const auto& [id, box] : boxes)
      if (!is_number(scene->box_pose(id))) scene->move_box(id, box.X_WBox);
  }

  // Time 0. The old scene stays until the new one is whole: if that fails, nothing has changed.
  void build() {
    auto fresh = std::make_unique<Scene>(description, settings);
    std::vector<RobotInScene> fresh_robots;  // after the scene, so that they leave it before it ends
    fresh_robots.reserve(robots.size());

    // Boxes and robots in the order in which they were added, so that Bullet's order is the same again.
    auto box = boxes.begin();
    auto robot = robots.begin();
    while (box != boxes.end() || robot != robots.end()) {
      const bool box_first =
          robot == robots.end() ||
          (box != boxes.end() && static_cast<std::uint32_t>(box->first) < static_cast<std::uint32_t>(robot->first));
      if (box_first) {
        fresh->add_box(box->first, box->second);
        ++box;
      } else {
        fresh_robots.push_back(built(robot->first, robot->second, robot->second.X_WB_first, *fresh, 0));
        ++robot;
      }
    }

    // From here on nothing fails. Robots leave the old scene before it ends.
    auto next = fresh_robots.begin();
    for (auto& [id, entry] : robots) static_cast<RobotInScene&>(entry) = std::move(*next++);
    scene = std::move(fresh);
    steps = 0;
  }

  void step() {
    const double dt = settings.time_step_s;
    for (auto& [id, entry] : robots)
      if (entry.fault.empty()) entry.model->before_step(dt);
    scene->step(dt);
    ++steps;
    find_touches();
    bool any_fault = false;  // in this step
    for (auto& [id, entry] : robots) {
      const bool was_whole = entry.fault.empty();
      if (was_whole) entry.model->after_step(dt);
      for (std::size_t p = 0; p < entry.mission.size(); ++p) {
        for (std::size_t l = 0; l < entry.mission[p].size(); ++l) {
          auto& link = entry.mission[p][l];
          const double most = entry.description.mission_packages[p].links[l].max_speed_radps * dt;
          link.angle_rad += std::clamp(link.target_rad - link.angle_rad, -most, most);
        }
      }
      record(entry, time_s());
      any_fault = any_fault || (was_whole && !entry.fault.empty());
    }
    if (any_fault) put_back_boxes();
  }
};

World::World(const WorldDescription& description, const PhysicsSettings& settings, std::uint64_t seed)
    : impl_(std::make_unique<Implementation>()) {
  if (!(settings.time_step_s > 0 && settings.time_step_s <= 0.1) || settings.solver_iterations < 1 ||
      !(settings.contact_stiffness_npm > 0) || !(settings.contact_damping_nspm >= 0))
    throw std::invalid_argument(
        "physics settings: the time step must be above 0 and at most 0.1 s, the solver needs at "
        "least one iteration, and contacts a stiffness above 0 and a damping of at least 0");
  impl_->description = description;
  impl_->settings = settings;
  impl_->seed = seed;
  for (const Box& box : description.boxes) impl_->boxes.emplace(BoxId{impl_->next_id++}, box);
  impl_->build();
}

World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

const WorldDescription& World::description() const {
  return impl_->description;
}
const PhysicsSettings& World::settings() const {
  return impl_->settings;
}
double World::time_s() const {
  return impl_->time_s();
}
std::uint64_t World::step_count() const {
  return impl_->steps;
}

RobotId World::add_robot(const RobotDescription& description, const std::string& name, const Pose& X_WB) {
  check_pose(X_WB, "add_robot");
  const RobotId id{impl_->next_id};
  std::map<RobotId, RobotEntry> added;  // joins the others when it is whole, which cannot fail
  RobotEntry& entry = added[id];
  entry.description = description;
  entry.name = name;
  entry.X_WB_first = {X_WB.p, X_WB.q.normalized()};
  static_cast<RobotInScene&>(entry) = impl_->built(id, entry, entry.X_WB_first, *impl_->scene, impl_->time_s());
  impl_->robots.merge(added);
  ++impl_->next_id;
  return id;
}

void World::remove_robot(RobotId id) {
  impl_->robot(id);
  impl_->robots.erase(id);
}

std::vector<RobotId> World::robots() const {
  std::vector<RobotId> out;
  for (const auto& [id, entry] : impl_->robots) out.push_back(id);
  return out;
}

const RobotDescription& World::robot_description(RobotId id) const {
  return impl_->robot(id).description;
}

const std::string& World::robot_name(RobotId id) const {
  return impl_->robot(id).name;
}

void World::set_command(RobotId id, const robot::Command& command) {
  impl_->robot(id).model->send(command);
}

void World::set_mission_link(RobotId id, std::size_t package, std::size_t link, double angle_rad) {
  RobotEntry& entry = impl_->robot(id);
  auto& state = entry.mission.at(package).at(link);
  const auto& limits = entry.description.mission_packages[package].links[link];
  if (std::isfinite(angle_rad)) state.target_rad = std::clamp(angle_rad, limits.min_rad, limits.max_rad);
}

double World::mission_link_rad(RobotId id, std::size_t package, std::size_t link) const {
  return impl_->robot(id).mission.at(package).at(link).angle_rad;
}

void World::teleport(RobotId id, const Pose& X_WB) {
  check_pose(X_WB, "teleport");
  RobotEntry& entry = impl_->robot(id);
  const Pose X_WB_unit{X_WB.p, X_WB.q.normalized()};
  // After a fault none of the robot's state can be trusted to be finite.
  if (!entry.fault.empty()) {
    static_cast<RobotInScene&>(entry) = impl_->built(id, entry, X_WB_unit, *impl_->scene, impl_->time_s());
    return;
  }
  impl_->scene->place_free(*entry.model, X_WB_unit, false);
  entry.touches_W.clear();
  entry.forget_motion();
  impl_->record(entry, impl_->time_s());
}

void World::set_in_motion(RobotId id, const RobotMotion& motion, const robot::Command& command) {
  RobotEntry& entry = impl_->robot(id);
  const auto whole = [](double speed) { return std::isfinite(speed); };
  const auto whole_joint = [](const robot::JointCommand& joint) { return std::isfinite(joint.value); };
  if (!motion.v_WB_mps.allFinite() || !motion.w_WB_radps.allFinite() || !std::ranges::all_of(motion.track_mps, whole))
    throw std::invalid_argument("set_in_motion: a speed is not finite");
  if (!std::ranges::all_of(command.track_speed_mps, whole) || !std::ranges::all_of(command.flipper, whole_joint))
    throw std::invalid_argument("set_in_motion: the command is not finite");
  if (!entry.fault.empty()) return;
  entry.model->set_in_motion(motion, command);
  entry.forget_motion();  // the jump in speed is no acceleration
  impl_->record(entry, impl_->time_s());
}

void World::prescribe(RobotId id, const PrescribedMotion& motion) {
  const auto whole = [](const std::optional<double>& value) { return !value || std::isfinite(*value); };
  if (!std::ranges::all_of(motion.track_mps, whole) || !std::ranges::all_of(motion.flipper_rad, whole))
    throw std::invalid_argument("prescribe: a speed or an angle is not finite");
  impl_->robot(id).model->prescribe(motion);
}

std::size_t World::add_instruments(RobotId id, const RobotDescription& description) {
  RobotEntry& entry = impl_->robot(id);
  std::list<RobotDescription> added{description};  // joins the others when its sensors have, which cannot fail
  SensorSet sensors = impl_->sensors_of(added.front(), entry.name);
  impl_->sample(entry, {&sensors, 1}, impl_->time_s());
  entry.sensors.push_back(std::move(sensors));
  entry.instruments.splice(entry.instruments.end(), added);
  return entry.instruments.size();
}

void World::reset_sensor(RobotId id, std::size_t sensor, const std::optional<GroundTruthReading>& pose,
                         std::size_t instruments) {
  impl_->robot(id).sensors.at(instruments).reset(sensor, pose);
}
void World::reset_track_sensor(RobotId id, std::size_t sensor, robot::Track side) {
  impl_->robot(id).sensors.front().reset_track(sensor, side);
}

void World::step() {
  impl_->step();
}
std::size_t World::contact_count() const {
  return impl_->scene->contact_count();
}
void World::contacts(RobotId id, std::vector<ContactPoint>& out) const {
  impl_->robot(id);
  impl_->scene->contacts(id, impl_->settings.time_step_s, out);
}
std::size_t World::pair_count() const {
  return impl_->scene->pair_count();
}
std::uint64_t World::pairs_left_out() const {
  return impl_->scene->pairs_left_out();
}

RobotTruth World::truth(RobotId id) const {
  return impl_->robot(id).last_whole;
}

DriveCurrents World::drive_currents(RobotId id) const {
  return impl_->robot(id).currents;
}

const std::string& World::fault(RobotId id) const {
  return impl_->robot(id).fault;
}

void World::read_sensors(RobotId id, std::vector<SensorSample>& out, std::size_t instruments) {
  const auto own = static_cast<std::uint32_t>(id);
  const RayCaster cast = [this, own](const Eigen::Vector3d& from, const Eigen::Vector3d& direction,
                                     double max_m) -> std::optional<double> {
    const auto hit = impl_->scene->cast_ray(from, direction, max_m, own);
    return hit ? std::optional(hit->distance_m) : std::nullopt;
  };
  impl_->robot(id).sensors.at(instruments).read(impl_->steps, cast, out);
}

BoxId World::add_box(const Box& box) {
  check_pose(box.X_WBox, "add_box");
  if (!(box.size_m.minCoeff() > 0) || !box.size_m.allFinite() || !(box.mass_kg >= 0) || !std::isfinite(box.mass_kg) ||
      !(box.friction >= 0))
    throw std::invalid_argument("add_box: size must be above 0, mass and friction at least 0");
  const BoxId id{impl_->next_id};
  std::map<BoxId, Box> added{{id, box}};  // joins the others when it is in the scene, which cannot fail
  impl_->scene->add_box(id, box);
  impl_->boxes.merge(added);
  ++impl_->next_id;
  return id;
}

void World::move_box(BoxId id, const Pose& X_WBox) {
  check_pose(X_WBox, "move_box");
  impl_->scene->move_box(id, X_WBox);
}

void World::remove_box(BoxId id) {
  impl_->scene->remove_box(id);
  impl_->boxes.erase(id);
}

Pose World::box_pose(BoxId id) const {
  return impl_->scene->box_pose(id);
}

std::vector<BoxId> World::boxes() const {
  std::vector<BoxId> ids;
  for (const auto& [id, box] : impl_->boxes) ids.push_back(id);
  return ids;
}

const Box& World::box(BoxId id) const {
  const auto found = impl_->boxes.find(id);
  if (found == impl_->boxes.end()) throw std::out_of_range("no such box in this world");
  return found->second;
}

std::size_t World::overlapping_boxes(const Eigen::Vector3d& size_m, const Pose& X_WBox,
                                     std::optional<BoxId> except) const {
  const Extent own = extent_of(size_m, X_WBox);
  const auto overlaps = [&](const auto& entry) {
    const auto& [id, box] = entry;
    if (id == except) return false;
    return own.intersects(extent_of(box.size_m, impl_->scene->box_pose(id))) ||
           own.intersects(extent_of(box.size_m, box.X_WBox));
  };
  return static_cast<std::size_t>(std::ranges::count_if(impl_->boxes, overlaps));
}

std::optional<RayHit> World::cast_ray(const Eigen::Vector3d& from_W, const Eigen::Vector3d& direction_W, double max_m,
                                      std::optional<RobotId> ignore) const {
  return impl_->scene->cast_ray(from_W, direction_W, max_m, ignore ? static_cast<std::uint32_t>(*ignore) : 0);
}

void World::reset() {
  impl_->build();
}

}  // namespace kenaf::physics
