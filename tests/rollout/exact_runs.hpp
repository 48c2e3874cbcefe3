// Runs on flat ground without noise.
#pragma once

#include <string>
#include <vector>

#include "physics/world_description.hpp"
#include "rollout/roll_out.hpp"

namespace kenaf::test {

inline const physics::WorldDescription& flat() {
  static const physics::WorldDescription world = [] {
    std::vector<std::string> unsupported;
    return physics::load_world("flat", unsupported);
  }();
  return world;
}

inline rollout::RollOutOptions exact() {
  rollout::RollOutOptions options;
  options.noise_scale = 0;
  return options;
}

}  // namespace kenaf::test
