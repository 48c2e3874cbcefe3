#include "gap/plot/row_chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "gap/plot/svg.hpp"

namespace kenaf::gap::plot {

namespace {

constexpr double kTitle_px = 26, kLegend_px = 22, kGuide_px = 16, kRow_px = 24, kRowsBottom_px = 44;
constexpr double kRadius_px = 5, kBarHalf_px = 7, kWhiskerEnd_px = 4, kArrow_px = 9;
constexpr double kRowLabelGap_px = 10, kRowNoteGap_px = 12, kRowEdge_px = 14;
constexpr double kPixelsPerTick = 70;

// Maps values to pixels; values beyond the range go to its edge, and beyond() says to which.
struct Scale {
  Range range;  // of the logarithms on a logarithmic scale
  bool logarithmic;
  double width_px;
  double share(double value) const {
    if (logarithmic) value = value > 0 ? std::log10(value) : -std::numeric_limits<double>::infinity();
    return (value - range.low) / range.span();
  }
  double operator()(double value) const { return std::clamp(share(value), 0.0, 1.0) * width_px; }
  // -1: left of the range, 1: right of it, 0: in it
  int beyond(double value) const {
    const double at = share(value), rounding = 1e-9;
    return at < -rounding ? -1 : at > 1 + rounding ? 1 : 0;
  }
};

Range range_of(const RowChart& chart) {
  if (chart.view)
    return chart.logarithmic ? Range{std::log10(chart.view->low), std::log10(chart.view->high)} : *chart.view;
  // All values, intervals and guides, and the zero at which bars begin; values without a logarithm do not count.
  Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  const auto add = [&](double value) {
    if (!std::isfinite(value) || (chart.logarithmic && value <= 0)) return;
    if (chart.logarithmic) value = std::log10(value);
    range = {std::min(range.low, value), std::max(range.high, value)};
  };
  for (const Row& row : chart.rows)
    for (const RowMark& mark : row.marks) {
      add(mark.value);
      if (mark.shape == Shape::bar && !chart.logarithmic) add(0);
      if (mark.interval) add(mark.interval->low), add(mark.interval->high);
    }
  for (const auto& guide : chart.guides) add(guide.first);
  if (range.low > range.high) range = {0, 1};
  range = with_extent(range);
  const double margin = 0.04 * range.span();
  return {range.low == 0 && !chart.logarithmic ? 0 : range.low - margin, range.high + margin};
}

Ticks ticks_of(const Scale& scale) {
  const int at_most = std::max(2, static_cast<int>(scale.width_px / kPixelsPerTick));
  if (!scale.logarithmic) return round_ticks(scale.range, at_most);
  Ticks ticks;
  const double factors[] = {1, 2, 5};
  // Over more than 2.5 decades only powers of ten.
  const bool few = scale.range.span() > 2.5;
  for (int power = static_cast<int>(std::floor(scale.range.low)); power <= scale.range.high; ++power)
    for (const double factor : factors) {
      const double value = factor * std::pow(10, power), at = std::log10(value);
      if (at < scale.range.low || at > scale.range.high || (few && factor > 1)) continue;
      ticks.at.push_back(value);
      ticks.labels.push_back(fmt::format("{:g}", value));
    }
  return ticks;
}

std::string shape_at(Shape shape, Ink ink, double x, double y, double from_x) {
  const std::string_view colour = ink_class(ink);
  switch (shape) {
    case Shape::bar:
      return fmt::format("<rect class=\"bar {}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>",
                         colour, std::min(x, from_x), y - kBarHalf_px, std::abs(x - from_x), 2 * kBarHalf_px);
    case Shape::ring:
      return fmt::format("<circle class=\"ring {}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\"/>", colour, x, y, kRadius_px);
    case Shape::disc:
      return fmt::format("<circle class=\"disc mark {}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\"/>", colour, x, y,
                         kRadius_px);
  }
  return {};
}

// A head of an arrow at the axis's edge: what it stands for lies farther out.
std::string arrow_at(std::string_view classes, double x, double y, int side, std::string_view hint) {
  return fmt::format("<path class=\"{}\" d=\"M{:.1f} {:.1f}l{} -{}v{}z\">{}</path>", classes, x, y, -side * kArrow_px,
                     kArrow_px / 2, kArrow_px, hint.empty() ? "" : fmt::format("<title>{}</title>", escaped(hint)));
}

std::string mark_of(const RowMark& mark, const Scale& scale, double y) {
  const double x = scale(mark.value);
  const int side = scale.beyond(mark.value);
  std::string svg;
  // a bar ends at the edge with an arrow; a point is nothing but the arrow, as it is not at the edge
  if (mark.shape == Shape::bar || side == 0) svg += shape_at(mark.shape, mark.ink, x, y, scale(0));
  if (side != 0)
    svg += arrow_at(fmt::format("arrow {}", ink_class(mark.ink)), x, y, side,
                    fmt::format("{:.4g}, beyond the axis", mark.value));
  return svg;
}

std::string whisker_of(const Range& interval, const Scale& scale, double y) {
  const double low = scale(interval.low), high = scale(interval.high);
  std::string svg = fmt::format("<path class=\"frame whisker\" d=\"M{:.1f} {:.1f}H{:.1f}", low, y, high);
  for (const double end : {interval.low, interval.high})
    if (scale.beyond(end) == 0)
      svg += fmt::format("M{:.1f} {:.1f}v{}", scale(end), y - kWhiskerEnd_px, 2 * kWhiskerEnd_px);
  svg += "\"/>";
  for (const double end : {interval.low, interval.high})
    if (const int side = scale.beyond(end); side != 0)
      svg += arrow_at("arrow whisker-end", scale(end), y, side, fmt::format("to {:.4g}, beyond the axis", end));
  return svg;
}

std::string legend_of(const RowChart& chart, double left_px) {
  std::string svg;
  double x = left_px;
  for (const RowLegend& entry : chart.legend) {
    svg += shape_at(entry.shape, entry.ink, x + 8, kTitle_px + 10, x - 2);
    svg += text_at(x + 20, kTitle_px + 14, entry.text);
    x += 20 + text_width_px(entry.text) + 18;
  }
  return svg;
}

// Labels and notes get the room that they need, up to half and a quarter of the chart.
struct Room {
  double label_px, note_px;
};
Room room_of(const RowChart& chart) {
  double label_px = chart.label_px, note_px = chart.note_px;
  for (const Row& row : chart.rows) {
    label_px = std::max(label_px, text_width_px(row.label) + 2 * kRowLabelGap_px);
    if (!row.note.empty()) note_px = std::max(note_px, text_width_px(row.note) + kRowNoteGap_px);
  }
  note_px = std::min(note_px, std::max(chart.note_px, chart.width_px / 4));
  return {std::min(label_px, std::max(chart.label_px, chart.width_px / 2)), note_px};
}

std::string row_of(const Row& row, const Scale& scale, const Room& room, double y) {
  std::string svg = text_at(-kRowLabelGap_px, y + 4.5, end_of(row.label, room.label_px - kRowLabelGap_px), "end dark");
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const RowMark& mark : row.marks)
    if (std::isfinite(mark.value)) low = std::min(low, scale(mark.value)), high = std::max(high, scale(mark.value));
  if (row.marks.size() > 1 && low < high)
    svg += fmt::format("<path class=\"line faint solid\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>", low, y, high);
  for (const RowMark& mark : row.marks) {
    if (!std::isfinite(mark.value)) continue;
    svg += mark_of(mark, scale, y);
    if (mark.interval) svg += whisker_of(*mark.interval, scale, y);
  }
  return svg + text_at(scale.width_px + kRowNoteGap_px, y + 4.5, row.note, "") + "\n";
}

}  // namespace

