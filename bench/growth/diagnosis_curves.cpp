#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>

#include "bench/growth/curves.hpp"
#include "tests/support/process.hpp"

namespace kenaf::bench {

namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

double seconds(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

double children_cpu_s() {
  rusage use{};
  getrusage(RUSAGE_CHILDREN, &use);
  return seconds(use.ru_utime) + seconds(use.ru_stime);
}

struct Cost {
  double cpu_s, wall_s;
};

Cost run(const Words& argv, const fs::path& log) {
  using Clock = std::chrono::steady_clock;
  const double cpu_before_s = children_cpu_s();
  const auto start = Clock::now();
  support::Process process(argv, log);
  std::optional<int> status;
  while (!(status = process.status())) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  if (*status != 0) {
    std::ifstream file(log);
    const std::string said((std::istreambuf_iterator<char>(file)), {});
    throw std::runtime_error(fmt::format("{} ended with {}: {}", fmt::join(argv, " "), *status, said));
  }
  return {children_cpu_s() - cpu_before_s, std::chrono::duration<double>(Clock::now() - start).count()};
}

// Names of all that a diagnosis of Kenaf looks for.
Words candidates(const fs::path& bin) {
  const support::TemporaryFolder folder;
  const fs::path log = folder.path() / "effects";
  run({bin / "kenaf-gap", "effects", "--robot", "kenaf", "--json"}, log);
  std::ifstream file(log);
  Words names;
  for (const auto& effect : nlohmann::json::parse(file)) names.push_back(effect.at("name"));
  return names;
}

// "Real" runs of a robot with slow drives: two manoeuvres, `repeats` times each.
void make_runs(const fs::path& bin, int repeats, const fs::path& out) {
  run({bin / "kenaf-gap", "simulate", "--manoeuvre", "straight", "--manoeuvre", "arc", "--repeats",
       std::to_string(repeats), "--effect", "drive_lag:lag_s=0.05", "--out", out},
      out.parent_path() / "simulate.log");
}

// The cost of a diagnosis of two manoeuvres, `repeats` times each, by `program`, with `more` options.
Cost diagnosis_by(const fs::path& bin, Words program, int repeats, const Words& more) {
  const support::TemporaryFolder folder;
  make_runs(bin, repeats, folder.path() / "runs");
  for (const std::string& word : Words{"diagnose", folder.path() / "runs", "--no-next", "--out", folder.path() / "out"})
    program.push_back(word);
  program.insert(program.end(), more.begin(), more.end());
  return run(program, folder.path() / "diagnose.log");
}

int cores() {
  return static_cast<int>(std::max(2U, std::thread::hardware_concurrency()));
}

}  // namespace

Growth over_effects(const fs::path& bin) {
  // The lag, which is hidden, is among the first and always searched for.
  Growth growth{"effects and numbers to look for, four runs", "s of the processors", {}, 1};
  const Words all = candidates(bin);
  for (const std::size_t share : {4U, 2U, 1U}) {
    Words left_out;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (i % share != 0 && all[i] != "drive_lag") left_out.push_back(all[i]);
    Words more;
    if (!left_out.empty()) more = {"--without", fmt::format("{}", fmt::join(left_out, ","))};
    growth.points.push_back(
        {static_cast<double>(all.size() - left_out.size()), diagnosis_by(bin, {bin / "kenaf-gap"}, 2, more).cpu_s});
  }
  return growth;
}

Growth over_runs(const fs::path& bin) {
  Growth growth{"runs, of two manoeuvres", "s of the processors", {}, 1};
  for (const int repeats : {2, 4, 8})
    growth.points.push_back({2.0 * repeats, diagnosis_by(bin, {bin / "kenaf-gap"}, repeats, {}).cpu_s});
  return growth;
}

Growth over_cores(const fs::path& bin) {
  Growth growth{"cores, four runs", "s", {}, -1};
  for (int jobs = 1; jobs <= cores(); jobs *= 2)
    growth.points.push_back({static_cast<double>(jobs),
                             diagnosis_by(bin, {bin / "kenaf-gap"}, 2, {"--jobs", std::to_string(jobs)}).wall_s});
  return growth;
}

Growth over_ranks(const fs::path& bin) {
  Growth growth{"MPI ranks of one core, four runs", "s", {}, -1};
  for (int ranks = 1; ranks <= cores(); ranks *= 2) {
    const Words program{"/usr/bin/env",       "mpirun", "--allow-run-as-root",
                        "--oversubscribe",    "-n",     std::to_string(ranks),
                        bin / "kenaf-gap-mpi"};
    growth.points.push_back({static_cast<double>(ranks), diagnosis_by(bin, program, 2, {"--jobs", "1"}).wall_s});
  }
  return growth;
}

}  // namespace kenaf::bench
