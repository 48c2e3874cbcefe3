// A motor drive as a CANopen slave: CiA 402. Its parts are the power state machine (power_states.hpp), what it demands
// of its motor (motion.hpp) and its objects (drive_objects.hpp); here they are put together.
//
// It knows its motor in counts of the encoder alone; robot_slaves.cpp has the border to the plant.
#pragma once

#include "can/candrives/motion.hpp"
#include "can/candrives/power_states.hpp"
#include "can/candrives/slave.hpp"

namespace kenaf::candrives {

struct DriveSetup {
  canopen::NodeId node;
  std::string name;
  MotorScale scale;
  bool absolute_encoder;                        // false: position 0 where the motor is at power on, until homing
  bool has_current = true, has_voltage = true;  // false: it lacks the objects 0x6075 and 0x6078; 0x6079
};

class Drive final : public Slave {
 public:
  // `motor`: where it is before the drive has power.
  Drive(const DriveSetup& setup, const Measured& motor);

  canopen::PowerState power_state() const { return power_.state(); }
  bool is_powered() const { return power_.is_powered(); }
  const Demand& demand() const { return motion_.demand(); }
  // The motor shall be at demand().position; else: turn at demand().velocity.
  bool holds_position() const;

  // The motor as it is now; also while the drive has no power.
  void measure(const Measured& motor) { motor_ = motor; }
  // One step of the state machine's own transitions and of the demand.
  void step(canopen::Time step);

  // Its power is gone: the brake holds the motor.
  void cut_power() { on_reset(); }
  // An error of the drive itself: fault reaction, fault, emergency message.
  void fail(std::uint16_t error_code);
  // From here on controlwords come and change nothing.
  void set_deaf(bool deaf) { deaf_ = deaf; }

 private:
  void on_reset() override;
  void refresh() override;
  std::optional<canopen::SdoAbort> check_write(canopen::ObjectAddress at, std::int64_t value) override;
  void on_write(canopen::ObjectAddress at, std::int64_t value) override;
  void on_connection_lost() override;
  void on_controlword(std::uint16_t controlword);
  void begin_quick_stop();
  void watch_following(double step_s);
  std::int64_t option(const canopen::MappedObject& at) const { return objects().value(at.object); }

  DriveSetup setup_;
  Measured motor_;
  PowerStates power_;
  Motion motion_;
  std::uint16_t error_code_ = 0;  // that made the fault
  double outside_window_s_ = 0;
  bool deaf_ = false;
};

}  // namespace kenaf::candrives
