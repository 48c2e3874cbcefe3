#include "rollout/run_recorder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "robot/angles.hpp"
#include "robot/columns.hpp"
#include "robot/parts.hpp"

namespace kenaf::rollout {
namespace {

using physics::RobotDescription;
using physics::SensorDescription;
using physics::SensorType;

const SensorDescription* sensor_of(const RobotDescription& robot, SensorType type) {
  const auto found = std::ranges::find(robot.sensors, type, &SensorDescription::type);
  return found == robot.sensors.end() ? nullptr : &*found;
}

bool has(const RobotDescription& robot, SensorType type) {
  return sensor_of(robot, type) != nullptr;
}

// Sigma of a quantity that is rounded to steps: the rounding error is uniform over one step, sigma = step / sqrt(12).
double with_rounding(double sigma, double step) {
  return std::hypot(sigma, step / std::sqrt(12.0));
}

double metres_per_count(const physics::TrackDriveDescription& drive) {
  return drive.sprocket_radius_m / drive.encoder_counts_per_radian;
}

}  // namespace

RobotDescription instrumented(RobotDescription robot, double noise_scale) {
  std::set<SensorType> kept{SensorType::ins, SensorType::imu, SensorType::encoder, SensorType::tachometer,
                            SensorType::drives};
  std::erase_if(robot.sensors, [&kept](const SensorDescription& sensor) { return kept.erase(sensor.type) == 0; });
  for (SensorDescription& sensor : robot.sensors)
    for (double* sigma : {&sensor.noise_m, &sensor.noise_rad, &sensor.noise_radps, &sensor.noise_mps2, &sensor.noise_a,
                          &sensor.noise_v, &sensor.bias_rad, &sensor.bias_radps})
      *sigma *= noise_scale;
  return robot;
}

std::map<std::string, double> column_noise(const RobotDescription& nominal, const RollOutOptions& options) {
  const RobotDescription robot = instrumented(nominal, options.noise_scale);
  using enum robot::Quantity;
  std::map<std::string, double> noise;
  const auto add = [&noise](double sigma, robot::Quantity quantity) {
    for (const robot::Column& column : robot::columns_of(quantity))
      if (sigma > 0) noise.emplace(column.name, sigma);
  };

  // Motion capture, posture and inertial sensors.
  add(options.mocap_noise_m * options.noise_scale, position);
  add(options.mocap_noise_rad * options.noise_scale, yaw);
  if (const auto* ins = sensor_of(robot, SensorType::ins)) add(ins->noise_rad, tilt);
  if (const auto* imu = sensor_of(robot, SensorType::imu)) {
    add(imu->noise_radps, turn_rate);
    add(imu->noise_mps2, acceleration);
  }

  // Track sensors measure the sprocket: noise at the belt is multiplied by its radius. Counts and steps are rounded.
  const double radius_m = robot.drive.sprocket_radius_m;
  if (const auto* tachometer = sensor_of(robot, SensorType::tachometer))
    add(tachometer->noise_radps * radius_m, track_speed);
  if (const auto* encoder = sensor_of(robot, SensorType::encoder))
    add(with_rounding(encoder->noise_rad * radius_m, metres_per_count(robot.drive)), track_travel);
  if (const auto* drives = sensor_of(robot, SensorType::drives)) {
    add(drives->noise_a, track_current);
    add(drives->noise_v, battery_voltage);
    if (robot.has_flippers()) {
      add(drives->noise_a, flipper_current);
      add(with_rounding(drives->noise_rad, robot.servo.resolution_rad), flipper_angle);
    }
  }
  return noise;
}

std::vector<std::string> recorded_columns(const RobotDescription& nominal) {
  const RobotDescription robot = instrumented(nominal, 0);
  return RunRecorder(robot, {}, std::nullopt).take().columns;
}

RunRecorder::RunRecorder(const RobotDescription& robot, const RollOutOptions& options,
                         const std::optional<Start>& start)
    : robot_(robot),
      mocap_noise_m_(options.mocap_noise_m * options.noise_scale),
      mocap_noise_rad_(options.mocap_noise_rad * options.noise_scale),
      mocap_noise_(options.seed, "world", "motion capture"),
      starts_in_motion_(start && start->motion) {
  if (start) first_report_ = {{start->x_m, start->y_m, 0}, start->yaw_rad};

  // The columns in the order of the format, those that the robot measures.
  using enum robot::Quantity;
  const bool flippers = robot.has_flippers(), drives = has(robot, SensorType::drives);
  const bool imu = has(robot, SensorType::imu);
  time_ = add_group(true, time);
  cmd_track_ = add_group(true, track_command);
  cmd_flipper_ = add_group(flippers, flipper_command);
  track_speed_ = add_group(has(robot, SensorType::tachometer), track_speed);
  track_travel_ = add_group(has(robot, SensorType::encoder), track_travel);
  flipper_ = add_group(drives && flippers, flipper_angle);
  track_current_ = add_group(drives, track_current);
  flipper_current_ = add_group(drives && flippers, flipper_current);
  battery_ = add_group(drives, battery_voltage);
  position_ = add_group(true, position);
  tilt_ = add_group(has(robot, SensorType::ins), tilt);
  yaw_ = add_group(true, yaw);
  gyro_ = add_group(imu, turn_rate);
  acceleration_ = add_group(imu, acceleration);
  run_.values.resize(run_.columns.size());
}

RunRecorder::Group RunRecorder::add_group(bool measured, robot::Quantity quantity) {
  if (!measured) return {};
  const std::span<const robot::Column> columns = robot::columns_of(quantity);
  const Group group{run_.columns.size(), columns.size()};
  for (const robot::Column& column : columns) run_.columns.emplace_back(column.name);
  return group;
}

void RunRecorder::put(Group group, std::initializer_list<double> values) {
  for (std::size_t i = 0; i < group.count; ++i) run_.values[group.first + i].back() = values.begin()[i];
}

void RunRecorder::put_reading(const physics::InsReading& reading) {
  put(tilt_, {reading.roll_pitch_yaw_rad.x(), reading.roll_pitch_yaw_rad.y()});
}

void RunRecorder::put_reading(const physics::ImuReading& reading) {
  const Eigen::Vector3d &w = reading.angular_velocity_radps, &a = reading.acceleration_mps2;
  put(gyro_, {w.x(), w.y(), w.z()});
  put(acceleration_, {a.x(), a.y(), a.z()});
}

void RunRecorder::put_reading(const physics::EncoderReading& reading) {
  const double metres = metres_per_count(robot_.drive);
  put(track_travel_, {static_cast<double>(reading.counts[robot::kLeft]) * metres,
                      static_cast<double>(reading.counts[robot::kRight]) * metres});
}

void RunRecorder::put_reading(const physics::TachometerReading& reading) {
  const double radius_m = robot_.drive.sprocket_radius_m;
  put(track_speed_, {reading.spin_radps[robot::kLeft] * radius_m, reading.spin_radps[robot::kRight] * radius_m});
}

void RunRecorder::put_reading(const physics::DrivesReading& reading) {
  // cells of flippers that the robot has not stay empty
  const auto of = [this](const std::array<double, robot::kFlipperCount>& values, robot::Flipper which) {
    return robot_.has(which) ? values[which] : std::numeric_limits<double>::quiet_NaN();
  };
  const auto &a = reading.flipper_a, &angle = reading.flipper_rad;
  put(track_current_, {reading.track_a[robot::kLeft], reading.track_a[robot::kRight]});
  put(flipper_current_,
      {of(a, robot::kFrontLeft), of(a, robot::kFrontRight), of(a, robot::kRearLeft), of(a, robot::kRearRight)});
  put(flipper_, {of(angle, robot::kFrontLeft), of(angle, robot::kFrontRight), of(angle, robot::kRearLeft),
                 of(angle, robot::kRearRight)});
  put(battery_, {reading.battery_v});
}

void RunRecorder::add(double t_s, const robot::Command& command, const physics::RobotTruth& truth,
                      std::span<const physics::SensorSample> samples) {
  // A cell without a reading stays empty.
  for (auto& column : run_.values) column.push_back(std::numeric_limits<double>::quiet_NaN());
  put(time_, {t_s});
  put(cmd_track_, {command.track_speed_mps[robot::kLeft], command.track_speed_mps[robot::kRight]});
  const auto& flipper = command.flipper;
  put(cmd_flipper_, {flipper[robot::kFrontLeft].value, flipper[robot::kFrontRight].value,
                     flipper[robot::kRearLeft].value, flipper[robot::kRearRight].value});

  // The pose is reported in take(), as motion capture may show a later one.
  if (course_.t_s.empty() && starts_in_motion_) {
    course_.v_WB_mps = truth.v_WB_mps;
    course_.yaw_radps = truth.w_WB_radps.z();
  }
  add_pose(t_s, truth);
  const Eigen::Vector3d p_noise_m = mocap_noise_.normal3(mocap_noise_m_);
  pose_noise_.push_back({p_noise_m, mocap_noise_.normal(mocap_noise_rad_)});
  for (const physics::SensorSample& sample : samples)
    std::visit([this](const auto& reading) { put_reading(reading); }, sample.reading);
}

void RunRecorder::add_pose(double t_s, const physics::RobotTruth& truth) {
  course_.t_s.push_back(t_s);
  course_.pose.push_back({truth.X_WB.p, physics::roll_pitch_yaw(truth.X_WB.q).z()});
}

void RunRecorder::put_poses() {
  const std::vector<TrackedPose> poses =
      reported_poses(course_, run_.values[time_.first], robot_.effects, first_report_);
  for (std::size_t row = 0; row < poses.size(); ++row) {
    for (std::size_t i = 0; i < position_.count; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      run_.values[position_.first + i][row] = poses[row].p_WB_m[axis] + pose_noise_[row].p_WB_m[axis];
    }
    run_.values[yaw_.first][row] = robot::wrap_angle(poses[row].yaw_rad + pose_noise_[row].yaw_rad);
  }
}

runs::Run RunRecorder::take() {
  if (!course_.t_s.empty()) put_poses();
  course_ = {};
  pose_noise_.clear();
  return std::move(run_);
}

}  // namespace kenaf::rollout
