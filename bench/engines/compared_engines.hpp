// The engines of the comparison: Kenaf's own physics and those of rollout/engines/.
#pragma once

#include <vector>

#include "rollout/engines/runner.hpp"

namespace kenaf::bench {

using engines::Engine;
using engines::EngineScene;
using engines::Runner;

std::vector<Engine> kenaf_engines();  // without sensors, with

}  // namespace kenaf::bench
