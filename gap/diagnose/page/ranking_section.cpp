#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gap/diagnose/page/figures.hpp"
#include "gap/diagnose/page/sections.hpp"
#include "gap/diagnose/page/words.hpp"
#include "gap/plot/row_chart.hpp"

namespace kenaf::gap::diagnose {
namespace {

constexpr std::size_t kMostRows = 12, kMostTableRows = 100;

std::string ranking_figure(const Diagnosis& d, const StageDiagnosis& stage) {
  plot::RowChart chart;
  chart.title = "Share of the gap that each candidate explains alone";
  chart.x_label = "share of the squared gap, on the runs it was fitted to (%)";
  const std::vector<SingleEvidence> ranking = ranked_by_share(stage);
  for (std::size_t i = 0; i < std::min(kMostRows, ranking.size()); ++i) {
    const SingleEvidence& single = ranking[i];
    const bool in_best = std::ranges::any_of(
        stage.decision.effects, [&](const ModelEffect& effect) { return effect.candidate == single.candidate; });
    chart.rows.push_back(
        {d.candidates[single.candidate].name,
         {{std::max(0.0, single.explains) * 100, plot::Shape::bar, in_best ? plot::Ink::third : plot::Ink::real, {}}},
         percent(single.explains)});
  }
  if (!stage.decision.effects.empty())
    chart.legend = {{plot::Shape::bar, plot::Ink::third, "in the best model"},
                    {plot::Shape::bar, plot::Ink::real, "not in it"}};
  chart.view = plot::Range{0, 100};
  chart.label_px = 260;
  chart.note_px = 70;
  chart.width_px = kWide_px;
  return to_svg(chart);
}

std::string ranking_table(const Diagnosis& d, const StageDiagnosis& stage) {
  Table table{{"candidate", "value", "nominal", "explains", "evidence", "what it is"}, {}, {0, 5}};
  for (std::size_t i = 0; i < std::min(kMostTableRows, stage.ranking.size()); ++i) {
    const SingleEvidence& single = stage.ranking[i];
    const candidates::Candidate& candidate = d.candidates[single.candidate];
    table.rows.push_back({value_name(candidate), figure(single.value) + unit_suffix(candidate.unit),
                          figure(candidate.present) + unit_suffix(candidate.unit), percent(single.explains),
                          figure(single.evidence), candidate.summary});
  }
  return to_html(table);
}

}  // namespace

std::string ranking_part(const Diagnosis& d, const StageDiagnosis& stage) {
  if (stage.ranking.empty()) return {};
  std::string html = "<h3>Each candidate alone</h3>\n";
  html += paragraph(
      "Each candidate is fitted alone. Where several act together, one alone explains less than its part, or part of "
      "what the others cause. The table is sorted by evidence, which weights each channel by its noise and by the part "
      "that no candidate explains.",
      "soft");
  html += ranking_figure(d, stage);
  return html +
         fmt::format("<details><summary>All {} with their values, by evidence</summary>\n", stage.ranking.size()) +
         ranking_table(d, stage) + "</details>\n";
}

}  // namespace kenaf::gap::diagnose
