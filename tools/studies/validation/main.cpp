// The simulator against measurements and closed forms; docs/validation.md shows the result.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <filesystem>

#include "tools/studies/validation/comparison_row.hpp"
#include "tools/studies/validation/limits.hpp"
#include "tools/studies/validation/maxxii.hpp"
#include "tools/studies/validation/turning.hpp"

namespace {

using namespace kenaf::validation;

void print(const char* title, const std::vector<ComparisonRow>& rows) {
  fmt::print("\n## {}\n\n| what | reference | expected | simulated | ratio |\n|---|---|---|---|---|\n", title);
  for (const ComparisonRow& row : rows) fmt::print("{}", markdown(row));
}

void print(const std::vector<SlipRow>& rows) {
  fmt::print("\n## Slip of Kenaf's belts on slopes, friction 0.7\n\n| slope over the steepest | slip |\n|---|---|\n");
  for (const SlipRow& row : rows) fmt::print("| {:.2f} | {:.3f} |\n", row.share_of_limit, row.slip);
}

void print(const SteadyStates& states) {
  fmt::print("\n## MAXXII, {} steady states\n\n", states.count);
  fmt::print("| turn over that of slipless tracks | states | measured (sd) | simulated | with the correction |\n");
  fmt::print("|---|---|---|---|---|\n");
  for (const TurningKind& kind : states.kinds)
    fmt::print("| {} | {} | {:.3f} ({:.3f}) | {:.3f} | {:.3f} |\n", kind.name, kind.count, kind.measured,
               kind.measured_sd, kind.simulated, kind.corrected);
  fmt::print("\nrms of what the simulation leaves of the slips: {:.4f} m/s; with the correction {:.4f} m/s\n",
             states.rms_mps, states.corrected_rms_mps);
  fmt::print("correction: left {:.4f}, right {:.4f} of the track's speed, and {:.4f} s/m times its square\n",
             states.left_share, states.right_share, states.growth_spm);
}

}  // namespace

int main(int argc, char** argv) try {
  CLI::App app{"Compares the simulator with measurements and closed forms, as Markdown tables."};
  std::filesystem::path table;
  app.add_option("--maxxii", table, "steady states of MAXXII, a CSV file; without it they are left out")
      ->check(CLI::ExistingFile)
      ->type_name("FILE.csv");
  CLI11_PARSE(app, argc, argv);
  print("Turns on the spot, real robots", turns_of_real_robots());
  if (!table.empty()) print(compare_steady_states(table));
  print("Turns on the spot, closed form", turns_by_closed_form());
  print("Slopes", slope_limits());
  print(slip_on_slopes());
  print("Steps", step_limits());
  print("Stairs", stair_limits());
} catch (const std::exception& error) {
  fmt::print(stderr, "validation-study: {}\n", error.what());
  return 1;
}
