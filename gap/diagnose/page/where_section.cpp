#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gap/diagnose/page/figures.hpp"
#include "gap/diagnose/page/sections.hpp"
#include "gap/diagnose/page/words.hpp"
#include "gap/diagnose/report.hpp"
#include "gap/plot/row_chart.hpp"
#include "gap/plot/strip_chart.hpp"

namespace kenaf::gap {
namespace {

constexpr std::size_t kMostPhases = 12;  // in the table
constexpr double kStays_m = 0.1;         // too small a motion for a map

double share_left(const Diagnosis& d) {
  return d.where.beyond_chance > 0 ? d.where_left.beyond_chance / d.where.beyond_chance : 0;
}

// `scale`: of shares, to shares of the gap before.
std::string time_map(const Diagnosis& d, std::span<const Overlay> overlays, const GapPlaces& where, double scale,
                     std::string_view title) {
  double most = 0;
  for (const PhaseGap& phase : d.where.phases) most = std::max(most, phase.share);
  plot::StripChart chart;
  chart.title = title;
  chart.x_label = "t (s)";
  chart.legend = "share of the gap before:";
  chart.least = "0 %";
  chart.most = percent(most);
  chart.width_px = kWide_px;
  for (const Overlay& overlay : overlays) {
    plot::Strip strip{group_title(d, overlay.group), {}};
    for (const PhaseGap& phase : where.phases) {
      if (phase.group != overlay.group) continue;
      const double share = phase.share * scale;
      strip.spans.push_back(
          {phase.from_s, phase.to_s, most > 0 ? share / most : 0, std::string(phase.phase), percent(share)});
    }
    std::ranges::sort(strip.spans, {}, &plot::StripSpan::from);
    chart.strips.push_back(std::move(strip));
  }
  return to_svg(chart);
}

std::string phase_table(const Diagnosis& d) {
  Table table{
      {"manoeuvre", "phase", "from (s)", "to (s)", "x (m)", "y (m)", "share of the gap", "left after"}, {}, {0, 1}};
  for (const PhaseGap& phase : d.where.phases) {
    if (table.rows.size() == kMostPhases || phase.share < 0.005) break;
    const auto left = std::ranges::find_if(d.where_left.phases, [&](const PhaseGap& other) {
      return other.group == phase.group && other.from_s == phase.from_s;
    });
    const bool known = !d.best.empty() && left != d.where_left.phases.end();
    table.rows.push_back({group_title(d, phase.group), std::string(phase.phase), fmt::format("{:.1f}", phase.from_s),
                          fmt::format("{:.1f}", phase.to_s), figure(phase.x_m), figure(phase.y_m), percent(phase.share),
                          known ? percent(left->share * share_left(d)) : "-"});
  }
  return to_html(table);
}

std::string stages_figure(const Diagnosis& d) {
  plot::RowChart chart;
  chart.title = "The gap of each passage from command to sensor, without the passages before it";
  chart.x_label = "squared difference over what chance gives (1: chance)";
  std::vector<std::string> unmeasured;
  for (const StageGap& stage : d.stages) {
    if (stage.bins == 0) {
      unmeasured.emplace_back(passage_name(stage.passage));
      continue;
    }
    const bool beyond = stage.chance > kStageChance;
    chart.rows.push_back({std::string(passage_name(stage.passage)),
                          {{stage.chance, beyond ? plot::Shape::disc : plot::Shape::ring, plot::Ink::sim}},
                          figure(stage.chance)});
  }
  std::string html;
  if (!chart.rows.empty()) {
    chart.legend = {{plot::Shape::disc, plot::Ink::sim, "has a gap of its own"},
                    {plot::Shape::ring, plot::Ink::sim, "has none beyond chance"}};
    chart.guides = {{kStageChance, "beyond chance"}};
    chart.logarithmic = true;
    chart.label_px = 140;
    chart.note_px = 80;
    chart.width_px = kWide_px;
    html += to_svg(chart);
  }
  if (!unmeasured.empty())
    html += paragraph(fmt::format("Not measured by these runs: {}.", enumeration(unmeasured)), "soft");
  return html;
}

bool moves(const plot::Chart& chart) {
  plot::Point low(1e9, 1e9), high = -low;
  for (const plot::Line& line : chart.lines)
    for (const plot::Point& p : line.points)
      if (p.allFinite()) low = low.cwiseMin(p), high = high.cwiseMax(p);
  return (high - low).maxCoeff() > kStays_m;
}

std::string maps(const Diagnosis& d, std::span<const Overlay> overlays) {
  std::string figures;
  std::vector<std::string> staying;
  for (const Overlay& overlay : overlays) {
    const plot::Chart chart = places_figure(d, overlay);
    if (moves(chart))
      figures += to_svg(chart);
    else
      staying.push_back(group_title(d, overlay.group));
  }
  std::string html;
  if (!figures.empty())
    html +=
        paragraph(fmt::format("In the world: a circle's area is the share of the gap in a phase, at the place in its "
                              "middle. Rings: before{}.",
                              d.best.empty() ? "" : "; discs: after, of the same scale"),
                  "soft") +
        "<div class=\"figures\">\n" + figures + "</div>\n";
  if (!staying.empty())
    html += paragraph(fmt::format("Not mapped, as the robot stays within {} m: {}.", kStays_m, enumeration(staying)),
                      "soft");
  return html;
}

}  // namespace

std::string where_section(const Diagnosis& d, std::span<const Overlay> overlays) {
  std::string html = section_head("where", "Where the gap is");
  if (d.where.phases.empty() || overlays.empty())
    return html + paragraph("Nothing was located before the diagnosis ended.");
  if (d.where.beyond_chance <= 0) return html + paragraph("Nowhere: no stretch of any channel is beyond chance.");
  const bool none = d.interrupted.empty() && d.decision.verdict == Verdict::none;
  html += paragraph(none ? "There is no gap; shares are of the little that differs beyond the average of chance."
                         : fmt::format("Stage at which it comes in: {}.", gap_stage(d)));
  html += stages_figure(d);
  html += paragraph(
      fmt::format("Phases are found from the data. The gap is counted in stretches of {} s of each channel, so "
                  "a shorter phase takes part of its neighbours' gap.",
                  d.options.stretch_s),
      "soft");
  html += time_map(d, overlays, d.where, 1,
                   "Where over time, before: the phases of each manoeuvre by their share of the gap");
  if (!d.best.empty())
    html += time_map(
        d, overlays, d.where_left, share_left(d),
        fmt::format("Where over time, after: what is left, {} of the squared gap before", percent(share_left(d))));
  return html + phase_table(d) + maps(d, overlays);
}

}  // namespace kenaf::gap
