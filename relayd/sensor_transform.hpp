// Converts the world server's messages to a State: source of each value, frames and units.
//
//   posture_rad         SEN INS {Orientation}; without INS: SEN IMU {Rotation}
//   gyro, acceleration  SEN IMU {AngularVel}, {XYZAcceleration}
//   track_m             SEN Encoder ticks x CONF Encoder {Resolution} x GEO Robot {WheelRadius}
//   track_mps           SEN Tachometer {Vel l,r} x WheelRadius; without it: change of track_m by robot time
//   flipper_rad         STA {FLFlipper} ...
//   currents, battery   SEN Drives
//   p_WB, orientation   SEN GroundTruth
//   time, counts        STA {Time} {Frame} {Late} {Silent} {Paused} {Start}
//
// Between two messages a value is held, and State.fields says so. Thread safety: one object, one thread. No allocation.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "formats/protocol/usarsim_message.hpp"
#include "robot/state.hpp"

namespace kenaf::relayd {

// All that the world reported up to and with one STA.
struct WorldFrame {
  robot::State state{};       // its frame is left 0
  bool paused = false;        // robot time is stopped at somebody else's request
  std::int64_t number = 0;    // STA {Frame n}; from a plain server the count of STAs
  bool numbered = false;      // by the server
  double interval_s = 0;      // robot time since the previous STA, 0 at the first
  bool not_at_start = false;  // the server placed it at another start pose than the first, which was not free
};

class SensorTransform {
 public:
  // Used until the server reports another: the value that the UDK server reports for a robot that sets none.
  static constexpr double kDefaultWheelRadius_m = 0.2;
  static constexpr double kDefaultResolution_rad = 0.01745;

  // Reads SEN, STA, CONF and GEO; ignores other messages and every value that is malformed or implausible. Returns true
  // if the message was a STA with a time: frame() is then complete.
  bool take(const protocol::usarsim::MessageView& message);

  const WorldFrame& frame() const { return frame_; }
  std::optional<double> wheel_radius_m() const { return wheel_radius_m_; }

 private:
  void note(robot::StateField field);
  void take_sensor(const protocol::usarsim::MessageView& message);
  void take_ticks(const protocol::usarsim::MessageView& message);
  void take_tick(std::string_view name, std::string_view ticks);
  bool take_status(const protocol::usarsim::MessageView& message);
  void finish_tracks();

  WorldFrame frame_;
  std::optional<double> wheel_radius_m_;
  double resolution_rad_ = kDefaultResolution_rad;
  std::array<std::optional<double>, robot::kTrackCount> ticks_;
  std::array<double, robot::kTrackCount> earlier_track_m_{};
  std::optional<std::array<double, robot::kTrackCount>> spin_radps_;
  bool has_ins_ = false;
  bool has_new_ticks_ = false;
  double ticks_interval_s_ = 0;                      // robot time since the last STA with new ticks
  std::uint32_t known_fields_ = 0, new_fields_ = 0;  // ever, and since the previous STA
};

}  // namespace kenaf::relayd
