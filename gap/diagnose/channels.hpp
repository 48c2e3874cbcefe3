// The columns of a run that the diagnosis compares between robot and simulation.
// Thread safety: constants.
#pragma once

#include <cstddef>
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
  std::string_view kind;     // channels of one kind share the size of what no effect explains: "track speed"
  bool level = false;        // says little where the nose points up or down: small turns of the body turn it far
};

// Not among them: acceleration. Between contacts it says what posture and gyro say, and at a contact it is a spike whose
// height depends on the contact's stiffness and the sensor's bandwidth, which nobody knows.
std::span<const Channel> diagnosis_channels();
// Numbers of kinds, from 0 on, in the order of the channels.
std::size_t kind_of(std::size_t channel);
std::size_t kind_count();
std::string_view kind_name(std::size_t kind);  // "track speed"

}  // namespace kenaf::gap
