#include "server/world_server/world_state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace kenaf::world_server {

namespace {

void read_camera(const Simulation& simulation, const SessionRobot& robot, std::size_t index, CameraState& state) {
  const physics::CameraDescription& camera = robot.description->cameras[index];
  state.name = camera.name;
  state.width = camera.width;
  state.height = camera.height;
  state.min_field_of_view_rad = camera.min_field_of_view_rad;
  state.max_field_of_view_rad = camera.max_field_of_view_rad;
  state.field_of_view_rad = robot.camera_field_of_view_rad[index];
  const auto read_link = [&](std::size_t link, std::optional<CameraState::Link>& out) {
    out.reset();
    if (!camera.mission_package) return;
    const auto& links = robot.description->mission_packages[*camera.mission_package].links;
    if (link >= links.size()) return;
    out = CameraState::Link{links[link].min_rad, links[link].max_rad,
                            simulation.world.mission_link_rad(robot.id, *camera.mission_package, link)};
  };
  read_link(0, state.pan);
  read_link(1, state.tilt);
}

// As physics/sensors has them.
RangeScan scan_of(const Simulation& simulation, const SessionRobot& robot, const physics::SensorDescription& sensor,
                  const physics::Pose& X_WB) {
  RangeScan scan{sensor.name,
                 physics::compose(X_WB, sensor.X_BS),
                 sensor.field_of_view_rad,
                 sensor.type == physics::SensorType::sonar,
                 {}};
  const auto range_m = [&](const Eigen::Vector3d& ray_S) {
    const auto hit = simulation.world.cast_ray(scan.X_WS.p, scan.X_WS.q * ray_S, sensor.max_range_m, robot.id);
    return hit ? hit->distance_m : std::numeric_limits<double>::infinity();
  };
  if (scan.sonar) {
    // its axis, and two rings of eight about it
    double nearest_m = range_m({1, 0, 0});
    for (const double off : {sensor.field_of_view_rad / 4, sensor.field_of_view_rad / 2}) {
      for (int i = 0; i < 8; ++i) {
        const double around = i * std::numbers::pi / 4;
        nearest_m = std::min(
            nearest_m, range_m({std::cos(off), std::sin(off) * std::cos(around), std::sin(off) * std::sin(around)}));
      }
    }
    scan.range_m = {nearest_m};
    return scan;
  }
  const std::size_t rays = std::min(sensor.scan_values(), kMostScanRays);
  for (std::size_t i = 0; i < rays; ++i) {
    const double share = rays > 1 ? static_cast<double>(i) / static_cast<double>(rays - 1) : 0.5;
    const double angle = sensor.field_of_view_rad * (0.5 - share);
    scan.range_m.push_back(range_m({std::cos(angle), std::sin(angle), 0}));
  }
  return scan;
}

// Overwrites state.contacts.
void read_sensors_of(const Simulation& simulation, const SessionRobot& robot, const physics::RobotTruth& truth,
                     RobotState& state) {
  using physics::SensorType;
  for (const physics::SensorDescription& sensor : robot.description->sensors) {
    if (sensor.type == SensorType::range_scanner || sensor.type == SensorType::sonar)
      state.scans.push_back(scan_of(simulation, robot, sensor, truth.X_WB));
    if (sensor.type != SensorType::imu || state.inertial) continue;
    simulation.world.contacts(robot.id, state.contacts);
    Eigen::Vector3d force_W_n(0, 0, 0);
    for (const physics::ContactPoint& contact : state.contacts) force_W_n += contact.force_W_n;
    state.inertial = InertialState{physics::compose(truth.X_WB, sensor.X_BS).p,
                                   force_W_n / robot.description->total_mass_kg(), truth.w_WB_radps};
  }
}

void read_extras(const Simulation& simulation, const SessionRobot& robot, const physics::RobotTruth& truth,
                 const StateExtras& extras, RobotState& state) {
  state.contacts.clear();
  state.scans.clear();
  state.inertial.reset();
  const bool sensors = std::ranges::find(extras.sensors, state.id) != extras.sensors.end();
  if (sensors && state.fault.empty()) read_sensors_of(simulation, robot, truth, state);
  if (extras.contacts)
    simulation.world.contacts(robot.id, state.contacts);
  else
    state.contacts.clear();
}

void read_robot(const Simulation& simulation, const Session& session, const StateExtras& extras, RobotState& state) {
  const SessionRobot& robot = *session.robot;
  const physics::RobotTruth truth = simulation.world.truth(robot.id);
  const physics::DriveCurrents currents = simulation.world.drive_currents(robot.id);
  // Identity and fixed dimensions; the latter only of another robot than the last time, since they allocate.
  if (state.robot != robot.id || state.dimensions.tracks.empty())
    state.dimensions = physics::dimensions_of(*robot.description);
  state.id = session.id;
  state.robot = robot.id;
  state.name = robot.name;
  state.class_name = robot.description->usarsim_class;

  // True motion and the drives' measurements.
  state.X_WB = truth.X_WB;
  state.v_WB_mps = truth.v_WB_mps;
  state.track_mps = truth.track_mps;
  state.track_m = truth.track_m;
  state.track_a = currents.track_a;
  for (std::size_t i = 0; i < robot::kFlipperCount; ++i) {
    const bool has = robot.description->has(static_cast<robot::Flipper>(i));
    state.flipper_rad[i] = has ? truth.flipper_rad[i] : std::numeric_limits<double>::quiet_NaN();
  }
  state.flipper_a = currents.flipper_a;
  state.battery_v = truth.battery_v;
  state.battery_left_s = truth.battery_left_s;

  // The command in force: an operator's hold replaces the client's.
  state.command = session.hold ? session.hold->command : robot.command;
  state.has_client = !session.placed_by_operator;
  state.client_silent = session.silent;
  // Robot time since the last command; min() keeps the unsigned difference from wrapping.
  state.client_silent_s = static_cast<double>(simulation.world.step_count() -
                                              std::min(simulation.world.step_count(), session.last_command_step)) *
                          simulation.world.settings().time_step_s;
  state.late_answers = session.schedule.late();
  state.holder = session.hold ? session.hold->holder : OperatorId{0};
  state.holder_silent = session.hold && session.hold->silent;

  // Failure of its simulation, and its cameras.
  state.fault = simulation.world.fault(robot.id);
  state.cameras.resize(robot.description->cameras.size());
  for (std::size_t i = 0; i < state.cameras.size(); ++i) read_camera(simulation, robot, i, state.cameras[i]);
  read_extras(simulation, robot, truth, extras, state);
}

void read_box(const Simulation& simulation, physics::BoxId id, BoxState& state) {
  state.id = static_cast<std::uint32_t>(id);
  state.size_m = simulation.world.box(id).size_m;
  state.X_WBox = simulation.world.box_pose(id);
}

}  // namespace

void read_state(const Simulation& simulation, WorldState& state, const StateExtras& extras) {
  state.wall_s = simulation.wall_s;
  state.time_s = simulation.world.time_s();
  state.step = simulation.world.step_count();
  state.paused = simulation.clock.paused();
  state.pauser = simulation.pauser;
  state.speed = simulation.clock.speed();

  state.robots.resize(simulation.robot_count());
  std::size_t next = 0;
  for (const auto& session : simulation.sessions) {
    if (session->robot) read_robot(simulation, *session, extras, state.robots[next++]);
  }
  state.boxes.resize(simulation.loose_boxes.size() + simulation.objects.size());
  next = 0;
  for (const physics::BoxId id : simulation.loose_boxes) read_box(simulation, id, state.boxes[next++]);
  for (const WorldObject& object : simulation.objects) read_box(simulation, object.box, state.boxes[next++]);
}

}  // namespace kenaf::world_server
