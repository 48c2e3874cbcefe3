#include "gap/plot/strip_chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "gap/plot/axis.hpp"
#include "gap/plot/chart.hpp"
#include "gap/plot/svg.hpp"

namespace kenaf::gap::plot {

namespace {

constexpr double kStripsTop_px = 54, kStrip_px = 38, kGap_px = 8, kStripsBottom_px = 42, kStripsRight_px = 14;
constexpr double kLabelGap_px = 10;
constexpr double kSmallLetter = 0.85;  // width of a small letter relative to one of full size
constexpr int kScaleSteps = 6;
constexpr double kScaleStep_px = 26;

bool has_room(std::string_view text, double width_px) {
  return kSmallLetter * text_width_px(text) + 4 < width_px;
}

double room_for_labels(const StripChart& chart) {
  double widest_px = 0;
  for (const Strip& strip : chart.strips) widest_px = std::max(widest_px, text_width_px(strip.label));
  return std::clamp(widest_px + 2 * kLabelGap_px, chart.label_px, std::max(chart.label_px, chart.width_px / 2));
}

// The scale of shades, after the text of the legend.
std::string scale_of(const StripChart& chart) {
  std::string svg = text_at(0, 38, chart.legend);
  double x = text_width_px(chart.legend) + 12;
  svg += text_at(x, 38, chart.least);
  x += text_width_px(chart.least) + 6;
  for (int i = 0; i < kScaleSteps; ++i, x += kScaleStep_px)
    svg += shaded_box(x, 27, kScaleStep_px, 14, static_cast<double>(i) / (kScaleSteps - 1));
  return svg + text_at(x + 6, 38, chart.most) + "\n";
}

std::string span_of(const StripSpan& span, double x_px, double width_px, double y_px) {
  std::string svg = shaded_box(x_px, y_px, width_px, kStrip_px, span.strength,
                               fmt::format("{} {}, {:.1f} to {:.1f}", span.name, span.note, span.from, span.to));
  const double middle = x_px + width_px / 2;
  const bool name = has_room(span.name, width_px), note = has_room(span.note, width_px);
  if (name) svg += text_at(middle, y_px + (note ? 16 : 23), span.name, "middle dark small");
  if (note) svg += text_at(middle, y_px + (name ? 31 : 23), span.note, "middle dark small");
  return linked(std::move(svg), span.link) + "\n";
}

}  // namespace

std::string to_svg(const StripChart& chart) {
  Range range{0, 0};
  for (const Strip& strip : chart.strips)
    for (const StripSpan& span : strip.spans) range = {std::min(range.low, span.from), std::max(range.high, span.to)};
  if (range.span() <= 0)
    return svg_chart(chart.title, chart.width_px, kStripsTop_px, text_at(0, 38, "nothing to show"));

  // The common axis begins at 0 or earlier, right of the labels.
  const double label_px = room_for_labels(chart), width_px = chart.width_px - label_px - kStripsRight_px;
  const double height_px = (kStrip_px + kGap_px) * static_cast<double>(chart.strips.size());
  const auto at = [&](double value) { return (value - range.low) / range.span() * width_px; };
  std::string svg = scale_of(chart);
  const auto out = std::back_inserter(svg);
  fmt::format_to(out, "<g transform=\"translate({:.1f} {:.1f})\">\n", label_px, kStripsTop_px);

  // Grid with tick labels, then the strips.
  const Ticks ticks = round_ticks(range, 14);
  for (std::size_t i = 0; i < ticks.at.size(); ++i) {
    fmt::format_to(out, "<path class=\"grid\" d=\"M{:.1f} 0v{:.1f}\"/>", at(ticks.at[i]), height_px);
    svg += text_at(at(ticks.at[i]), height_px + 15, ticks.labels[i], "middle");
  }
  svg += text_at(width_px / 2, height_px + 34, chart.x_label, "middle") + "\n";

  for (std::size_t s = 0; s < chart.strips.size(); ++s) {
    const double y = (kStrip_px + kGap_px) * static_cast<double>(s) + kGap_px / 2;
    svg += text_at(-kLabelGap_px, y + kStrip_px / 2 + 4.5, end_of(chart.strips[s].label, label_px - kLabelGap_px),
                   "end dark");
    for (const StripSpan& span : chart.strips[s].spans)
      svg += span_of(span, at(span.from), at(span.to) - at(span.from), y);
  }
  svg += "</g>\n";
  return svg_chart(chart.title, chart.width_px, kStripsTop_px + height_px + kStripsBottom_px, svg);
}

}  // namespace kenaf::gap::plot
