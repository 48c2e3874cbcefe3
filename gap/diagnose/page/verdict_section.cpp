// The headline: what was found, what that means, what to do with it, and how far the gap shrinks.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "gap/diagnose/page/figures.hpp"
#include "gap/diagnose/page/sections.hpp"
#include "gap/diagnose/page/words.hpp"
#include "gap/diagnose/report.hpp"
#include "gap/plot/row_chart.hpp"

namespace kenaf::gap {
namespace {

using plot::Ink;
using plot::Shape;

// "drive_lag and one of com_forward or ground_slope".
std::string explanation(const Diagnosis& d) {
  std::vector<std::string> parts;
  for (const std::vector<std::size_t>& rivals : d.decision.rivals) {
    const std::vector<std::string> names = curve_names(d, rivals);
    parts.push_back(names.size() > 1 ? "one of " + enumeration(names, "or") : enumeration(names));
  }
  return enumeration(parts);
}

std::string headline(const Diagnosis& d) {
  if (!d.interrupted.empty()) return fmt::format("Unfinished: interrupted while {}", d.interrupted);
  switch (d.decision.verdict) {
    case Verdict::none:
      return "No gap: robot and simulation differ no more than noise and repeats do";
    case Verdict::named:
      return fmt::format("The gap is explained by {}", explanation(d));
    case Verdict::ambiguous:
      return fmt::format("The gap is explained by {}, which these runs cannot tell apart", explanation(d));
    case Verdict::unknown:
      return "A gap that the effects of the catalogue do not explain, alone or together";
  }
  return {};
}

std::string p_text(double p) {
  const std::string text = probability(p);
  return text.starts_with('<') ? "p " + text : "p = " + text;
}

std::string meaning(const Diagnosis& d) {
  if (!d.interrupted.empty())
    return "The diagnosis was stopped before its end. What follows is what was known by then; there is no verdict, and "
           "nothing that is missing counts as not found.";
  const std::string by_chance =
      fmt::format("A difference this large comes by chance alone with {}.", p_text(d.decision.p_gap));
  switch (d.decision.verdict) {
    case Verdict::none:
      return by_chance +
             " That is said of these manoeuvres, these channels and this noise; what they do not show can "
             "still be there.";
    case Verdict::named:
      return fmt::format(
          "{} With the effect switched on and fitted, what is left could be chance ({}), and no other effect of the "
          "catalogue fits these runs as well.",
          by_chance, p_text(d.decision.p_left));
    case Verdict::ambiguous:
      return by_chance +
             " It is explained, but several effects fit these runs about as well, so none of them is named. "
             "The values below are those of the best fit among them.";
    case Verdict::unknown:
      return fmt::format(
          "{} No effect is named: {}. Values below say what part the best fit takes away; they are not a cause.",
          by_chance, fmt::join(doubts_in_words(d.decision), "; "));
  }
  return {};
}

std::string advice(const Diagnosis& d) {
  if (!d.interrupted.empty()) return "Run the diagnosis again and let it end.";
  const std::string drive =
      d.next.empty() ? "a manoeuvre in which they would differ" : fmt::format("\"{}\"", d.next.front().manoeuvre);
  switch (d.decision.verdict) {
    case Verdict::none:
      return "Use the simulator as it is for motions like these. To look for smaller gaps, add repeats or manoeuvres; "
             "the "
             "section on confusability lists what these runs cannot show.";
    case Verdict::named:
      return "Use robot.toml, which is beside this page and has the effect switched on, in place of the description. "
             "Then "
             "drive something new, and diagnose that with robot.toml: it should find no gap.";
    case Verdict::ambiguous:
      return fmt::format(
          "Drive {}, add its runs to the dataset and diagnose again. Until then robot.toml, which is beside this page, "
          "reproduces these runs, but may be wrong in other motions.",
          drive);
    case Verdict::unknown:
      return "Look at where the gap begins, below: the first channel, on the way from command to sensor, that shows "
             "it. "
             "Check there the robot's description, the world's dimensions, the units of the log, and its time stamps. "
             "No "
             "robot.toml was written.";
  }
  return {};
}

std::string effect_words(const Diagnosis& d, const EffectEvidence& evidence) {
  const EffectCurve& curve = d.curves.curves[evidence.curve];
  const std::string_view unit = curve.parameter->unit;
  std::string html = fmt::format(
      "<p><b>{}</b> (stage: {}): {}. {} = {} with 95 % interval; without the effect it is {}{}.</p>\n",
      plot::escaped(name_of(curve)), physics::stage_name(curve.effect->stage), plot::escaped(curve.effect->summary),
      curve.parameter->name, interval_text(evidence.value, unit), figure(present_value(curve)), unit_suffix(unit));
  if (evidence.at_bound)
    html += fmt::format(
        "<p class=\"warning\">The fit of {} ended at the end of its range ({} to {}{}): the true value may lie beyond, "
        "or "
        "another effect is the cause.</p>\n",
        plot::escaped(parameter_name(curve)), figure(curve.parameter->min), figure(curve.parameter->max),
        unit_suffix(unit));
  return html;
}

std::string value_figure(const Diagnosis& d, const EffectEvidence& evidence) {
  const EffectCurve& curve = d.curves.curves[evidence.curve];
  plot::RowChart chart;
  chart.title = fmt::format("Fitted {} with its 95 % interval", parameter_name(curve));
  chart.x_label =
      fmt::format("{} ({})", curve.parameter->name, curve.parameter->unit == "1" ? "ratio" : curve.parameter->unit);
  chart.rows = {{"nominal", {{present_value(curve), Shape::ring, Ink::sim}}, figure(present_value(curve))},
                {"fitted",
                 {{evidence.value.value, Shape::disc, Ink::third, plot::Range{evidence.value.from, evidence.value.to}}},
                 fmt::format("{:.4g}", evidence.value.value)}};
  chart.label_px = 80;
  chart.note_px = 75;
  chart.width_px = kHalf_px;
  return to_svg(chart);
}

std::string gap_figure(const Diagnosis& d) {
  plot::RowChart chart;
  chart.title = fmt::format("The gap on {}, in noise units", measured_on(d));
  chart.x_label = "rms over all channels (noise units)";
  const auto row = [](std::string_view label, double value, Ink ink) {
    return plot::Row{std::string(label), {{value, Shape::bar, ink}}, fmt::format("{:.2f}", value)};
  };
  chart.rows = {row(d.best.empty() ? "nominal" : "before", d.gap.before, Ink::sim)};
  if (!d.best.empty()) chart.rows.push_back(row("after", d.gap.after, Ink::third));
  chart.guides = {{d.gap.floor, fmt::format("floor {:.2f}", d.gap.floor)}};
  chart.label_px = 80;
  chart.note_px = 75;
  chart.width_px = kHalf_px;
  return to_svg(chart);
}

std::string shrink_figure(const Diagnosis& d) {
  plot::RowChart chart;
  chart.title = "Shrink of the gap beyond the floor, with 95 % interval";
  chart.x_label = "shrink (%)";
  const auto add = [&](std::string_view label, const Interval& shrink) {
    const double value = shrink.value * 100;
    chart.rows.push_back({std::string(label),
                          {{value, Shape::disc, Ink::third, plot::Range{shrink.from * 100, shrink.to * 100}}},
                          fmt::format("{:.0f} %", value)});
  };
  add(d.observations.runs.size() > 1 ? "repeats held out" : "the run fitted to", d.gap.shrink);
  if (folds_by_manoeuvre(d.observations).size() > 1) add("manoeuvres held out", d.gap.shrink_by_manoeuvre);
  const Interval &repeats = d.gap.shrink, &manoeuvres = d.gap.shrink_by_manoeuvre;
  chart.view = plot::Range{std::clamp(std::min(repeats.from, manoeuvres.from) * 100, -50.0, 0.0),
                           std::clamp(std::max(repeats.to, manoeuvres.to) * 100 + 3, 105.0, 150.0)};
  chart.guides = {{100, "all"}};
  chart.label_px = 160;
  chart.note_px = 60;
  chart.width_px = kHalf_px;
  return to_svg(chart);
}

}  // namespace

std::string verdict_section(const Diagnosis& d) {
  std::string html =
      fmt::format("<section class=\"verdict\">\n<p class=\"word\">{}</p>\n<h1>{}</h1>\n",
                  d.interrupted.empty() ? verdict_name(d.decision.verdict) : "unfinished", plot::escaped(headline(d)));
  html += "<p><b>What it means.</b> " + plot::escaped(meaning(d)) + "</p>\n<p><b>What to do next.</b> " +
          plot::escaped(advice(d)) + "</p>\n";
  for (const EffectEvidence& evidence : d.best) html += effect_words(d, evidence);
  html += "</section>\n";
  if (!d.interrupted.empty() && std::isnan(d.gap.before)) return html;
  html += "<div class=\"figures\">\n" + gap_figure(d);
  if (!d.best.empty()) html += shrink_figure(d);
  for (const EffectEvidence& evidence : d.best) html += value_figure(d, evidence);
  return html + "</div>\n";
}

}  // namespace kenaf::gap
