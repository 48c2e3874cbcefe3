// The newest values that the nodes send in the control loop, in the drives' own units, and their times of arrival.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "can/canbus/bus_layout.hpp"
#include "can/canbus/robot_bus.hpp"
#include "can/canopen/bus.hpp"
#include "can/canopen/emergency.hpp"

namespace kenaf::real {

struct DriveInput {
  std::uint16_t statusword = 0;
  std::int32_t position = 0;        // of a counter with fewer bits: continued beyond them
  std::int32_t velocity = 0;        // tracks, wheels; with its sign, whatever form the drive gives it
  std::int16_t current_permil = 0;  // of the rated current
  std::optional<canopen::Time> state_at, effort_at;
  std::optional<canopen::Emergency> emergency;  // the newest, until it is cleared
  bool restarted = false;                       // a boot-up message came after watch_restarts()
  std::int32_t jump = 0;          // counts; not 0: a change after watch_jumps() that the drive cannot have made
  bool velocity_doubted = false;  // object 0x606C contradicts the position: `velocity` is the position's change instead
};

struct SlopeInput {
  std::int16_t longitudinal = 0, lateral = 0;  // in units of the sensor's resolution
  std::optional<canopen::Time> at;
};

struct GyroInput {
  std::int32_t rate = 0;
  std::optional<canopen::Time> at;
};

class ProcessImage {
 public:
  explicit ProcessImage(const canbus::RobotBus& bus);

  // Frames that are not this robot's, or lack their PDO's length, change nothing.
  void on_frame(const canopen::ReceivedFrame& received);
  void watch_restarts();
  void watch_jumps() { watches_jumps_ = true; }

  const DriveInput& drive(std::size_t i) const { return drives_[i]; }
  const SlopeInput& slope() const { return slope_; }
  const GyroInput& gyro() const { return gyro_; }
  std::optional<double> battery_v() const { return battery_v_; }
  std::optional<canopen::Time> battery_at() const { return battery_at_; }
  std::optional<canopen::Time> sync_at() const { return sync_at_; }
  // True if everything due with each SYNC has come since the newest one.
  bool is_complete() const;

 private:
  // What is known of a drive's motion beyond its newest values.
  struct Motion {
    std::int64_t raw_position = 0;
    int direction = 1;        // of the last change of the position
    double change_per_s = 0;  // of the position, counts
    int contradictions = 0;   // velocities one after another that have another sign than it
  };
  void on_drive_frame(std::size_t i, const canopen::ReceivedFrame& received);
  void on_value(std::size_t i, const canopen::MappedObject& object, std::int64_t value, canopen::Time at);
  void on_position(std::size_t i, std::int64_t raw, canopen::Time at);
  void on_velocity(std::size_t i, std::int64_t raw);
  void on_sensor_frame(const canopen::ReceivedFrame& received);

  const canbus::RobotBus& bus_;
  std::vector<canbus::DrivePdos> pdos_;
  canopen::Pdo slope_pdo_ = canbus::inclinometer_pdo();
  std::vector<DriveInput> drives_;
  std::vector<Motion> motions_;
  bool watches_jumps_ = false;
  SlopeInput slope_;
  GyroInput gyro_;
  std::optional<double> battery_v_;
  std::optional<canopen::Time> battery_at_, sync_at_;
};

}  // namespace kenaf::real
