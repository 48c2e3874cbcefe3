// The simulator against measurements and closed forms; docs/validation.md shows the result.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <filesystem>

#include "command_line/parse.hpp"
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

void print(const SteadyStates& states) {
  fmt::print("\n## MAXXII, {} steady states\n\n", states.count);
  fmt::print(
      "| turn over that of slipless tracks, medians | states | measured (scatter) | simulated | with asymmetry |\n");
  fmt::print("|---|---|---|---|---|\n");
  for (const TurningKind& kind : states.kinds)
    fmt::print("| {} | {} | {:.3f} ({:.3f}) | {:.3f} | {:.3f} |\n", kind.name, kind.count, kind.measured,
               kind.measured_scatter, kind.simulated, kind.corrected);
  fmt::print(
      "\nmedian of what the simulation leaves of the slips' difference: {:.4f} m/s; with a drive asymmetry of {:.4f}, "
      "fitted to the other half: {:.4f} m/s\n",
      states.median_mps, states.drive_asymmetry, states.corrected_median_mps);
}

}  // namespace

int main(int argc, char** argv) try {
  CLI::App app{"Compares the simulator with measurements and closed forms, as Markdown tables.", "validation-study"};
  std::filesystem::path table;
  app.add_option("--maxxii", table, "steady states of MAXXII, a CSV file; without it they are left out")
      ->type_name("FILE.csv");
  if (const auto status = kenaf::command_line::parse(app, argc, argv)) return *status;
  print("Turns on the spot, real robots", turns_of_real_robots());
  if (!table.empty()) print(compare_steady_states(table));
  print("Turns on the spot, closed form", turns_by_closed_form());
  print("Slopes", slope_limits());
  print("Drawbar pull", drawbar_pull());
  print("Steps", step_limits());
  print("Stairs", stair_limits());
  print("Balance on stairs", stair_balance());
} catch (const std::exception& error) {
  fmt::print(stderr, "validation-study: {}\n", error.what());
  return 1;
}
