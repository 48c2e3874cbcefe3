#include "can/candrives/motors.hpp"

#include "can/candrives/ideal_plant.hpp"

namespace kenaf::candrives {

Motors make_ideal_motors(const MotorOptions& options, const canbus::RobotBus& bus) {
  auto plant = std::make_unique<IdealPlant>();
  plant->set_gauge(bus.track_gauge_m);
  return {std::move(plant), "robot " + options.robot + " with ideal motors"};
}

}  // namespace kenaf::candrives
