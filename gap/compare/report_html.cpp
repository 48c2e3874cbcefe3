// The page of a comparison.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <optional>
#include <vector>

#include "gap/compare/figures.hpp"
#include "gap/compare/report.hpp"
#include "gap/compare/report_numbers.hpp"

namespace kenaf::gap::compare {

namespace {

using plot::escaped;

constexpr double kWide_px = 1100, kHalf_px = 540;
constexpr std::size_t kMostDrawn = 50;  // runs: browsers cannot show the figures of thousands

constexpr std::string_view kPageStyle = R"(body { background: var(--paper); color: var(--ink); max-width: 1100px;
  margin: 24px auto; padding: 0 16px; font: 15px/1.45 system-ui, "DejaVu Sans", "Liberation Sans", Arial, sans-serif; }
h1 { font-size: 24px; margin: 0 0 4px; } h2 { font-size: 18px; margin: 40px 0 2px; }
p { margin: 6px 0; max-width: 80ch; }
.soft { color: var(--soft); } a { color: var(--real); }
.tables { overflow-x: auto; }
table { border-collapse: collapse; font-size: 12px; margin: 12px 0; font-variant-numeric: tabular-nums; }
th, td { padding: 3px 5px; text-align: right; border-bottom: 1px solid var(--grid); white-space: nowrap; }
th:first-child, td:first-child { text-align: left; padding-left: 0; }
th { font-weight: 600; color: var(--soft); } th.group { text-align: center; border-left: 1px solid var(--grid); }
td.first, th.first { border-left: 1px solid var(--grid); }
tr.sum td { font-weight: 600; }
.figures { display: flex; flex-wrap: wrap; gap: 12px 20px; margin-top: 8px; }
@media print { h2 { break-before: page; } svg.chart, tr { break-inside: avoid; } .tables { overflow: visible; }
  table { font-size: 8px; } th, td { padding: 2px; } th:first-child, td:first-child { white-space: normal; } }
)";

// The worlds of the real runs, each loaded once; null if one does not load, with the reason in `notes`.
class Worlds {
 public:
  const physics::WorldDescription* find(const std::string& name) {
    auto [entry, is_new] = worlds_.try_emplace(name);
    if (is_new) {
      std::vector<std::string> unsupported;  // irrelevant for a picture
      try {
        entry->second = physics::load_world(name, unsupported);
      } catch (const description::DescriptionError& error) {
        notes.push_back(fmt::format("The ground is not drawn: {}", error.what()));
      }
    }
    return entry->second ? &*entry->second : nullptr;
  }
  std::vector<std::string> notes;

 private:
  std::map<std::string, std::optional<physics::WorldDescription>> worlds_;
};

std::string cells(const Summary& summary, double scale, int decimals) {
  return fmt::format("<td class=\"first\">{}</td><td>{}</td><td>{}</td>", number(scale * summary.mean(), decimals),
                     number(scale * summary.rms(), decimals), number(scale * summary.max(), decimals));
}

// The runs to draw: if there are too many, those with the largest mean errors, in the order of the comparison.
std::vector<std::size_t> drawn_runs(const Comparison& comparison) {
  std::vector<std::size_t> runs(comparison.runs.size());
  std::iota(runs.begin(), runs.end(), 0);
  if (runs.size() <= kMostDrawn) return runs;
  std::ranges::stable_sort(runs, std::ranges::greater{}, [&](std::size_t run) {
    return comparison.runs[run].errors.matched_summary.position_m.mean();
  });
  runs.resize(kMostDrawn);
  std::ranges::sort(runs);
  return runs;
}

