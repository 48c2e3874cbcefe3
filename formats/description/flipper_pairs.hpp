// Which flippers a robot has: the key `pairs` of [flipper]. The simulator and the real robot's bus both need it.
#pragma once

#include "formats/description/toml_reader.hpp"

namespace kenaf::description {

// At least one of the two.
struct FlipperPairs {
  bool front = true, rear = true;
  bool operator==(const FlipperPairs&) const = default;
};

// Reads `pairs` = "front", "rear" or "both"; "both" if the key is missing. Throws DescriptionError.
FlipperPairs read_flipper_pairs(TomlReader& flipper);

}  // namespace kenaf::description
