// A two-axis inclinometer as a CANopen slave: CiA 410. Slopes are the robot's roll and pitch, rotated and offset
// according to the sensor's mounting.
#pragma once

#include "can/canbus/robot_bus.hpp"
#include "can/candrives/slave.hpp"

namespace kenaf::candrives {

class Inclinometer final : public Slave {
 public:
  explicit Inclinometer(const canbus::InclinometerOnBus& setup);
  void measure(double roll_rad, double pitch_rad);

 private:
  void refresh() override;
  std::optional<canopen::SdoAbort> check_write(canopen::ObjectAddress at, std::int64_t value) override;

  canbus::InclinometerOnBus setup_;
  double longitudinal_rad_ = 0, lateral_rad_ = 0;
};

}  // namespace kenaf::candrives