std::string summary_table(const Comparison& comparison, const std::vector<std::size_t>& drawn) {
  std::string html =
      "<div class=\"tables\" role=\"group\" aria-label=\"Table\" tabindex=\"0\"><table>\n<tr><th "
      "rowspan=\"3\">run</th><th rowspan=\"3\">frames</th>"
      "<th class=\"group\" colspan=\"12\">matched frames</th><th class=\"group\" colspan=\"9\">same "
      "time</th></tr>\n<tr>"
      "<th class=\"group\" colspan=\"3\">position (mm)</th><th class=\"group\" colspan=\"3\">pitch (deg)</th>"
      "<th class=\"group\" colspan=\"3\">yaw (deg)</th><th class=\"group\" colspan=\"3\">time difference (s)</th>"
      "<th class=\"group\" colspan=\"3\">position (mm)</th><th class=\"group\" colspan=\"3\">pitch (deg)</th>"
      "<th class=\"group\" colspan=\"3\">yaw (deg)</th></tr>\n<tr>";
  for (int i = 0; i < 7; ++i) html += "<th class=\"first\">mean</th><th>RMS</th><th>max</th>";
  html += "</tr>\n";
  for (const SummaryRow& row : summary_rows(comparison)) {
    const bool is_run = row.kind == SummaryRow::Kind::run;
    html += is_run ? "<tr>" : "<tr class=\"sum\">";
    html += is_run && std::ranges::binary_search(drawn, row.run)
                ? fmt::format("<td><a href=\"#run-{}\">{}</a></td>", row.run, escaped(row.title))
                : fmt::format("<td>{}</td>", escaped(row.title));
    html += fmt::format("<td>{:.0f}</td>", row.matched.position_m.weight());
    html += cells(row.matched.position_m, kMillimetres, 1) + cells(row.matched.pitch_rad, kDegrees, 2) +
            cells(row.matched.yaw_rad, kDegrees, 2) + cells(row.matched.time_s, 1, 2) +
            cells(row.same_time.position_m, kMillimetres, 1) + cells(row.same_time.pitch_rad, kDegrees, 2) +
            cells(row.same_time.yaw_rad, kDegrees, 2) + "</tr>\n";
  }
  return html + "</table></div>\n";
}

std::string quantities_table(const ComparedRun& run) {
  const RunErrors& errors = run.errors;
  std::string html =
      "<div class=\"tables\" role=\"group\" aria-label=\"Table\" tabindex=\"0\"><table>\n<tr><th "
      "rowspan=\"2\">error</th>"
      "<th class=\"group\" colspan=\"3\">matched frames</th><th class=\"group\" colspan=\"3\">same time</th>"
      "<th class=\"group\">at the end</th></tr>\n<tr>";
  for (int i = 0; i < 2; ++i) html += "<th class=\"first\">mean</th><th>RMS</th><th>max</th>";
  html += "<th class=\"first\">sim - real</th></tr>\n";
  const auto row = [&](std::string_view name, Summary ErrorSummary::*summary, double FrameError::*end, double scale,
                       int decimals) {
    html += fmt::format("<tr><td>{}</td>{}{}<td class=\"first\">{}</td></tr>\n", name,
                        cells(errors.matched_summary.*summary, scale, decimals),
                        cells(errors.same_time_summary.*summary, scale, decimals),
                        number(scale * errors.at_end.*end, decimals));
  };
  row(fmt::format("position, norm of {} (mm)", coordinates(run.plane)), &ErrorSummary::position_m,
      &FrameError::position_m, kMillimetres, 1);
  row("y (mm)", &ErrorSummary::y_m, &FrameError::y_m, kMillimetres, 1);
  row("roll (deg)", &ErrorSummary::roll_rad, &FrameError::roll_rad, kDegrees, 2);
  row("pitch (deg)", &ErrorSummary::pitch_rad, &FrameError::pitch_rad, kDegrees, 2);
  row("yaw (deg)", &ErrorSummary::yaw_rad, &FrameError::yaw_rad, kDegrees, 2);
  row("time difference (s)", &ErrorSummary::time_s, &FrameError::time_s, 1, 2);
  return html + "</table></div>\n";
}

