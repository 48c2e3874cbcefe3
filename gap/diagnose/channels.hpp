// The columns of a run that the diagnosis compares between robot and simulation.
// Thread safety: constants.
#pragma once

#include <span>
#include <string_view>

#include "physics/effects.hpp"

namespace kenaf::gap {

struct Channel {
  std::string_view column;   // of a `kenaf-runs/1` file
  std::string_view unit;
  bool angle;                // wraps
  physics::Stage measured;   // where on the way from command to sensor it is seen: drive, body or sensor
  double resolution;         // finer than this no difference counts, in `unit` (chosen)
  bool level = false;        // says little where the nose points up or down: small turns of the body turn it far
};

// Not among them: acceleration. Between contacts it says what posture and gyro say, and at a contact it is a spike whose
// height depends on the contact's stiffness and the sensor's bandwidth, which nobody knows.
std::span<const Channel> diagnosis_channels();

}  // namespace kenaf::gap
