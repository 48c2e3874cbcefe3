#include "gap/diagnose/page/left_over_section.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "gap/diagnose/page/figures.hpp"
#include "gap/diagnose/page/words.hpp"
#include "gap/plot/chart.hpp"

namespace kenaf::gap::diagnose {
namespace {

constexpr std::size_t kMostPlots = 6;  // chosen: three rows of two
constexpr double kDot_px = 2;
constexpr double kMargin = 0.02;  // of the points' extent
// Fitted less their mean in the run, so that their axis has negative times and places.
constexpr std::string_view kFromMean[] = {"time since the start", "place along x", "place along y"};

std::string with_unit(std::string_view text, std::string_view unit) {
  return unit.empty() ? std::string(text) : fmt::format("{} ({})", text, unit);
}

}  // namespace

std::string left_over_plot(const Dependence& d) {
  const bool by_run = d.on == "run", constant = d.on == "constant";
  const bool from_mean = std::ranges::find(kFromMean, d.on) != std::end(kFromMean);
  plot::Chart chart;
  chart.title = fmt::format("{} over {}: {} of it", d.channel, by_run ? "runs" : d.on, percent(d.share));
  chart.x_label = with_unit(by_run      ? "number of the run"
                            : constant  ? "simulated " + d.channel
                            : from_mean ? d.on + ", less its mean in the run"
                                        : d.on,
                            d.on_unit);
  chart.y_label = by_run ? with_unit(d.channel, d.unit) : with_unit("measured minus simulated", d.unit);
  chart.width_px = kHalf_px;
  if (d.points.empty()) return to_svg(chart);
  double low = d.points.front()[0], high = low;
  for (const auto& [x, y] : d.points) {
    low = std::min(low, x);
    high = std::max(high, x);
    chart.discs.push_back({{x, y}, kDot_px, plot::Ink::real});
    chart.include.emplace_back(x, y);
  }
  // keeps dots off the frame
  const double margin = kMargin * (high - low);
  low -= margin;
  high += margin;
  const auto on_line = [&](double x) { return plot::Point(x, d.intercept + d.slope * x); };
  chart.lines.push_back(
      {{on_line(low), on_line(high)}, plot::Ink::sim, plot::Stroke::solid, by_run ? "middle of the runs" : "fit"});
  if (!by_run) chart.lines.push_back({{{low, 0}, {high, 0}}, plot::Ink::faint, plot::Stroke::hair});
  return to_svg(chart);
}

std::string left_over_section(std::span<const Dependence> left_over, std::string_view how_much) {
  std::string html = "<h3>What is left</h3>\n";
  if (!how_much.empty()) html += paragraph(with_capital(std::string(how_much)) + ".");
  if (left_over.empty()) return html + paragraph("The rest correlates with no measured quantity.");
  html += paragraph(
      "Residuals of the best model against measured quantities: only dependences that hold on held-out runs. Shares "
      "are of the squared residual in that channel beyond noise.",
      "soft");
  html += "<ul>\n";
  for (const Dependence& d : left_over)
    html += fmt::format("<li>{}{}</li>\n", plot::escaped(d.words + "."),
                        d.look_at.empty() ? ""
                                          : fmt::format(" <span class=\"soft\">Look at {}.</span>",
                                                        plot::escaped(enumeration(d.look_at, "or"))));
  html += "</ul>\n<div class=\"figures\">\n";
  for (const Dependence& d : left_over.first(std::min(kMostPlots, left_over.size()))) html += left_over_plot(d);
  return html + "</div>\n";
}

}  // namespace kenaf::gap::diagnose
