// Kenaf's physics beside MuJoCo's and ODE's: the same robot on the same terrain at the same time step, in one run.
// compared_engines.hpp describes each engine's settings, docs/performance.md has the figures. Status 1 if a limit is
// missed.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "bench/engines/accuracy.hpp"
#include "bench/engines/machine.hpp"
#include "bench/engines/speed.hpp"
#include "command_line/checks.hpp"
#include "command_line/parse.hpp"

using namespace kenaf::bench;
using namespace kenaf::engines;

namespace {

constexpr double kTimesFaster = 2, kTwoCores = 1.9;

std::string name_of(const Engine& engine) {
  return engine.name + ", " + engine.setting;
}

void print_speeds(const EngineScene& scene, const std::vector<Engine>& engines, const std::vector<Speed>& speeds) {
  fmt::print("\n{}\n{:<41} {:>9} {:>9} {:>12} {:>9} {:>9} {:>7} {:>7} {:>7}\n", scene.name, "", "steps/s", "real time",
             "contacts/step", "us/step", "us, wall", "Kenaf", "end x", "end z");
  for (std::size_t e = 0; e < engines.size(); ++e) {
    const Speed& s = speeds[e];
    fmt::print("{:<41} {:>9.0f} {:>8.1f}x {:>13.1f} {:>9.2f} {:>9.2f} {:>6.2f}x {:>7.3f} {:>7.3f}\n",
               name_of(engines[e]), s.steps_per_s(), s.steps_per_s() * scene.time_step_s, s.contacts_per_step,
               s.cpu_us_per_step, s.wall_us_per_step, s.times_as_slow, s.end.p.x(), s.end.p.z());
  }
}

void print_accuracy(const std::vector<Engine>& engines, const std::vector<std::vector<double>>& accuracy) {
  fmt::print("\nerrors against closed forms\n{:<41}", "");
  for (const AccuracyFigure& figure : accuracy_figures()) fmt::print(" {:>20}", figure.name);
  fmt::print("\n");
  for (std::size_t e = 0; e < engines.size(); ++e) {
    fmt::print("{:<41}", name_of(engines[e]));
    for (std::size_t i = 0; i < accuracy[e].size(); ++i)
      fmt::print(" {:>20}", fmt::format(fmt::runtime(accuracy_figures()[i].format), accuracy[e][i]));
    fmt::print("\n");
  }
  for (const AccuracyFigure& figure : accuracy_figures()) fmt::print("  {}: {}\n", figure.name, figure.what);
}

// Compares the first engine with the others; prints where it is slower or less accurate than required.
bool holds_limits(const std::vector<EngineScene>& scenes, const std::vector<Engine>& engines,
                  const std::vector<std::vector<Speed>>& speeds, const std::vector<std::vector<double>>& accuracy) {
  bool holds = true;
  for (std::size_t e = 0; e < engines.size(); ++e) {
    if (engines[e].name == engines[0].name || !engines[e].same_contacts) continue;
    for (std::size_t s = 0; s < scenes.size(); ++s) {
      const double times = speeds[s][e].times_as_slow;
      if (times >= kTimesFaster) continue;
      holds = false;
      fmt::print("limit missed: {}: {:.2f} times as fast as {}, not {:.1f}\n", scenes[s].name, times,
                 name_of(engines[e]), kTimesFaster);
    }
    for (std::size_t i = 0; i < accuracy_figures().size(); ++i) {
      const AccuracyFigure& figure = accuracy_figures()[i];
      constexpr double kRounding = 1e-9;
      if (std::abs(accuracy[0][i]) <= std::max(std::abs(accuracy[e][i]), figure.tolerance) + kRounding) continue;
      holds = false;
      fmt::print("limit missed: {} is {:.3f}, worse than {}: {:.3f}\n", figure.name, accuracy[0][i],
                 name_of(engines[e]), accuracy[e][i]);
    }
  }
  return holds;
}

std::string csv_of(const Machine& machine, const std::vector<EngineScene>& scenes, const std::vector<Engine>& engines,
                   const std::vector<std::vector<Speed>>& speeds, const std::vector<std::vector<double>>& accuracy,
                   const EngineScene& scaled, const Scaling& scaling) {
  // The header; accuracy has a column for each figure.
  std::string out =
      "processor,cores,compiler,scene,engine,version,setting,threads,time_step_s,steps_per_s,real_time_factor,"
      "contacts_per_step,cpu_us_per_step,wall_us_per_step,kenaf_times_as_fast,end_x_m,end_z_m";
  for (const AccuracyFigure& figure : accuracy_figures()) out += fmt::format(",{}", figure.name);
  out += "\n";
  const std::string where = fmt::format("\"{}\",{},\"{}\"", machine.processor, machine.cores, machine.compiler);

  // A row for each scene and engine, on one thread, with the engine's accuracy.
  for (std::size_t s = 0; s < scenes.size(); ++s)
    for (std::size_t e = 0; e < engines.size(); ++e) {
      const Speed& speed = speeds[s][e];
      out += fmt::format("{},\"{}\",{},{},\"{}\",1,{},{:.0f},{:.2f},{:.2f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f}", where,
                         scenes[s].name, engines[e].name, engines[e].version, engines[e].setting, scenes[s].time_step_s,
                         speed.steps_per_s(), speed.steps_per_s() * scenes[s].time_step_s, speed.contacts_per_step,
                         speed.cpu_us_per_step, speed.wall_us_per_step, speed.times_as_slow, speed.end.p.x(),
                         speed.end.p.z());
      for (const double error : accuracy[e]) out += fmt::format(",{:.4f}", error);
      out += "\n";
    }

  // Two rows for one and two threads with a world each; times per step are those of each thread.
  for (const auto& [threads, rates] : {std::pair(1, scaling.one), std::pair(2, scaling.all)}) {
    out +=
        fmt::format("{},\"{}, a world each\",{},{},\"{}\",{},{},{:.0f},{:.2f},,{:.3f},{:.3f},,,", where, scaled.name,
                    engines[0].name, engines[0].version, engines[0].setting, threads, scaled.time_step_s, rates.by_wall,
                    rates.by_wall * scaled.time_step_s, threads * 1e6 / rates.by_cpu, threads * 1e6 / rates.by_wall);
    out += std::string(accuracy_figures().size(), ',') + "\n";
  }
  return out;
}

void write_file(const std::filesystem::path& path, const std::string& text) {
  const std::filesystem::path temporary = path.string() + ".part";
  std::ofstream file(temporary, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw std::runtime_error(fmt::format("{} cannot be written", temporary.string()));
  std::filesystem::rename(temporary, path);
}

}  // namespace

int main(int argc, char** argv) try {
  CLI::App app("Compares Kenaf's physics with MuJoCo's and ODE's", "engines");
  std::string csv;
  int repeats = 3;
  app.add_option("--csv", csv, "also write the results to this file");
  app.add_option("--repeats", repeats, "of each scene with each engine; medians are reported")
      ->check(kenaf::command_line::whole_number(1, 1000));
  if (const auto status = kenaf::command_line::parse(app, argc, argv)) return *status;

  // Kenaf's engines first: they are the reference.
  const Machine machine = this_machine();
  std::vector<Engine> engines = kenaf_engines();
  for (const auto& more : {mujoco_engines(), ode_engines()}) engines.insert(engines.end(), more.begin(), more.end());
  fmt::print("{}, {} cores, {}\n", machine.processor, machine.cores, machine.compiler);
  fmt::print("Kenaf {}, MuJoCo {}, ODE {}; medians of {} runs, thread time on one core\n", engines.front().version,
             mujoco_engines().front().version, engines.back().version, repeats);

  // Speed in each scene, then accuracy.
  const std::vector<EngineScene> scenes = climbs();
  std::vector<std::vector<Speed>> speeds;
  for (const EngineScene& scene : scenes) {
    speeds.push_back(measure_speeds(scene, engines, repeats));
    print_speeds(scene, engines, speeds.back());
    std::fflush(stdout);
  }
  std::vector<std::vector<double>> accuracy;
  for (const Engine& engine : engines) accuracy.push_back(measure_accuracy(engine));
  print_accuracy(engines, accuracy);

  // Two worlds on two cores, then all limits.
  const Scaling scaling = measure_scaling(scenes[2], engines[0], 2, repeats);
  fmt::print(
      "\ntwo cores, a world each ({}): {:.2f} times the steps/s of one by wall clock, {:.2f} by thread time; {} of {} "
      "pairs of runs undisturbed by other programs\n",
      scenes[2].name, scaling.times.by_wall, scaling.times.by_cpu, scaling.undisturbed, scaling.tried);
  bool holds = holds_limits(scenes, engines, speeds, accuracy);
  if (scaling.times.by_wall < kTwoCores) {
    holds = false;
    fmt::print("limit missed: two cores make {:.2f} times the steps of one, not {:.1f}{}\n", scaling.times.by_wall,
               kTwoCores, scaling.undisturbed ? "" : " (other programs took the cores all the time)");
  }
  if (!csv.empty()) write_file(csv, csv_of(machine, scenes, engines, speeds, accuracy, scenes[2], scaling));
  return holds ? 0 : 1;
} catch (const std::exception& error) {
  fmt::print(stderr, "engines: {}\n", error.what());
  return 2;
}