std::string to_svg(const RowChart& chart) {
  const double top_px =
      kTitle_px + (chart.legend.empty() ? 0 : kLegend_px) + (chart.guides.empty() ? 0 : kGuide_px) + 4;
  const double rows_px = kRow_px * static_cast<double>(chart.rows.size());
  const Room room = room_of(chart);
  const Scale scale{range_of(chart), chart.logarithmic, chart.width_px - room.label_px - room.note_px - kRowEdge_px};
  if (chart.rows.empty())
    return svg_chart(chart.title, chart.width_px, kTitle_px + 24, text_at(0, kTitle_px + 12, "nothing to show"));
  std::string svg = legend_of(chart, room.label_px);
  const auto out = std::back_inserter(svg);
  fmt::format_to(out, "\n<g transform=\"translate({:.1f} {:.1f})\">\n", room.label_px, top_px);

  // Grid with tick labels, axis label and guides.
  const Ticks ticks = ticks_of(scale);
  std::string grid;
  for (std::size_t i = 0; i < ticks.at.size(); ++i) {
    const double x = scale(ticks.at[i]);
    fmt::format_to(std::back_inserter(grid), "M{:.1f} 0v{:.1f}", x, rows_px);
    svg += text_at(x, rows_px + 17, ticks.labels[i], "middle");
  }
  fmt::format_to(out, "\n<path class=\"grid\" d=\"{}\"/>", grid);
  svg += text_at(scale.width_px / 2, rows_px + 36, chart.x_label, "middle");
  for (const auto& [value, words] : chart.guides) {
    fmt::format_to(out, "<path class=\"line faint dashed\" d=\"M{:.1f} -4v{:.1f}\"/>", scale(value), rows_px + 4);
    // words are centred on their guide, or moved so far that they stay in the chart
    const double half_px = text_width_px(words) / 2, right_px = scale.width_px + kRowEdge_px + room.note_px;
    svg += text_at(std::max(half_px - room.label_px, std::min(scale(value), right_px - half_px)), -7, words, "middle");
  }
  svg += "\n";

  // The rows, then the frame over them.
  for (std::size_t i = 0; i < chart.rows.size(); ++i)
    svg += row_of(chart.rows[i], scale, room, kRow_px * (static_cast<double>(i) + 0.5));
  fmt::format_to(out, "<path class=\"frame\" d=\"M0 0h{0:.1f}v{1:.1f}h-{0:.1f}z\"/>\n</g>\n", scale.width_px, rows_px);
  return svg_chart(chart.title, chart.width_px, top_px + rows_px + kRowsBottom_px, svg);
}

}  // namespace kenaf::gap::plot
