// The mechanics driven by the simulated drives' motors: ideal ones, or the tracks and flippers of the simulated robot.
// SI units; flipper angles 0 = straight out, positive tip up; roll, pitch, yaw as in kenaf/hrt.h.
#pragma once

#include <array>

#include "can/canopen/frame.hpp"
#include "robot/parts.hpp"

namespace kenaf::candrives {

struct PlantCommand {
  std::array<double, robot::kTrackCount> track_mps{};
  std::array<double, robot::kFlipperCount> flipper_rad{};
};

struct PlantState {
  std::array<double, robot::kTrackCount> track_m{}, track_mps{}, track_a{};
  std::array<double, robot::kFlipperCount> flipper_rad{}, flipper_radps{}, flipper_a{};
  double battery_v = 0;
  double roll_rad = 0, pitch_rad = 0, yaw_rate_radps = 0;  // yaw rate in the body frame, as a gyro measures it
};

class Plant {
 public:
  virtual ~Plant() = default;
  // Advances by `step` under a constant command.
  virtual void advance(canopen::Time step, const PlantCommand& command) = 0;
  virtual const PlantState& state() const = 0;
};

}  // namespace kenaf::candrives
