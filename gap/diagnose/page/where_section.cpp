#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gap/diagnose/page/figures.hpp"
#include "gap/diagnose/page/sections.hpp"
#include "gap/diagnose/page/words.hpp"
#include "gap/plot/strip_chart.hpp"

namespace kenaf::gap::diagnose {
namespace {

constexpr std::size_t kMostPhases = 12;  // in the table
constexpr double kStays_m = 0.1;         // less motion is not mapped

double share_left(const StageDiagnosis& stage) {
  return stage.where.beyond_chance > 0 ? stage.where_left.beyond_chance / stage.where.beyond_chance : 0;
}

bool shows_after(const StageDiagnosis& stage) {
  return !stage.decision.best.model.places.empty();
}

// `scale`: from shares to shares of the gap before.
std::string time_map(const Diagnosis& d, std::span<const Overlay> overlays, std::span<const Moment> moments,
                     std::size_t s, const GapPlaces& where, double scale, std::string_view title) {
  const StageDiagnosis& stage = d.stages[s];
  double most = 0;
  for (const PhaseGap& phase : stage.where.phases) most = std::max(most, phase.share);
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
      strip.spans.push_back({phase.from_s, phase.to_s, most > 0 ? share / most : 0, std::string(phase.phase),
                             percent(share), link_to_phase(d, moments, s, phase)});
    }
    std::ranges::sort(strip.spans, {}, &plot::StripSpan::from);
    chart.strips.push_back(std::move(strip));
  }
  return to_svg(chart);
}

std::string phase_table(const Diagnosis& d, std::size_t s, std::span<const Moment> moments) {
  Table table{
      {"manoeuvre", "phase", "from (s)", "to (s)", "x (m)", "y (m)", "share of the gap", "left after"}, {}, {0, 1}};
  const StageDiagnosis& stage = d.stages[s];
  for (std::size_t p = 0; p < stage.where.phases.size(); ++p) {
    const PhaseGap& phase = stage.where.phases[p];
    if (table.rows.size() == kMostPhases || phase.share < 0.005) break;
    table.row_links.push_back(link_to_phase(d, moments, s, phase));
    const auto left = std::ranges::find_if(stage.where_left.phases, [&](const PhaseGap& other) {
      return other.group == phase.group && other.from_s == phase.from_s;
    });
    const bool known = shows_after(stage) && left != stage.where_left.phases.end();
    table.rows.push_back({group_title(d, phase.group), std::string(phase.phase), fmt::format("{:.1f}", phase.from_s),
                          fmt::format("{:.1f}", phase.to_s), figure(phase.x_m), figure(phase.y_m), percent(phase.share),
                          known ? percent(left->share * share_left(stage)) : "-"});
  }
  return to_html(table);
}

bool moves(const plot::Chart& chart) {
  plot::Point low(1e9, 1e9), high = -low;
  for (const plot::Line& line : chart.lines)
    for (const plot::Point& p : line.points)
      if (p.allFinite()) low = low.cwiseMin(p), high = high.cwiseMax(p);
  return (high - low).maxCoeff() > kStays_m;
}

std::string maps(const Diagnosis& d, std::span<const Overlay> overlays, std::span<const Moment> moments,
                 std::size_t s) {
  const StageDiagnosis& stage = d.stages[s];
  std::string figures;
  std::vector<std::string> staying;
  for (const Overlay& overlay : overlays) {
    const plot::Chart chart = places_figure(d, overlay, moments, s);
    if (moves(chart))
      figures += to_svg(chart);
    else
      staying.push_back(group_title(d, overlay.group));
  }
  std::string html;
  if (!figures.empty())
    html += paragraph(fmt::format("In the world: the area of a circle is the share of the gap in a phase, drawn at the "
                                  "position in the middle of the phase. Rings: before{}.",
                                  shows_after(stage) ? "; discs: after, to the same scale" : ""),
                      "soft") +
            "<div class=\"figures\">\n" + figures + "</div>\n";
  if (!staying.empty())
    html += paragraph(
        fmt::format("Not mapped, because the robot stays within {} m: {}.", kStays_m, enumeration(staying)), "soft");
  return html;
}

}  // namespace

std::string where_section(const Diagnosis& d, std::span<const Overlay> overlays, std::span<const Moment> moments) {
  // nothing was located, or there is nothing to locate
  std::string html = section_head("where", "Where the gap is, in time and place");
  const std::optional<std::size_t> main = main_stage(d);
  if (!main || overlays.empty()) return html + paragraph("The diagnosis ended before the gap was located.");
  const std::vector<std::size_t> stages = stages_with_gap(d);
  if (stages.empty()) return html + paragraph("Nowhere: no stage has a gap.");

  // phases and how the gap is counted in them
  html += paragraph(fmt::format("Phases are detected in the data. The gap is measured in intervals of {} s of each "
                                "channel; an interval across several phases is divided between them by the residuals "
                                "in its spans of {} s. A phase links to its worst moment, or else to its run.",
                                d.options.stretch_s, d.options.span_s),
                    "soft");

  // per stage: time before and after, the table of phases, and maps for the stage with most of the gap
  for (const std::size_t s : stages) {
    const StageDiagnosis& stage = d.stages[s];
    html += fmt::format("<h3>{}</h3>\n", with_capital(from_to(stage.passage)));
    if (stage.where.beyond_chance <= 0) {
      html += paragraph("No interval of any channel is beyond chance by itself.");
      continue;
    }
    html += time_map(d, overlays, moments, s, stage.where, 1,
                     "Before: the phases of each manoeuvre by their share of the gap");
    if (shows_after(stage))
      html += time_map(d, overlays, moments, s, stage.where_left, share_left(stage),
                       fmt::format("After: what is left, {} of the squared gap before", percent(share_left(stage))));
    html += phase_table(d, s, moments);
    if (s == *main) html += maps(d, overlays, moments, s);
  }
  return html;
}

}  // namespace kenaf::gap::diagnose
