// A motor drive as a CANopen slave: CiA 402. Combines the power state machine (power_states.hpp), the motion demand
// (motion.hpp) and the objects (drive_objects.hpp).
//
// It knows its motor only in encoder counts; motor_border.hpp converts to the plant's units.
#pragma once

#include "can/candrives/motion.hpp"
#include "can/candrives/power_states.hpp"
#include "can/candrives/slave.hpp"

namespace kenaf::candrives {

struct DriveSetup {
  canopen::NodeId node;
  std::string name;
  MotorScale scale;
  bool absolute_encoder;        // false: position 0 is where the motor is at power on, until homing
  bool has_current = true;      // false: without the objects 0x6075 and 0x6078
  bool has_voltage = true;      // false: without the object 0x6079
  bool has_event_timer = true;  // false: its RPDOs have no sub-index 5
};

class Drive final : public Slave {
 public:
  // `motor`: its state before the drive has power.
  Drive(const DriveSetup& setup, const Measured& motor);

  canopen::PowerState power_state() const { return power_.state(); }
  bool is_powered() const { return power_.is_powered(); }
  const Demand& demand() const { return motion_.demand(); }
  // True: the motor must be at demand().position; false: it must turn at demand().velocity.
  bool holds_position() const;

  // The motor's present state; also while the drive has no power.
  void measure(const Measured& motor) { motor_ = motor; }
  // One step of the state machine's internal transitions and of the demand.
  void step(canopen::Time step);

  // The power is lost: the brake holds the motor.
  void cut_power() { on_reset(); }
  // An internal error of the drive: fault reaction, fault, emergency message.
  void fail(std::uint16_t error_code);
  // While deaf, controlwords are received but have no effect.
  void set_deaf(bool deaf) { deaf_ = deaf; }

 private:
  void on_reset() override;
  void on_quirks() override;
  bool lacks(canopen::ObjectAddress at) const override;
  void on_overrun() override { fail(canopen::kErrorOverrun); }
  void refresh() override;
  std::optional<canopen::SdoAbort> check_write(canopen::ObjectAddress at, std::int64_t value) override;
  void on_write(canopen::ObjectAddress at, std::int64_t value) override;
  void on_connection_lost(std::uint16_t error_code) override;
  void on_controlword(std::uint16_t controlword);
  void watch_slow_reset(double step_s);
  void begin_quick_stop();
  void watch_following(double step_s);
  std::int64_t option(const canopen::MappedObject& at) const { return objects().value(at.object); }

  DriveSetup setup_;
  Measured motor_;
  PowerStates power_;
  Motion motion_;
  std::uint16_t error_code_ = 0;  // the cause of the fault
  double outside_window_s_ = 0;
  bool deaf_ = false;
  double reset_bit_s_ = 0;  // how long bit 7 of the controlword has been high in the fault: slow fault reset
};

}  // namespace kenaf::candrives
