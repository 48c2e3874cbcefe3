#include "physics/sensors/sensor_set.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace kenaf::physics {
namespace {

constexpr double kTouchRadius_m = 0.1;  // a touch sensor feels contacts this near to its mount

std::size_t steps_in(double time_s, double time_step_s) {
  return static_cast<std::size_t>(std::llround(time_s / time_step_s));
}

// An inertial sensor averages over its period, but no longer than this.
std::size_t averaging_steps(const SensorDescription& sensor, double time_step_s) {
  constexpr double kLongest_s = 0.1;
  return std::max<std::size_t>(1, steps_in(std::min(sensor.period_s, kLongest_s), time_step_s));
}

// How many steps the slowest sensor looks back, with delays of effects, plus the present one.
std::size_t history_length(const RobotDescription& robot, double time_step_s) {
  std::size_t longest = 0;
  const auto late = [time_step_s](double delay_s) {
    return static_cast<std::size_t>(std::ceil(delay_s / time_step_s));
  };
  const std::size_t posture_delay = late(robot.effects.posture_delay_s), gyro_delay = late(robot.effects.gyro_delay_s);
  for (const SensorDescription& sensor : robot.sensors) {
    std::size_t steps = steps_in(sensor.delay_s, time_step_s);
    if (sensor.type == SensorType::ins) steps += posture_delay;
    if (sensor.type == SensorType::imu)
      steps += std::max({posture_delay, gyro_delay, averaging_steps(sensor, time_step_s)});
    longest = std::max(longest, steps);
  }
  return longest + 1;
}

// A drive that is not there measures nothing; its noise has been drawn, so that the others' does not depend on it.
DrivesReading without_missing_flippers(DrivesReading reading, const RobotDescription& robot) {
  for (std::size_t i = 0; i < robot::kFlipperCount && robot.has_flippers(); ++i)
    if (!robot.has(static_cast<robot::Flipper>(i))) reading.flipper_a[i] = reading.flipper_rad[i] = 0;
  return reading;
}

}  // namespace

SensorSet::SensorSet(const RobotDescription& robot, const std::string& robot_name, std::uint64_t world_seed,
                     double time_step_s, const Eigen::Vector3d& gravity_W_mps2)
    : robot_(robot),
      time_step_s_(time_step_s),
      gravity_W_mps2_(gravity_W_mps2),
      posture_(robot.effects, gravity_W_mps2),
      gyro_(robot.effects),
      posture_delay_steps_(robot.effects.posture_delay_s / time_step_s),
      gyro_delay_steps_(robot.effects.gyro_delay_s / time_step_s),
      history_(history_length(robot, time_step_s)) {
  for (const SensorDescription& sensor : robot.sensors) {
    Entry& entry = entries_.emplace_back(SensorState(NoiseSource(world_seed, robot_name, sensor.name)),
                                         steps_in(sensor.period_s, time_step_s), steps_in(sensor.delay_s, time_step_s));
    entry.state.bias_rad = entry.state.noise.normal3(sensor.bias_rad);
    entry.state.bias_radps = entry.state.noise.normal3(sensor.bias_radps);
    has_touch_ = has_touch_ || sensor.type == SensorType::touch;
    has_odometry_ = has_odometry_ || sensor.type == SensorType::odometry;
  }
}

