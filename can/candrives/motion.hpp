// The motor demand of a drive while operation is enabled, in each of its modes, and its slowing down. CiA 402-2:
// profile position, profile velocity, homing, cyclic synchronous position and velocity mode.
//
// Positions are encoder counts since power on. The objects' positions differ from them by an offset, which homing sets,
// so that homing does not move the demand.
#pragma once

#include <cstdint>
#include <optional>

#include "can/candrives/dictionary.hpp"
#include "can/candrives/homing.hpp"
#include "can/candrives/ramp.hpp"
#include "can/canopen/drive.hpp"

namespace kenaf::candrives {

// Measurements of the motor available to the drive.
struct Measured {
  double position = 0, velocity = 0;  // counts, counts per second
  double current_a = 0, supply_v = 0;
  bool negative_switch = false, positive_switch = false;
};

// Units of the velocity and acceleration objects, which may differ from that of the position.
struct MotorScale {
  double counts_per_velocity_unit = 1, counts_per_acceleration_unit = 1;
  double homing_max_lag = 0;      // counts
  int home_offset_direction = 1;  // -1: at home the position is minus object 0x607C
};

enum class SlowDown : std::uint8_t { profile_ramp, quick_stop_ramp };  // objects 0x6084, 0x6085

class Motion {
 public:
  Motion(const Dictionary& objects, const MotorScale& scale) : objects_(&objects), scale_(scale) {}

  // At rest at the motor's position; objects' position = encoder position + `offset`.
  void reset(const Measured& motor, std::int64_t offset);
  void set_home_offset_direction(int direction) { scale_.home_offset_direction = direction; }
  // Operation is enabled from here on: earlier commands are not followed.
  void begin(const Measured& motor);
  void set_mode(canopen::DriveMode mode, const Measured& motor);
  canopen::DriveMode mode() const { return mode_; }

  // Bits 4, 5, 6 and 8. Unless `enabled`, only the edges are remembered.
  void on_controlword(std::uint16_t controlword, bool enabled, const Measured& motor);
  void on_target_position();  // object 0x607a was written

  // One step, by state: operation enabled; quick stop or fault reaction (true: at standstill); all others.
  void operate(const Measured& motor, double step_s);
  bool slow_down(SlowDown ramp, double step_s);
  void hold() { demand_.velocity = 0; }

  const Demand& demand() const { return demand_; }
  // Object 0x6064: a 32-bit number that wraps.
  std::int32_t position(const Measured& motor) const;
  // Bits 10 to 13 while operation is enabled.
  std::uint16_t statusword_bits(const Measured& motor) const;
  // True if the motor is further from the demand than the following error window, object 0x6065, in a mode that has
  // one.
  bool is_outside_window(const Measured& motor) const;

 private:
  void operate_profile_position(double step_s);
  void operate_profile_velocity(double step_s);
  void operate_cyclic_position(double step_s);
  void operate_cyclic_velocity(double step_s);
  void operate_homing(const Measured& motor, double step_s);
  void take_set_point();
  bool halted() const;
  double clipped_target(double position);
  double clipped_velocity(double velocity);
  // Encoder positions of object 0x607d; nullopt: no limits, because both are 0 or out of order.
  struct Range {
    double min, max;
  };
  std::optional<Range> limits() const;
  double number(const canopen::MappedObject& object) const;
  double velocity(const canopen::MappedObject& object) const;
  double acceleration(const canopen::MappedObject& object) const;
  Ramps profile_ramps() const;

  const Dictionary* objects_;
  MotorScale scale_;
  canopen::DriveMode mode_ = canopen::DriveMode::profile_position;
  Demand demand_;
  std::int64_t offset_ = 0;
  std::uint16_t controlword_ = 0;
  bool internal_limit_ = false;
  std::optional<double> set_point_, next_set_point_;  // profile position: active, and queued
  bool acknowledged_ = false;
  double cyclic_left_s_ = 0;  // cyclic position: time left to reach the target
  bool cyclic_target_ = false;
  Homing homing_;
};

}  // namespace kenaf::candrives
