#include "can/candrives/ideal_plant.hpp"

namespace kenaf::candrives {

IdealPlant::IdealPlant(const std::array<double, robot::kFlipperCount>& flipper_rad, double battery_v) {
  state_.flipper_rad = flipper_rad;
  state_.battery_v = battery_v;
}

void IdealPlant::advance(canopen::Time step, const PlantCommand& command) {
  const double step_s = std::chrono::duration<double>(step).count();
  if (step_s <= 0) return;
  for (std::size_t i = 0; i < robot::kTrackCount; ++i) {
    state_.track_mps[i] = command.track_mps[i];
    state_.track_m[i] += command.track_mps[i] * step_s;
  }
  for (std::size_t i = 0; i < robot::kFlipperCount; ++i) {
    state_.flipper_radps[i] = (command.flipper_rad[i] - state_.flipper_rad[i]) / step_s;
    state_.flipper_rad[i] = command.flipper_rad[i];
  }
  if (gauge_m_ > 0)
    state_.yaw_rate_radps = (command.track_mps[robot::kRight] - command.track_mps[robot::kLeft]) / gauge_m_;
}

}  // namespace kenaf::candrives
