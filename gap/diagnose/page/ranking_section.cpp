#include <fmt/format.h>

#include <algorithm>

#include "gap/diagnose/page/figures.hpp"
#include "gap/diagnose/page/sections.hpp"
#include "gap/diagnose/page/words.hpp"
#include "gap/diagnose/report.hpp"
#include "gap/plot/row_chart.hpp"

namespace kenaf::gap {
namespace {

constexpr std::size_t kMostRows = 24;  // of the figure; the table has all

std::string ranking_figure(const Diagnosis& d) {
  plot::RowChart chart;
  chart.title = fmt::format("What each effect alone takes off the gap on {}, with 95 % interval", measured_on(d));
  chart.x_label = "shrink of what is beyond the floor (%)";
  double lowest = 0, highest = 0;
  for (std::size_t i = 0; i < std::min(kMostRows, d.ranking.size()); ++i) {
    const EffectEvidence& e = d.ranking[i];
    const bool in_best = std::ranges::any_of(d.best, [&](const EffectEvidence& b) { return b.curve == e.curve; });
    const Interval& shrink = e.heldout_shrink;
    chart.rows.push_back(
        {name_of(d.curves.curves[e.curve]),
         {{shrink.value * 100, in_best ? plot::Shape::disc : plot::Shape::ring,
           in_best ? plot::Ink::third : plot::Ink::real, plot::Range{shrink.from * 100, shrink.to * 100}}},
         percent_interval(shrink)});
    lowest = std::min(lowest, shrink.from * 100);
    highest = std::max(highest, shrink.to * 100);
  }
  if (!d.best.empty())
    chart.legend = {{plot::Shape::disc, plot::Ink::third, "in the best model"},
                    {plot::Shape::ring, plot::Ink::real, "not in it"}};
  chart.view = plot::Range{std::max(lowest, -50.0) - 3, std::clamp(highest + 3, 105.0, 150.0)};
  chart.guides = {{0, "nothing"}, {100, "all"}};
  chart.label_px = 230;
  chart.note_px = 140;
  chart.width_px = kWide_px;
  return to_svg(chart);
}

std::string ranking_table(const Diagnosis& d) {
  Table table{{"effect", "stage", "parameter", "fitted value (95 %)", "shrink (95 %)", "explains", "p", "note"},
              {},
              {0, 1, 2, 7}};
  for (const EffectEvidence& e : d.ranking) {
    const EffectCurve& curve = d.curves.curves[e.curve];
    table.rows.push_back({std::string(curve.effect->name), std::string(physics::stage_name(curve.effect->stage)),
                          std::string(curve.parameter->name), interval_text(e.value, curve.parameter->unit),
                          percent_interval(e.heldout_shrink), percent(e.explains), probability(e.p_value),
                          e.at_bound ? "end of range" : ""});
  }
  return to_html(table);
}

std::string together(const Diagnosis& d) {
  Table table{
      {"effect", "parameter", "fitted value (95 %)", "explains, beyond the others", "p", "note"}, {}, {0, 1, 5}};
  for (const EffectEvidence& e : d.best) {
    const EffectCurve& curve = d.curves.curves[e.curve];
    table.rows.push_back({std::string(curve.effect->name), std::string(curve.parameter->name),
                          interval_text(e.value, curve.parameter->unit), percent(e.explains), probability(e.p_value),
                          e.at_bound ? "end of range" : ""});
  }
  return paragraph(fmt::format("The best model has {} effects. Together they take {} off {}.", d.best.size(),
                               percent_interval(d.gap.shrink), measured_on(d))) +
         to_html(table);
}

}  // namespace

std::string ranking_section(const Diagnosis& d) {
  std::string html = section_head("ranking", "Which effects explain it");
  if (d.ranking.empty())
    return html + paragraph(d.interrupted.empty() ? "These runs show no effect of the catalogue at any size."
                                                  : "Effects were not compared before the diagnosis ended.");
  html += paragraph(
      "Each effect is fitted alone to part of the runs and tried on the rest. Explains: the share of the squared gap "
      "that it "
      "takes off the runs it was fitted to. p: the chance of as much where there is no gap, for the number of "
      "effects that were tried.",
      "soft");
  html += ranking_figure(d);
  if (d.ranking.size() > kMostRows)
    html += paragraph(fmt::format("The best {} of {}; the table has all.", kMostRows, d.ranking.size()), "soft");
  html += ranking_table(d);
  return d.best.size() > 1 ? html + together(d) : html;
}

}  // namespace kenaf::gap
