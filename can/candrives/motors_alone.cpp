// In a build without the simulator.
#include <stdexcept>

#include "can/candrives/motors.hpp"

namespace kenaf::candrives {

void add_motor_options(CLI::App& app, MotorOptions& options) {
  app.add_flag("--ideal", options.ideal,
               "Motors that follow exactly, tracks that never slip, level ground; needed: this build of Kenaf has no "
               "simulated robot");
}

Motors make_motors(const MotorOptions& options, const canbus::RobotBus& bus) {
  // Not chosen in silence: a script that expects a world would measure something else.
  if (!options.ideal)
    throw std::runtime_error("this build of Kenaf has no simulated robot (KENAF_BUILD_SIMULATOR=OFF): give --ideal");
  return make_ideal_motors(options, bus);
}

}  // namespace kenaf::candrives
