#include "bench/engines/speed.hpp"

#include <algorithm>
#include <barrier>
#include <chrono>
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

// Runs threads on a core each, started together. Returns the time that each took.
std::vector<Clocks> run_together(const EngineScene& scene, const Engine& engine, unsigned threads) {
  const long steps = steps_of(scene);
  std::vector<Clocks> taken(threads);
  std::barrier start(threads);
  std::vector<std::jthread> workers;
  for (unsigned w = 0; w < threads; ++w)
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
  return taken;
}

Rates medians(const std::vector<Rates>& rates) {
  std::vector<double> by_wall, by_cpu;
  for (const Rates& r : rates) {
    by_wall.push_back(r.by_wall);
    by_cpu.push_back(r.by_cpu);
  }
  return {median(by_wall), median(by_cpu)};
}

}  // namespace

std::vector<Speed> measure_speeds(const EngineScene& scene, const std::vector<Engine>& engines, int repeats) {
  // Results of each engine, one for each run.
  pin_to_core(0);
  struct Times {
    std::vector<double> cpu_us, wall_us, slower;
  };
  std::vector<Times> times(engines.size());
  std::vector<Speed> speeds(engines.size());

  // One run of an engine; building it is not timed.
  const long steps = steps_of(scene);
  const auto run = [&](std::size_t e) {
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
  };

  // Each engine directly after the reference, so that a drift of the core's speed cancels in their ratio.
  for (int repeat = 0; repeat < repeats; ++repeat)
    for (std::size_t e = 0; e < engines.size(); ++e) {
      run(0);
      if (e > 0) run(e);
      times[e].slower.push_back(times[e].cpu_us.back() / times[0].cpu_us.back());
    }

  // Medians over the repeats.
  for (std::size_t e = 0; e < engines.size(); ++e) {
    speeds[e].cpu_us_per_step = median(times[e].cpu_us);
    speeds[e].wall_us_per_step = median(times[e].wall_us);
    speeds[e].times_as_slow = median(times[e].slower);
  }
  return speeds;
}

Scaling measure_scaling(const EngineScene& scene, const Engine& engine, unsigned threads, int pairs) {
  // A thread is undisturbed if its wall-clock time is hardly longer than its CPU time.
  constexpr double kDisturbed = 1.02;
  constexpr double kPatience_s = 60;
  struct Pair {
    Rates one, all;
    Rates times() const { return {all.by_wall / one.by_wall, all.by_cpu / one.by_cpu}; }
  };

  // Pairs, one thread and then all, until enough are undisturbed or patience ends; after a disturbed one, a pause.
  std::vector<Pair> measured, undisturbed;
  const double begun_s = read_clocks().wall_s;
  while (static_cast<int>(undisturbed.size()) < pairs && read_clocks().wall_s - begun_s < kPatience_s) {
    bool quiet = true;
    const auto rates_of = [&](unsigned count) {
      Rates rates{};
      for (const Clocks& t : run_together(scene, engine, count)) {
        rates.by_wall += static_cast<double>(steps_of(scene)) / t.wall_s;
        rates.by_cpu += static_cast<double>(steps_of(scene)) / t.cpu_s;
        quiet = quiet && t.wall_s < kDisturbed * t.cpu_s;
      }
      return rates;
    };
    const Rates one = rates_of(1);
    measured.push_back({one, rates_of(threads)});
    if (quiet)
      undisturbed.push_back(measured.back());
    else
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }

  // Medians over the undisturbed pairs, or over all if there is none.
  std::vector<Rates> times, ones, alls;
  for (const Pair& pair : undisturbed.empty() ? measured : undisturbed) {
    times.push_back(pair.times());
    ones.push_back(pair.one);
    alls.push_back(pair.all);
  }
  return {medians(times), medians(ones), medians(alls), static_cast<int>(undisturbed.size()),
          static_cast<int>(measured.size())};
}

}  // namespace kenaf::bench
