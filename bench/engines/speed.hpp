// How fast engines simulate one scene, all in the same run.
#pragma once

#include <vector>

#include "bench/engines/runner.hpp"

namespace kenaf::bench {

struct Speed {
  double cpu_us_per_step, wall_us_per_step;  // medians over the repeats
  double contacts_per_step;
  physics::Pose end;                         // where the robot came to
  double steps_per_s() const { return 1e6 / cpu_us_per_step; }
};

// Each engine in turn, `repeats` times round, so that whatever else the machine does hurts all alike. On one core.
std::vector<Speed> measure_speeds(const EngineScene& scene, const std::vector<Engine>& engines, int repeats);

// Steps/s in sum of `threads` threads that simulate a scene each, over that of one; the median of `repeats` pairs.
struct Scaling {
  double by_wall, by_cpu;          // by_cpu leaves out what other programs took of the cores
  double steps_per_s_one, steps_per_s_all;  // by wall clock
};
Scaling measure_scaling(const EngineScene& scene, const Engine& engine, unsigned threads, int repeats);

}  // namespace kenaf::bench
