// How fast engines simulate one scene, all in the same run.
#pragma once

#include <vector>

#include "bench/engines/compared_engines.hpp"

namespace kenaf::bench {

struct Speed {
  double cpu_us_per_step, wall_us_per_step;  // medians over the repeats
  double times_as_slow;  // as the first engine, which ran just before each time; median of the pairs
  double contacts_per_step;
  physics::Pose end;  // where the robot came to
  double steps_per_s() const { return 1e6 / cpu_us_per_step; }
};

// Each engine in turn, `repeats` times round, the first one before each of the others: a core's speed can drift by half
// within a minute where other machines share it, so only what ran side by side is compared. On one core.
std::vector<Speed> measure_speeds(const EngineScene& scene, const std::vector<Engine>& engines, int repeats);

// Steps/s in sum of threads that simulate a scene each: by the clock on the wall, and by the threads' own time, which
// leaves out what other programs took of the cores.
struct Rates {
  double by_wall, by_cpu;
};
// Of `threads` threads over that of one, measured in pairs, one after the other. A pair counts where no thread waited
// for its core for more than 2 % of the time. Medians of the first `pairs` that count, or of all where none does within
// a minute.
struct Scaling {
  Rates times, one, all;
  int undisturbed, tried;
};
Scaling measure_scaling(const EngineScene& scene, const Engine& engine, unsigned threads, int pairs);

}  // namespace kenaf::bench
