// A yaw-rate gyro as a CANopen slave. There is no device profile for gyros: it has a manufacturer-specific object,
// 0x2000, whose sub-indices 1 to 8 are the bytes of its PDO, with the yaw rate at the configured bits.
#pragma once

#include "can/canbus/robot_bus.hpp"
#include "can/candrives/slave.hpp"

namespace kenaf::candrives {

class Gyro final : public Slave {
 public:
  explicit Gyro(const canbus::GyroOnBus& setup);
  void measure(double yaw_rate_radps) { yaw_rate_radps_ = yaw_rate_radps; }

 private:
  void refresh() override;

  canbus::GyroOnBus setup_;
  double yaw_rate_radps_ = 0;
};

}  // namespace kenaf::candrives
