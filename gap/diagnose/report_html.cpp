// The page of a diagnosis: one self-contained file.
#include <fmt/format.h>

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
nav { margin: 14px 0; font-size: 13px; } nav a { margin-right: 14px; white-space: nowrap; }
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
@media print { body { max-width: none; } nav { display: none; } svg.chart, tr, .verdict { break-inside: avoid; }
  h2, h3 { break-after: avoid; } .tables { overflow: visible; } .tables svg.chart { max-width: 100%; }
  table { font-size: 10px; } th, td, td.text { padding: 2px 4px; white-space: normal; max-width: none; overflow-wrap: break-word; }
  .glance { font-size: 11px; } .share { width: 110px; } }
)";

std::string contents(const Diagnosis& d) {
  std::string html = "<nav>";
  for (const StageDiagnosis& stage : d.stages)
    html += fmt::format("<a href=\"#{}\">{}</a>", stage_id(stage.passage), with_capital(from_to(stage.passage)));
  return html +
         "<a href=\"#where\">Where</a><a href=\"#overlay\">Runs</a><a href=\"#next\">Next</a>"
         "<a href=\"#used\">Used</a><a href=\"#method\">Method</a></nav>\n";
}

}  // namespace

std::string diagnosis_page(const Diagnosis& d, std::span<const Overlay> overlays) {
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n<title>Gap diagnosis: {}</title>\n"
      "<style>\n{}{}</style>\n</head>\n<body>\n<p class=\"soft\">Diagnosis of the gap between a robot and its "
      "simulation. {}</p>\n",
      d.interrupted.empty() ? verdict_name(d.verdict) : "unfinished", plot::style_sheet(), kPageStyle,
      plot::escaped(d.observations.dataset.description));
  html += answer_section(d) + contents(d);
  for (std::size_t s = 0; s < d.stages.size(); ++s) html += stage_section(d, s);
  html += where_section(d, overlays) + overlay_section(d, overlays) + next_section(d);
  return html + used_section(d, overlays) + method_section(d) + "</body>\n</html>\n";
}

std::string diagnosis_html(const Diagnosis& d) {
  return diagnosis_page(d, simulate_overlays(d));
}

}  // namespace kenaf::gap::diagnose
