// One stage: its decision, values, and their performance on held-out runs.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/page/figures.hpp"
#include "gap/diagnose/page/left_over_section.hpp"
#include "gap/diagnose/page/sections.hpp"
#include "gap/diagnose/page/words.hpp"
#include "gap/plot/row_chart.hpp"

namespace kenaf::gap::diagnose {
namespace {

using plot::Ink;
using plot::Shape;

bool has_model(const StageDiagnosis& stage) {
  return !stage.decision.best.model.places.empty();
}

std::string verdict_words(const Diagnosis& d, const StageDiagnosis& stage) {
  const StageDecision& decision = stage.decision;
  const auto chance = [](double p) {
    const std::string text = probability(p);
    return text.starts_with('<') ? "p " + text : "p = " + text;
  };
  if (decision.verdict == Verdict::none)
    return fmt::format("No gap: a difference this large occurs by chance with {}, or is negligible.",
                       chance(decision.p_gap));
  const NamesFound names = names_found(stage);
  std::string words = names.empty() ? "There is a gap, and no effect is named." : names_in_words(d, names) + ".";
  if (!names.ambiguous_sets.empty()) words += " These runs cannot distinguish the members of a set.";
  words += fmt::format(" A difference this large occurs by chance with {}.", chance(decision.p_gap));
  if (!has_model(stage)) return words + " No candidate alone gains enough evidence to be fitted.";
  words +=
      decision.complete
          ? fmt::format(" The residual of the best model is within chance ({}).", chance(decision.p_left))
          : fmt::format(" The residual of the best model is beyond chance ({}); intervals and evidence allow for it.",
                        chance(decision.p_left));
  return words;
}

std::string gap_figure(const Diagnosis& d, const StageDiagnosis& stage) {
  plot::RowChart chart;
  chart.title = fmt::format("The gap on {}, in times the noise", measured_on(d));
  chart.x_label = "rms over all channels (\u00d7 noise)";
  const auto row = [](std::string_view label, double value, Ink ink) {
    return plot::Row{std::string(label), {{value, Shape::bar, ink}}, figure(value)};
  };
  chart.rows = {row(has_model(stage) ? "before" : "nominal", stage.gap.before, Ink::sim)};
  if (has_model(stage)) chart.rows.push_back(row("after", stage.gap.after, Ink::third));
  if (std::isfinite(stage.gap.floor)) chart.guides = {{stage.gap.floor, fmt::format("noise {:.2f}", stage.gap.floor)}};
  chart.label_px = 80;
  chart.note_px = 75;
  chart.width_px = kHalf_px;
  return to_svg(chart);
}

std::string shrink_figure(const Diagnosis& d, const StageDiagnosis& stage) {
  plot::RowChart chart;
  chart.title = "Shrink of the gap beyond noise, with 95 % interval";
  chart.x_label = "shrink (%)";
  double low = 0, high = 100;
  const auto add = [&](std::string_view label, const Interval& shrink) {
    if (!std::isfinite(shrink.value)) return;
    plot::RowMark mark{shrink.value * 100, Shape::disc, Ink::third, {}};
    if (std::isfinite(shrink.from) && std::isfinite(shrink.to)) {
      mark.interval = plot::Range{shrink.from * 100, shrink.to * 100};
      low = std::min(low, mark.interval->low), high = std::max(high, mark.interval->high);
    }
    chart.rows.push_back({std::string(label), {mark}, percent(shrink.value)});
  };
  add(d.observations.runs.size() > 1 ? "repeats held out" : "the run fitted to", stage.gap.shrink);
  if (folds_by_manoeuvre(d.observations, d.repeats).size() > 1)
    add("manoeuvres held out", stage.gap_by_manoeuvre.shrink);
  chart.view = plot::Range{std::max(low, -50.0), std::clamp(high + 3, 105.0, 150.0)};
  chart.guides = {{100, "all"}};
  chart.label_px = 160;
  chart.note_px = 60;
  chart.width_px = kHalf_px;
  return to_svg(chart);
}

std::string value_figure(const Diagnosis& d, const ModelEffect& effect) {
  const candidates::Candidate& candidate = d.candidates[effect.candidate];
  const Interval& value = effect.value.value;
  plot::RowChart chart;
  chart.title = fmt::format("{} with its 95 % interval", value_name(candidate));
  chart.x_label = fmt::format("{} ({})", candidate.parameter, candidate.unit == "1" ? "ratio" : candidate.unit);
  plot::RowMark fitted{value.value, Shape::disc, Ink::third, {}};
  if (std::isfinite(value.from) && std::isfinite(value.to)) fitted.interval = plot::Range{value.from, value.to};
  chart.rows = {{"nominal", {{candidate.present, Shape::ring, Ink::sim, {}}}, figure(candidate.present)},
                {"fitted", {fitted}, figure(value.value)}};
  chart.label_px = 80;
  chart.note_px = 75;
  chart.width_px = kHalf_px;
  return to_svg(chart);
}

std::string effects_table(const Diagnosis& d, const StageDiagnosis& stage) {
  Table table{{"effect", "name", "value (95 % interval)", "nominal", "spread (sd)", "explains", "most in", "evidence"},
              {},
              {0, 1}};
  // one row per effect: whether it has a name, its value, and its share of the gap
  for (const ModelEffect& effect : stage.decision.effects) {
    const candidates::Candidate& candidate = d.candidates[effect.candidate];
    std::string name = "yes";
    if (!effect.doubts.empty())
      name = fmt::format("no: {}", fmt::join(doubts_in_words(d, effect), "; "));
    else if (effect.rivals.size() > 1)
      name = fmt::format("one of {}", enumeration(candidate_names(d, effect.rivals), "or"));
    table.rows.push_back(
        {value_name(candidate), std::move(name), interval_text(effect.value.value, candidate.unit),
         figure(candidate.present), figure(effect.value.spread),
         fmt::format("{} ({})", percent(explained_by(stage, effect)), percent(effect.share_by_manoeuvre.of_stage)),
         fmt::format("{} of {}", percent(effect.share.of_kind), kind_name(effect.share.kind)),
         figure(effect.evidence)});
  }

  // a key to the columns
  return to_html(table) +
         paragraph(
             "Spread: standard deviation of the fitted value between manoeuvres. Explains: share of the squared gap "
             "that the model with the effect explains beyond the model without it, on held-out runs and, in brackets, "
             "on held-out manoeuvres. Most in: the same for the kind of channels in which the effect explains most. "
             "Evidence: decrease of the deviance (-2 log likelihood) by the effect.",
             "soft");
}

}  // namespace

std::string stage_id(Passage passage) {
  std::string id = fmt::format("stage-{}", passage_name(passage));
  std::ranges::replace(id, ' ', '-');
  return id;
}

std::string stage_section(const Diagnosis& d, std::size_t s) {
  const StageDiagnosis& stage = d.stages[s];
  const bool has_gap = stage.decision.verdict != Verdict::none;
  std::string html = section_head(stage_id(stage.passage), with_capital(from_to(stage.passage)));
  html +=
      fmt::format("<p><span class=\"word\">{}</span> {}</p>\n",
                  has_gap ? verdict_name(stage.decision.verdict) : "no gap", plot::escaped(verdict_words(d, stage)));
  if (has_gap || has_model(stage)) {
    html += "<div class=\"figures\">\n" + gap_figure(d, stage);
    if (has_model(stage)) html += shrink_figure(d, stage);
    for (const ModelEffect& effect : stage.decision.effects) html += value_figure(d, effect);
    html += "</div>\n";
  }
  if (!stage.decision.effects.empty()) html += effects_table(d, stage);
  if (has_gap) html += left_over_section(stage.left_over, left_in_words(stage));
  return html + residual_part(d, stage) + ranking_part(d, stage) + confusability_part(d, stage);
}

}  // namespace kenaf::gap::diagnose
