// A plant that follows its command exactly: level ground, no load, no lag, no slip.
#pragma once

#include "can/candrives/plant.hpp"

namespace kenaf::candrives {

class IdealPlant final : public Plant {
 public:
  explicit IdealPlant(const std::array<double, robot::kFlipperCount>& flipper_rad = {}, double battery_v = 25.9);
  // Distance between the tracks, needed for turning; without it the plant does not turn.
  void set_gauge(double gauge_m) { gauge_m_ = gauge_m; }
  void advance(canopen::Time step, const PlantCommand& command) override;
  const PlantState& state() const override { return state_; }

 private:
  PlantState state_;
  double gauge_m_ = 0;
};

}  // namespace kenaf::candrives