std::string start_sentence(const ComparedRun& run, const CompareOptions& options) {
  if (!options.align_start) return "The runs keep their recorded starts; they were not aligned.";
  const StartOffset& offset = run.start_offset;
  std::string text = fmt::format("To align the starts, the simulated run was moved by {:.1f} mm in x, {:.1f} mm in y",
                                 kMillimetres * offset.x_m, kMillimetres * offset.y_m);
  return text + (offset.turned ? fmt::format(" and {:.2f} degrees in yaw.", kDegrees * offset.yaw_rad)
                               : "; it was not turned, because y or yaw of a start was not measured.");
}

std::string run_section(const Comparison& comparison, std::size_t index, Worlds& worlds) {
  const ComparedRun& run = comparison.runs[index];
  std::string html = fmt::format("<h2 id=\"run-{}\">{}</h2>\n", index, escaped(run_title(comparison, index)));
  html += fmt::format(
      "<p class=\"soft\">Real {} ({} frames), simulated {} ({} frames), world {}. {} Data: {}.</p>\n",
      escaped(run.real_file), run.real.size(), escaped(run.sim_file), run.sim.size(),
      escaped(run.real_world == run.sim_world ? run.real_world : run.real_world + ", simulated in " + run.sim_world),
      start_sentence(run, comparison.options), matched_file_name(index));
  html += "<div class=\"figures\">\n" + to_svg(path_figure(run, worlds.find(run.real_world), kWide_px));
  if (const auto plan = plan_figure(run, kWide_px)) html += to_svg(*plan);
  html += to_svg(angle_figure(run, kWide_px)) + to_svg(position_error_figure(run, kHalf_px)) +
          to_svg(angle_error_figure(run, kHalf_px)) + "</div>\n";
  return html + quantities_table(run);
}

std::string left_out_list(const Comparison& comparison) {
  if (comparison.left_out.empty()) return "";
  std::string html = "<h2>Not compared</h2>\n<ul>\n";
  for (const LeftOut& run : comparison.left_out) {
    html += fmt::format("<li>{} {}{}: {}</li>\n", run.dataset, escaped(run.file),
                        run.manoeuvre.empty() ? "" : escaped(" (" + run.manoeuvre + ")"), escaped(run.why));
  }
  return html + "</ul>\n";
}

std::string dataset_line(std::string_view which, const runs::Dataset& dataset, const std::filesystem::path& folder) {
  return fmt::format("<p>{}: {}, robot {}{}{}</p>\n", which, escaped(folder.string()), escaped(dataset.robot),
                     dataset.description.empty() ? "" : ". ", escaped(dataset.description));
}

}  // namespace

std::string comparison_html(const Comparison& comparison) {
  // The sections come first, because they load the worlds and collect notes on them.
  Worlds worlds;
  std::string sections;
  const std::vector<std::size_t> drawn = drawn_runs(comparison);
  if (drawn.size() < comparison.runs.size())
    sections += fmt::format("<p>The page plots the {1} of {0} runs with the largest errors.</p>\n",
                            comparison.runs.size(), drawn.size());
  for (const std::size_t run : drawn) sections += run_section(comparison, run, worlds);

  // Head, datasets, explanation and notes, then the tables and sections.
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>Real and simulated "
      "runs</title>\n"
      "<style>\n{}{}</style>\n</head>\n<body>\n<main>\n<h1>Real and simulated runs</h1>\n",
      plot::style_sheet(), kPageStyle);
  html += dataset_line("Real", comparison.real, comparison.real_folder);
  html += dataset_line("Simulated", comparison.sim, comparison.sim_folder);
  html +=
      "<p class=\"soft\">DP matching pairs the frames of both runs in order, so that the distances of their positions, "
      "(x, z), or (x, y) where a run has no z, are smallest. It compares paths and hides delays: two runs along one "
      "path match without error, whatever "
      "their delay. Two columns show the delay: time difference (of the matched simulated frame; it means little while "
      "the robot is at rest) and same time (errors without matching). All values are absolute.</p>\n";
  for (const std::string& note : worlds.notes) html += fmt::format("<p>{}</p>\n", escaped(note));
  return html + summary_table(comparison, drawn) + sections + left_out_list(comparison) + "</main>\n</body>\n</html>\n";
}

}  // namespace kenaf::gap::compare
