// How costs grow: a table in Markdown with a row for each curve.
//
//   cost_growth [--bin DIR] [contacts|robots|larger-ground|finer-ground|rays|effects|runs|cores|ranks ...]
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>

#include "bench/growth/curves.hpp"
#include "command_line/checks.hpp"
#include "command_line/parse.hpp"

int main(int argc, char** argv) {
  using namespace kenaf;
  std::filesystem::path bin = KENAF_BIN_DIR;
  struct Curve {
    std::string over;
    std::function<bench::Growth()> measured;
  };
  const std::vector<Curve> curves{
      {"contacts", bench::over_contacts},
      {"robots", bench::over_robots},
      {"larger-ground", bench::over_triangles_of_larger_ground},
      {"finer-ground", bench::over_triangles_of_finer_ground},
      {"rays", bench::over_rays},
      {"effects", [&] { return bench::over_effects(bin); }},
      {"runs", [&] { return bench::over_runs(bin); }},
      {"cores", [&] { return bench::over_cores(bin); }},
      {"ranks", [&] { return bench::over_ranks(bin); }},
  };
  std::vector<std::string> names, chosen;
  for (const Curve& curve : curves) names.push_back(curve.over);

  CLI::App app{"How costs grow with contacts, robots, triangles, rays, effects, runs, cores and ranks", "cost_growth"};
  app.add_option("curves", chosen, "which; without any all, in ten minutes")->check(command_line::one_of(names));
  app.add_option("--bin", bin, "folder of kenaf-gap and kenaf-gap-mpi");
  if (const auto status = command_line::parse(app, argc, argv)) return *status;
  try {
    // Each row is shown once it is known: those of diagnoses take minutes.
    fmt::print("{}", bench::table_head());
    for (const Curve& curve : curves) {
      if (!chosen.empty() && std::ranges::find(chosen, curve.over) == chosen.end()) continue;
      fmt::print("{}", bench::table_row(curve.measured()));
      std::fflush(stdout);
    }
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "cost_growth: {}\n", error.what());
    return 2;
  }
}
