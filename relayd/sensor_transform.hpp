// From the world server's messages to a State: which value is found in which message, frames and units.
//
//   posture_rad         SEN INS {Orientation}; where there is no INS: SEN IMU {Rotation}
//   gyro, acceleration  SEN IMU {AngularVel}, {XYZAcceleration}
//   track_m             SEN Encoder ticks x CONF Encoder {Resolution} x GEO Robot {WheelRadius}
//   track_mps           SEN Tachometer {Vel l,r} x WheelRadius; where there is none: change of track_m by robot time
//   flipper_rad         STA {FLFlipper} ...
//   currents, battery   SEN Drives
//   p_WB, orientation   SEN GroundTruth
//   time, counts        STA {Time} {Frame} {Late} {Silent} {Paused}
//
// Between two messages a value holds, and State.fields says so. Thread safety: one object, one thread. No allocation.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "formats/protocol/usarsim_message.hpp"
#include "robot/state.hpp"

namespace kenaf::relayd {

// Everything the world told with one STA and before it.
struct WorldFrame {
  robot::State state{};     // its frame is left 0
  bool paused = false;      // robot time stands still on request of somebody else
  std::int64_t number = 0;  // STA {Frame n}; from a plain server the count of STAs
  bool numbered = false;    // by the server
  double interval_s = 0;    // robot time since the STA before, 0 at the first
};

class SensorTransform {
 public:
  // Used until the server says otherwise: what the UDK server reports for a robot that sets nothing.
  static constexpr double kDefaultWheelRadius_m = 0.2;
  static constexpr double kDefaultResolution_rad = 0.01745;

  // Reads SEN, STA, CONF and GEO; ignores the rest, and every value it cannot understand or that is out of all reason.
  // True: the message was a STA with a time, and frame() is complete.
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
  double ticks_interval_s_ = 0;                      // robot time since the STA that had new ones
  std::uint32_t known_fields_ = 0, new_fields_ = 0;  // ever, and since the STA before
};

}  // namespace kenaf::relayd
