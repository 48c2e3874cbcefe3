// The page of a diagnosis: one self-contained file.
#include <fmt/format.h>

#include "gap/diagnose/page/moment_view.hpp"
#include "gap/diagnose/page/scripts.hpp"
#include "gap/diagnose/page/sections.hpp"
#include "gap/diagnose/page/words.hpp"
#include "gap/diagnose/report.hpp"
#include "gap/plot/chart.hpp"

namespace kenaf::gap::diagnose {
namespace {

constexpr std::string_view kPageStyle = R"(body { background: var(--paper); color: var(--ink); max-width: 1060px;
  margin: 24px auto; padding: 0 16px; font: 15px/1.45 system-ui, "DejaVu Sans", "Liberation Sans", Arial, sans-serif; }
h1 { font-size: 25px; line-height: 1.25; margin: 2px 0 10px; } h2 { font-size: 19px; margin: 44px 0 4px; }
h3 { font-size: 15px; margin: 22px 0 2px; } h3 .soft { font-weight: 400; }
p { margin: 6px 0; max-width: 88ch; } ul { margin: 6px 0; padding-left: 22px; max-width: 88ch; }
.soft { color: var(--soft); } a { color: var(--real); }
nav { margin: 14px 0; font-size: 13px; display: flex; flex-wrap: wrap; gap: 2px 14px; } nav a { white-space: nowrap; line-height: 24px; }
.verdict { border-left: 5px solid var(--real); padding: 4px 0 4px 18px; margin: 16px 0; }
.word { text-transform: uppercase; letter-spacing: 0.08em; font-size: 13px; font-weight: 600; color: var(--real); }
.warning { border-left: 5px solid var(--sim); padding-left: 12px; } ul.warning { padding-left: 28px; }
.tables { overflow-x: auto; } .tables svg.chart { max-width: none; }
table { border-collapse: collapse; font-size: 13px; margin: 12px 0; font-variant-numeric: tabular-nums; }
th, td { padding: 3px 9px; text-align: right; border-bottom: 1px solid var(--grid); white-space: nowrap; }
th { font-weight: 600; color: var(--soft); white-space: normal; vertical-align: bottom; }
td.text { white-space: normal; max-width: 46ch; }
th.text, td.text { text-align: left; } th:first-child, td:first-child { padding-left: 0; }
.glance { font-size: 14px; } .glance td, .glance th { padding: 4px 14px 4px 0; }
td.wrap { white-space: normal; max-width: 34ch; }
.share { display: inline-block; width: 260px; height: 14px; background: var(--grid); vertical-align: -2px; overflow: hidden;
  white-space: nowrap; font-size: 0; margin-right: 6px; }
.share span { display: inline-block; height: 100%; } .gone { background: var(--third); } .left { background: var(--sim); }
.key { font-size: 13px; } .key span { display: inline-block; width: 11px; height: 11px; margin: 0 3px 0 10px; }
.key span:first-child { margin-left: 0; }
dl { display: grid; grid-template-columns: 10em 1fr; gap: 10px 14px; margin: 16px 0 4px; } dt { font-weight: 600; }
dd { margin: 0; } dd p, dd ul { margin: 0; } dd ul { padding-left: 18px; } dd li { margin: 0 0 3px; }
details { margin: 16px 0; } summary { cursor: pointer; font-weight: 600; }
.figures { display: flex; flex-wrap: wrap; gap: 12px 12px; margin: 8px 0; }
.moment { width: 524px; max-width: 100%; margin: 0; scroll-margin-top: 12px; } .moment p { margin: 2px 0; font-size: 13px; }
.moment:target figcaption, h3:target { outline: 2px solid var(--real); outline-offset: 3px; }
.moment ul { font-size: 13px; padding-left: 18px; margin: 2px 0; } .moment code { font-size: 12px; overflow-wrap: anywhere; }
.scene { border: 1px solid var(--frame); margin: 4px 0; touch-action: pan-y; cursor: grab; overflow: hidden; }
.scene svg, .scene canvas { display: block; width: 100%; height: auto; aspect-ratio: 524 / 300; }
.still.replaced, .scene canvas[hidden] { display: none; }
:root { --belt: #55595b; --arm: #d9a94a; --eye: #eef2ee; }
.still path { fill: var(--m); stroke: none; } .still .floor { fill: none; stroke: var(--grid); }
.still .solid { --m: var(--ground); stroke: var(--ground-edge); stroke-width: 0.4; }
.still .real .hull { --m: var(--real); } .still .real .belt { --m: var(--belt); } .still .real .flipper { --m: var(--arm); }
.still .real .eye { --m: var(--eye); } .still .nominal { --m: var(--sim); opacity: 0.5; } .still .corrected { --m: var(--third); opacity: 0.5; }
.still .s0 { fill: color-mix(in srgb, var(--m) 55%, #000); } .still .s1 { fill: color-mix(in srgb, var(--m) 66%, #000); }
.still .s2 { fill: color-mix(in srgb, var(--m) 78%, #000); } .still .s3 { fill: color-mix(in srgb, var(--m) 90%, #000); }
.controls { display: flex; flex-wrap: wrap; gap: 4px 10px; align-items: center; font-size: 13px; min-height: 30px; }
.controls button { font: inherit; min-width: 62px; min-height: 26px; } .controls input[type=range] { flex: 1; min-width: 90px; }
.controls output { font-variant-numeric: tabular-nums; min-width: 4em; } .controls label { white-space: nowrap; }
.angles caption { text-align: left; color: var(--soft); padding-bottom: 4px; } .angles > label, .angles .readout { font-size: 13px; }
.angles .readout { min-height: 1.5em; } .angles table { margin-top: 4px; }
.angles th, .angles td { border: 1px solid var(--grid); text-align: center; padding: 2px 3px; min-width: 27px; }
.angles th[scope=row] { text-align: right; white-space: nowrap; padding-left: 0; position: sticky; left: 0; background: var(--paper); color: var(--ink); }
.angles th[scope=col] { vertical-align: bottom; color: var(--ink); font-weight: 400; }
.angles th span { writing-mode: vertical-rl; transform: rotate(180deg); white-space: nowrap; }
.angles td[style] { background: color-mix(in srgb, var(--shade) calc(62% * var(--s)), var(--paper)); print-color-adjust: exact; -webkit-print-color-adjust: exact; }
.angles thead td { border: 0; } .angles .same { background: var(--grid); } .angles .at, .angles .at span { text-decoration: underline; font-weight: 600; }
.angles td:focus-visible { outline: 3px solid var(--ink); outline-offset: -2px; }
.angles > input:not(:checked) ~ * .rest, .angles.whole > input:not(:checked) ~ * { display: none; }
.angles.whole > label { display: inline !important; }
@media (max-width: 40em) { dl { grid-template-columns: 1fr; gap: 4px; } dd { margin: 0 0 8px; } .share { width: 60px; } }
@media print { body { max-width: none; } nav { display: none; } svg.chart, tr, .verdict { break-inside: avoid; }
  h2, h3 { break-after: avoid; } .tables { overflow: visible; } .tables svg.chart { max-width: 100%; }
  table { font-size: 10px; } th, td, td.text { padding: 2px 4px; white-space: normal; max-width: none; overflow-wrap: break-word; }
  .glance { font-size: 11px; } .share { width: 110px; }
  .moment { break-inside: avoid; width: 48%; } .still.replaced { display: block; } .scene canvas, .controls { display: none; }
  .angles > input, .angles.whole > label, .angles > label, .angles .readout { display: none !important; }
  .angles > input:not(:checked) ~ .tables .rest { display: table-row-group; } .angles > input:not(:checked) ~ ul .rest { display: list-item; }
  .angles.whole > input:not(:checked) ~ :not(label, .readout) { display: block; }
  .angles table { font-size: 8px; } .angles th, .angles td { padding: 1px; min-width: 0; } }
)";

std::string contents(const Diagnosis& d, bool has_moments) {
  std::string html = "<nav>";
  for (const StageDiagnosis& stage : d.stages)
    html += fmt::format("<a href=\"#{}\">{}</a>", stage_id(stage.passage), with_capital(from_to(stage.passage)));
  return html + "<a href=\"#where\">Where</a>" + (has_moments ? "<a href=\"#moments\">Moments</a>" : "") +
         "<a href=\"#overlay\">Runs</a><a href=\"#next\">Next</a>"
         "<a href=\"#used\">Used</a><a href=\"#method\">Method</a></nav>\n";
}

}  // namespace

std::string diagnosis_page(const Diagnosis& d, std::span<const Overlay> overlays, std::string_view report_folder) {
  return diagnosis_page(d, overlays, report_folder, drawn_runs(d, overlays));
}

std::string diagnosis_page(const Diagnosis& d, std::span<const Overlay> overlays, std::string_view report_folder,
                           std::span<const ComparedRun> runs) {
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n<title>Gap diagnosis: {}</title>\n"
      "<style>\n{}{}</style>\n</head>\n<body>\n<main>\n<p class=\"soft\">Diagnosis of the gap between a robot and its "
      "simulation. {}</p>\n",
      d.interrupted.empty() ? verdict_name(d.verdict) : "unfinished", plot::style_sheet(), kPageStyle,
      plot::escaped(d.observations.dataset.description));
  const std::vector<Moment> moments = moments_of(d, overlays);
  const std::string worst = moments_section(d, overlays, moments, report_folder);
  html += answer_section(d, runs, moments, overlays) + contents(d, !worst.empty());
  for (std::size_t s = 0; s < d.stages.size(); ++s) html += stage_section(d, s);
  html += where_section(d, overlays, moments) + worst + overlay_section(d, overlays) + next_section(d);
  html += used_section(d, overlays, runs) + method_section(d) + "</main>\n";
  // scripts last: the page is whole without them
  for (const std::string_view script : {moment_player_script(), confusability_script()})
    html += fmt::format("<script>//<![CDATA[\n{}//]]></script>\n", script);
  return html + "</body>\n</html>\n";
}

}  // namespace kenaf::gap::diagnose
