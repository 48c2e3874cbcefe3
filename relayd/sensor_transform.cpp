#include "relayd/sensor_transform.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "formats/protocol/frames.hpp"
#include "robot/state.hpp"

namespace kenaf::relayd {

namespace {

using protocol::frames::Vector3;
using protocol::usarsim::MessageView;

// No sensor of this robot comes near this; a line beyond it is garbage, and products of values below it stay finite.
constexpr double kMostOfAnything = 1e12;

bool read(const MessageView& message, std::string_view key, std::span<double> out) {
  const auto text = message.find(key);
  return text && protocol::usarsim::parse_numbers(*text, out) &&
         std::ranges::all_of(out, [](double value) { return std::abs(value) < kMostOfAnything; });
}

std::optional<double> read(const MessageView& message, std::string_view key) {
  double value = 0;
  return read(message, key, {&value, 1}) ? std::optional(value) : std::nullopt;
}

bool contains_ignoring_case(std::string_view text, std::string_view part) {
  for (std::size_t i = 0; i + part.size() <= text.size(); ++i) {
    if (protocol::usarsim::equal_ignoring_case(text.substr(i, part.size()), part)) return true;
  }
  return false;
}

bool is_type(const MessageView& message, std::string_view type) {
  const auto found = message.find("Type");
  return found && protocol::usarsim::equal_ignoring_case(*found, type);
}

bool is_true(const MessageView& message, std::string_view key) {
  const auto text = message.find(key);
  return text && protocol::usarsim::parse_bool(*text).value_or(false);
}

}  // namespace

bool SensorTransform::take(const MessageView& message) {
  if (message.is("SEN")) {
    take_sensor(message);
  } else if (message.is("STA")) {
    return take_status(message);
  } else if (message.is("GEO")) {
    // GEO of the robot: no other has a wheel.
    const auto radius = read(message, "WheelRadius");
    if (radius && *radius > 1e-3 && *radius < 10) wheel_radius_m_ = radius;
  } else if (message.is("CONF") && is_type(message, "Encoder")) {
    const auto resolution = read(message, "Resolution");
    if (resolution && *resolution > 0 && *resolution < 10) resolution_rad_ = *resolution;
  }
  return false;
}

void SensorTransform::note(robot::StateField field) {
  known_fields_ |= field;
  new_fields_ |= field;
}

void SensorTransform::take_sensor(const MessageView& message) {
  robot::State& state = frame_.state;
  Vector3 v;
  if (is_type(message, "Encoder")) {
    take_ticks(message);
  } else if (is_type(message, "INS")) {
    if (!read(message, "Orientation", v)) return;
    state.posture_rad = protocol::frames::rep103_angles_from_usarsim(v);
    note(robot::kHasPosture);
    has_ins_ = true;
  } else if (is_type(message, "IMU")) {
    if (!has_ins_ && read(message, "Rotation", v)) {
      state.posture_rad = protocol::frames::rep103_angles_from_usarsim(v);
      note(robot::kHasPosture);
    }
    Vector3 acceleration;
    if (!read(message, "AngularVel", v) || !read(message, "XYZAcceleration", acceleration)) return;
    state.gyro_radps = protocol::frames::rep103_vector_from_usarsim(v);
    state.acceleration_mps2 = protocol::frames::rep103_vector_from_usarsim(acceleration);
    note(robot::kHasInertial);
  } else if (is_type(message, "Tachometer")) {
    // A robot with more wheels lists them in an unknown order.
    std::array<double, robot::kTrackCount> spin_radps;
    if (read(message, "Vel", spin_radps)) spin_radps_ = spin_radps;
  } else if (is_type(message, "Drives")) {
    std::array<double, robot::kTrackCount> track_a;
    std::array<double, robot::kFlipperCount> flipper_a;
    if (read(message, "TrackCurrent", track_a) && read(message, "FlipperCurrent", flipper_a)) {
      state.track_a = track_a;
      state.flipper_a = flipper_a;
      note(robot::kHasCurrents);
    }
    if (const auto voltage = read(message, "BatteryVoltage")) {
      state.battery_v = *voltage;
      note(robot::kHasBattery);
    }
  } else if (is_type(message, "GroundTruth")) {
    Vector3 angles;
    if (!read(message, "Location", v) || !read(message, "Orientation", angles)) return;
    state.p_WB_m = protocol::frames::rep103_vector_from_usarsim(v);
    state.orientation_rad = protocol::frames::rep103_angles_from_usarsim(angles);
    note(robot::kHasGroundTruth);
  }
}

// UT2004 writes {Name ECLeft Tick 0} {Name ECRight Tick 0}, UDK a line {Name ECLeft} {Tick 0} for each.
void SensorTransform::take_ticks(const MessageView& message) {
  for (const protocol::usarsim::Group& group : message.all()) {
    if (!protocol::usarsim::equal_ignoring_case(group.key, "Name")) continue;
    std::string_view rest = group.value;
    const std::string_view name = protocol::usarsim::next_word(rest);
    if (protocol::usarsim::equal_ignoring_case(protocol::usarsim::next_word(rest), "Tick")) {
      take_tick(name, rest);
    } else if (const auto ticks = message.find("Tick")) {
      take_tick(name, *ticks);
    }
  }
}

void SensorTransform::take_tick(std::string_view name, std::string_view ticks) {
  const auto count = protocol::usarsim::parse_number(ticks);
  if (!count || std::abs(*count) > kMostOfAnything) return;
  for (const auto& [track, side] : {std::pair{robot::kLeft, "left"}, {robot::kRight, "right"}}) {
    if (!contains_ignoring_case(name, side)) continue;
    ticks_[track] = count;
    has_new_ticks_ = true;
  }
}

bool SensorTransform::take_status(const MessageView& message) {
  const auto time = read(message, "Time");
  if (!time) return false;
  robot::State& state = frame_.state;
  frame_.interval_s = frame_.number == 0 ? 0 : *time - state.robot_time_s;
  state.robot_time_s = *time;
  const auto number = read(message, "Frame");
  // The world reports a pause or its end by another STA of the same frame: values new in that frame still are.
  if (number && std::llround(*number) == frame_.number)
    new_fields_ |= known_fields_ & ~(state.fields >> robot::kHeldShift);
  frame_.numbered = number.has_value();
  frame_.number = number ? std::llround(*number) : frame_.number + 1;
  state.late_commands = static_cast<std::uint32_t>(std::clamp(read(message, "Late").value_or(0), 0.0, 4e9));
  state.stopped_by_silence = is_true(message, "Silent");
  frame_.paused = is_true(message, "Paused");
  frame_.not_at_start = message.find("Start").has_value();

  // A robot has the flippers of which its server tells the angle: all four, a pair, or none. Of a half pair none is
  // taken.
  std::array<double, robot::kFlipperCount> flipper_rad;
  flipper_rad.fill(robot::kNoFlipper);
  for (std::size_t i = 0; i < robot::kFlipperCount; ++i) {
    const auto flipper = static_cast<robot::Flipper>(i);
    double joint_rad = 0;
    if (read(message, protocol::frames::usarsim_flipper_name(flipper), {&joint_rad, 1}))
      flipper_rad[i] = protocol::frames::tip_up_from_usarsim_flipper(flipper, joint_rad);
  }
  const auto is_told = [&](robot::Flipper flipper) { return !std::isnan(flipper_rad[flipper]); };
  const bool front = is_told(robot::kFrontLeft), rear = is_told(robot::kRearLeft);
  if (is_told(robot::kFrontRight) == front && is_told(robot::kRearRight) == rear && (front || rear)) {
    state.flipper_rad = flipper_rad;
    note(robot::kHasFlippers);
  }
  finish_tracks();
  state.fields = known_fields_ | robot::held(known_fields_ & ~new_fields_);
  new_fields_ = 0;
  return true;
}

// Done here and not on the ticks: the wheel radius may come after them, and only STA has a time.
void SensorTransform::finish_tracks() {
  ticks_interval_s_ += frame_.interval_s;
  const bool has_new_ticks = std::exchange(has_new_ticks_, false);
  if (!ticks_[robot::kLeft] || !ticks_[robot::kRight]) return;
  robot::State& state = frame_.state;
  const bool first = (known_fields_ & robot::kHasEncoders) == 0;
  const double wheel_radius_m = wheel_radius_m_.value_or(kDefaultWheelRadius_m);
  for (std::size_t i = 0; i < robot::kTrackCount; ++i) {
    state.track_m[i] = *ticks_[i] * resolution_rad_ * wheel_radius_m;
    if (spin_radps_) {
      state.track_mps[i] = protocol::frames::surface_speed_from_spin((*spin_radps_)[i], wheel_radius_m);
    } else if (has_new_ticks && ticks_interval_s_ > 1e-6) {
      state.track_mps[i] = first ? 0 : (state.track_m[i] - earlier_track_m_[i]) / ticks_interval_s_;
    }
  }
  if (!has_new_ticks) return;
  earlier_track_m_ = state.track_m;
  ticks_interval_s_ = 0;
  note(robot::kHasEncoders);
}

}  // namespace kenaf::relayd
