// Speed of engines in one scene, all measured in the same run.
#pragma once

#include <vector>

#include "bench/engines/compared_engines.hpp"

namespace kenaf::bench {

struct Speed {
  double cpu_us_per_step, wall_us_per_step;  // medians over the repeats
  double times_as_slow;  // CPU time over that of the first engine, run just before; median of the pairs
  double contacts_per_step;
  physics::Pose end;  // of the robot
  double steps_per_s() const { return 1e6 / cpu_us_per_step; }
};

// Runs each engine in turn on one core, `repeats` rounds, the first one before each of the others: the speed of a core
// that virtual machines share can drift by half within a minute, so only adjacent runs are compared.
std::vector<Speed> measure_speeds(const EngineScene& scene, const std::vector<Engine>& engines, int repeats);

// Total steps/s of threads that simulate a scene each: by wall-clock time, and by thread CPU time, which excludes the
// share that other programs took of the cores.
struct Rates {
  double by_wall, by_cpu;
};
// Rates of `threads` threads and of one, measured in pairs, one after the other. A pair counts if no thread waited for
// its core for more than 2 % of the time. Medians of the first `pairs` that count, or of all if none does within a
// minute.
struct Scaling {
  Rates times, one, all;
  int undisturbed, tried;
};
Scaling measure_scaling(const EngineScene& scene, const Engine& engine, unsigned threads, int pairs);

}  // namespace kenaf::bench