void SensorSet::record(const RobotTruth& truth, double t_s, const std::array<double, robot::kTrackCount>& track_a,
                       const std::array<double, robot::kFlipperCount>& flipper_a,
                       std::span<const Eigen::Vector3d> touches_W) {
  // Effects of the encoders act before everything that is derived from them.
  std::array<double, robot::kTrackCount> track_m = truth.track_m, track_mps = truth.track_mps;
  for (const robot::Track side : {robot::kLeft, robot::kRight}) {
    track_m[side] *= robot_.encoder_factor(side);
    track_mps[side] *= robot_.encoder_factor(side);
  }
  if (!any_recorded_) track_m_ = track_m;  // the robot may have travelled before these sensors were put on
  any_recorded_ = true;
  if (has_odometry_) odometry_ = advance_odometry(odometry_, track_m_, track_m, robot_);
  track_m_ = track_m;

  // The step's sample; sensors read it when their delay has passed.
  MotionSample sample{.t_s = t_s,
                      .X_WB = truth.X_WB,
                      .v_WB_mps = truth.v_WB_mps,
                      .w_WB_radps = truth.w_WB_radps,
                      .track_mps = track_mps,
                      .track_m = track_m,
                      .track_a = track_a,
                      .flipper_a = flipper_a,
                      .servo_rad = truth.servo_rad,
                      .battery_v = truth.battery_v,
                      .odometry = odometry_};

  // Bit i is set if touch sensor i is within kTouchRadius_m of a contact. In W: there are fewer mounts than contacts.
  for (std::size_t i = 0; has_touch_ && i < entries_.size(); ++i) {
    if (robot_.sensors[i].type != SensorType::touch) continue;
    const Eigen::Vector3d p_WS = truth.X_WB.p + truth.X_WB.q * robot_.sensors[i].X_BS.p;
    const bool touched = std::ranges::any_of(touches_W, [&p_WS](const Eigen::Vector3d& p_WC) {
      return (p_WC - p_WS).squaredNorm() < kTouchRadius_m * kTouchRadius_m;
    });
    if (touched) sample.touched |= std::uint64_t{1} << i;
  }
  history_.push(sample);
}

Reading SensorSet::measure(std::size_t i, const RayCaster& cast) {
  const SensorDescription& sensor = robot_.sensors[i];
  Entry& entry = entries_[i];
  const MotionSample& now = history_.back(entry.delay_steps);
  // The reported time accounts for the sensor's own delay only; the delay of an effect stays hidden.
  const auto late_pose = [&] {
    return history_.pose_back(static_cast<double>(entry.delay_steps) + posture_delay_steps_);
  };
  switch (sensor.type) {
    case SensorType::ground_truth:
      return measure_ground_truth(now);
    case SensorType::ins:
      return measure_ins(sensor, entry.state, late_pose(), posture_);
    case SensorType::imu: {
      const MotionSample& before = history_.back(entry.delay_steps + averaging_steps(sensor, time_step_s_));
      const Eigen::Vector3d w_WB_B = history_.rate_back(static_cast<double>(entry.delay_steps) + gyro_delay_steps_);
      return measure_imu(sensor, entry.state, {now, before, late_pose(), gyro_.sensed(w_WB_B)}, gravity_W_mps2_,
                         posture_);
    }
    case SensorType::encoder:
      return measure_encoder(sensor, entry.state, now, robot_.drive);
    case SensorType::odometry:
      return measure_odometry(entry.state, now);
    case SensorType::tachometer:
      return measure_tachometer(sensor, entry.state, now, robot_.drive);
    case SensorType::sonar:
      return measure_sonar(sensor, entry.state, now, cast);
    case SensorType::range_scanner:
      return measure_range_scanner(sensor, entry.state, now, cast);
    case SensorType::gps:
      return measure_gps(sensor, entry.state, now, cast);
    case SensorType::touch:
      return TouchReading{(now.touched >> i & 1) != 0};
    case SensorType::drives:
      return without_missing_flippers(measure_drives(sensor, entry.state, now, robot_.servo), robot_);
  }
  throw std::logic_error("unknown sensor type");
}

void SensorSet::read(std::uint64_t step, const RayCaster& cast, std::vector<SensorSample>& out) {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    Entry& entry = entries_[i];
    const std::size_t wait = std::max<std::size_t>(1, entry.period_steps);
    if (entry.reported_step && step < *entry.reported_step + wait) continue;
    entry.reported_step = step;
    out.push_back({i, history_.back(entry.delay_steps).t_s, measure(i, cast)});
  }
}

void SensorSet::reset(std::size_t sensor, const std::optional<GroundTruthReading>& pose) {
  SensorState& state = entries_.at(sensor).state;
  const MotionSample& now = history_.back(0);
  state.start_track_m = now.track_m;
  state.start_odometry = now.odometry;
  state.X_given_true = {};
  // Applied to the levelled pose of now, this gives `pose`.
  if (pose)
    state.X_given_true =
        compose({pose->p_WB_m, rotation_from(pose->roll_pitch_yaw_rad)}, inverse(posture_.leveled(now.X_WB)));
}

void SensorSet::reset_track(std::size_t sensor, robot::Track side) {
  entries_.at(sensor).state.start_track_m[side] = history_.back(0).track_m[side];
}

}  // namespace kenaf::physics
