#include "bench/engines/speed.hpp"

#include <algorithm>
#include <barrier>
#include <cmath>
#include <thread>

#include "bench/engines/machine.hpp"

namespace kenaf::bench {
namespace {

long steps_of(const EngineScene& scene) {
  return std::lround(scene.duration_s / scene.time_step_s);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

std::vector<Speed> measure_speeds(const EngineScene& scene, const std::vector<Engine>& engines, int repeats) {
  pin_to_core(0);
  struct Times {
    std::vector<double> cpu_us, wall_us;
  };
  std::vector<Times> times(engines.size());
  std::vector<Speed> speeds(engines.size());
  const long steps = steps_of(scene);
  for (int repeat = 0; repeat < repeats; ++repeat) {
    for (std::size_t e = 0; e < engines.size(); ++e) {
      const auto runner = engines[e].build(scene);
      std::size_t contacts = 0;
      const Clocks before = read_clocks();
      for (long i = 0; i < steps; ++i) {
        runner->step();
        contacts += runner->contacts();
      }
      const Clocks after = read_clocks();
      const auto n = static_cast<double>(steps);
      times[e].cpu_us.push_back(1e6 * (after.cpu_s - before.cpu_s) / n);
      times[e].wall_us.push_back(1e6 * (after.wall_s - before.wall_s) / n);
      speeds[e].contacts_per_step = static_cast<double>(contacts) / n;
      speeds[e].end = runner->pose();
    }
  }
  for (std::size_t e = 0; e < engines.size(); ++e) {
    speeds[e].cpu_us_per_step = median(times[e].cpu_us);
    speeds[e].wall_us_per_step = median(times[e].wall_us);
  }
  return speeds;
}

Scaling measure_scaling(const EngineScene& scene, const Engine& engine, unsigned threads, int repeats) {
  const long steps = steps_of(scene);
  struct Rates {
    double by_wall, by_cpu;
  };
  const auto rates_of = [&](unsigned count) {
    std::vector<Clocks> taken(count);
    std::barrier start(count);
    std::vector<std::jthread> workers;
    for (unsigned w = 0; w < count; ++w)
      workers.emplace_back([&, w] {
        pin_to_core(w);
        const auto runner = engine.build(scene);
        start.arrive_and_wait();
        const Clocks before = read_clocks();
        for (long i = 0; i < steps; ++i) runner->step();
        const Clocks after = read_clocks();
        taken[w] = {after.cpu_s - before.cpu_s, after.wall_s - before.wall_s};
      });
    workers.clear();
    Rates rates{};
    for (const Clocks& t : taken) {
      rates.by_wall += static_cast<double>(steps) / t.wall_s;
      rates.by_cpu += static_cast<double>(steps) / t.cpu_s;
    }
    return rates;
  };
  std::vector<double> by_wall, by_cpu, one_rates, all_rates;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    const Rates one = rates_of(1), all = rates_of(threads);
    by_wall.push_back(all.by_wall / one.by_wall);
    by_cpu.push_back(all.by_cpu / one.by_cpu);
    one_rates.push_back(one.by_wall);
    all_rates.push_back(all.by_wall);
  }
  return {median(by_wall), median(by_cpu), median(one_rates), median(all_rates)};
}

}  // namespace kenaf::bench
