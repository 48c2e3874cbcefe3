// The summary for the terminal, and the parts that it shares with the page.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "gap/compare/report.hpp"
#include "gap/compare/report_numbers.hpp"

namespace kenaf::gap::compare {

namespace {

constexpr std::size_t kMostRows = 24, kMostLeftOut = 6;

std::string plural(std::size_t count, std::string_view what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

void add_row(std::string& text, const SummaryRow& row, std::size_t width) {
  const auto column = [&text](const Summary& summary, double scale, int decimals) {
    for (const double value : {summary.mean(), summary.rms(), summary.max()})
      text += fmt::format("{:>7}", number(scale * value, decimals));
    text += ' ';
  };
  text += fmt::format("{:<{}}", row.title, width);
  column(row.matched.position_m, kMillimetres, 1);
  column(row.matched.pitch_rad, kDegrees, 2);
  column(row.matched.yaw_rad, kDegrees, 2);
  text += fmt::format("{:>7}", number(row.matched.time_s.max(), 2));
  text += fmt::format("{:>9}{:>7}\n", number(kMillimetres * row.same_time.position_m.mean(), 1),
                      number(kMillimetres * row.same_time.position_m.max(), 1));
}

}  // namespace

std::string number(double value, int decimals) {
  return std::isnan(value) ? "-" : fmt::format("{:.{}f}", value, decimals);
}

std::string coordinates(Plane plane) {
  return plane == Plane::vertical ? "(x, z)" : "(x, y)";
}

std::string run_title(const Comparison& comparison, std::size_t index) {
  const ComparedRun& run = comparison.runs[index];
  if (run.manoeuvre.empty()) return run.real_file;
  const bool repeated = std::ranges::count(comparison.runs, run.manoeuvre, &ComparedRun::manoeuvre) > 1;
  return repeated ? fmt::format("{} #{}", run.manoeuvre, run.repeat + 1) : run.manoeuvre;
}

std::vector<SummaryRow> summary_rows(const Comparison& comparison) {
  std::vector<SummaryRow> rows;
  const std::vector<ManoeuvreErrors> manoeuvres = by_manoeuvre(comparison);
  for (const ManoeuvreErrors& manoeuvre : manoeuvres) {
    for (const std::size_t run : manoeuvre.runs) {
      const RunErrors& errors = comparison.runs[run].errors;
      rows.push_back(
          {SummaryRow::Kind::run, run_title(comparison, run), run, errors.matched_summary, errors.same_time_summary});
    }
    if (manoeuvre.runs.size() < 2) continue;
    rows.push_back({SummaryRow::Kind::manoeuvre,
                    fmt::format("{}, {} runs", manoeuvre.manoeuvre.empty() ? "(no name)" : manoeuvre.manoeuvre,
                                manoeuvre.runs.size()),
                    0, manoeuvre.matched, manoeuvre.same_time});
  }

  if (manoeuvres.size() > 1) {
    const ManoeuvreErrors all = over_all(comparison);
    rows.push_back({SummaryRow::Kind::all, "all " + plural(all.runs.size(), "run"), 0, all.matched, all.same_time});
  }
  return rows;
}

std::string comparison_text(const Comparison& comparison) {
  std::vector<SummaryRow> rows = summary_rows(comparison);
  // Too many rows: drops runs that their manoeuvre's row sums up, then rows from the end except the last, all runs.
  if (rows.size() > kMostRows) {
    std::erase_if(rows, [&](const SummaryRow& row) {
      const bool alone =
          row.kind == SummaryRow::Kind::run &&
          std::ranges::count(comparison.runs, comparison.runs[row.run].manoeuvre, &ComparedRun::manoeuvre) == 1;
      return row.kind == SummaryRow::Kind::run && !alone;
    });
  }
  const std::size_t left_away = rows.size() > kMostRows ? rows.size() - kMostRows : 0;
  if (left_away > 0) rows.erase(rows.end() - 1 - static_cast<std::ptrdiff_t>(left_away), rows.end() - 1);

  // Two lines of head, then the rows and the runs that were left out.
  std::size_t width = 12;
  for (const SummaryRow& row : rows) width = std::max(width, row.title.size());
  std::string text = fmt::format("{:<{}}{:>21} {:>21} {:>21} {:>7}  {:>14}\n", "matched frames", width, "position, mm",
                                 "pitch, degrees", "yaw, degrees", "warp, s", "same time, mm");
  text += fmt::format("{:<{}}", "", width);
  for (int i = 0; i < 3; ++i) text += fmt::format("{:>7}{:>7}{:>7} ", "mean", "RMS", "max");
  text += fmt::format("{:>7}{:>9}{:>7}\n", "max", "mean", "max");
  for (const SummaryRow& row : rows) add_row(text, row, width);
  if (left_away > 0) text += fmt::format("({} more in compare.html)\n", plural(left_away, "row"));
  for (std::size_t i = 0; i < std::min(kMostLeftOut, comparison.left_out.size()); ++i) {
    const LeftOut& run = comparison.left_out[i];
    text += fmt::format("left out: {} {}: {}\n", run.dataset, run.file, run.why);
  }
  if (comparison.left_out.size() > kMostLeftOut) {
    text += fmt::format("left out: {} more\n", comparison.left_out.size() - kMostLeftOut);
  }
  return text;
}

}  // namespace kenaf::gap::compare
