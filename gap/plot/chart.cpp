#include "gap/plot/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "gap/plot/axis.hpp"
#include "gap/plot/simplify.hpp"
#include "gap/plot/svg.hpp"

namespace kenaf::gap::plot {

namespace {

constexpr double kLeft_px = 70, kRight_px = 14, kTop_px = 50, kBottom_px = 42;
constexpr double kLegendBase_px = 38, kLegendSample_px = 24;
constexpr double kLetter_px = 7.5;  // about the width of a letter at the font size of 13
constexpr double kPixelsPerTick_x = 60, kPixelsPerTick_y = 26;
constexpr double kTolerance_px = 0.15;  // largest distance of a point from the drawn line
// Bounds of the plot's height where the scales are equal.
constexpr double kLeastHeight_px = 90, kMostHeight_px = 340;

std::string_view stroke_class(Stroke stroke) {
  constexpr std::string_view kClasses[] = {"solid", "dashed", "dotted", "hair", "wide"};
  return kClasses[static_cast<std::size_t>(stroke)];
}

struct View {
  Range x, y;
  double width_px, height_px;  // of the plot itself
  Point operator()(const Point& p) const {
    return {(p.x() - x.low) / x.span() * width_px, (y.high - p.y()) / y.span() * height_px};
  }
};

struct Bounds {
  Range x{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}, y = x;
  bool empty() const { return x.low > x.high; }
  void add(const Point& p) {
    if (!p.allFinite()) return;
    x = {std::min(x.low, p.x()), std::max(x.high, p.x())};
    y = {std::min(y.low, p.y()), std::max(y.high, p.y())};
  }
};

Range grown(Range range, double to_span) {
  const double middle = (range.low + range.high) / 2;
  return to_span > range.span() ? Range{middle - to_span / 2, middle + to_span / 2} : range;
}

// Adds a margin of `share` to both ends, but not below a range that begins at zero.
Range with_margin(Range range, double share) {
  range = with_extent(range);
  const double margin = share * range.span();
  return {range.low == 0 ? 0 : range.low - margin, range.high + margin};
}

View view_of(const Chart& chart, const Bounds& bounds) {
  const double width_px = chart.width_px - kLeft_px - kRight_px;
  View view{with_extent(bounds.x), with_margin(bounds.y, 0.06), width_px, chart.height_px - kTop_px - kBottom_px};

  // The largest common scale that fits both axes; then both ranges grow to fill the plot.
  if (chart.equal_scales) {
    view.y = with_extent(bounds.y);
    const double pixels = std::min(width_px / view.x.span(), kMostHeight_px / view.y.span());
    view.x = grown(view.x, width_px / pixels);
    view.y = grown(view.y, kLeastHeight_px / pixels);
    view.height_px = view.y.span() * pixels;
  }
  return view;
}

std::string path_data(const std::vector<Point>& points, const View& view) {
  std::string data;
  // Points that are not finite part the line into pieces, each simplified by itself.
  std::vector<Point> piece;
  const auto draw_piece = [&] {
    for (std::size_t i = 0; const Point& p : simplified(piece, kTolerance_px)) {
      fmt::format_to(std::back_inserter(data), "{}{:.1f} {:.1f}", i++ == 0 ? "M" : "L", p.x(), p.y());
    }
    if (piece.size() == 1) data += "h0.1";  // a lone point becomes a dot
    piece.clear();
  };
  for (const Point& p : points) {
    if (p.allFinite()) {
      piece.push_back(view(p));
    } else {
      draw_piece();
    }
  }
  draw_piece();
  return data;
}

std::string legend(const Chart& chart) {
  std::string svg;
  double x = kLeft_px;
  for (const Line& line : chart.lines) {
    if (line.legend.empty()) continue;
    fmt::format_to(std::back_inserter(svg), "<path class=\"line {} {}\" d=\"M{:.1f} {}h{}\"/>", ink_class(line.ink),
                   stroke_class(line.stroke), x, kLegendBase_px - 4, kLegendSample_px);
    x += kLegendSample_px + 6;
    fmt::format_to(std::back_inserter(svg), "<text x=\"{:.1f}\" y=\"{}\">{}</text>\n", x, kLegendBase_px,
                   escaped(line.legend));
    x += kLetter_px * static_cast<double>(line.legend.size()) + 16;
  }
  for (const Disc& disc : chart.discs) {
    if (disc.legend.empty()) continue;
    fmt::format_to(std::back_inserter(svg), "<circle class=\"{} {}\" cx=\"{:.1f}\" cy=\"{}\" r=\"5\"/>",
                   disc.filled ? "disc" : "ring", ink_class(disc.ink), x + 5, kLegendBase_px - 4);
    x += 16;
    fmt::format_to(std::back_inserter(svg), "<text x=\"{:.1f}\" y=\"{}\">{}</text>\n", x, kLegendBase_px,
                   escaped(disc.legend));
    x += kLetter_px * static_cast<double>(disc.legend.size()) + 16;
  }
  return svg;
}

// Grid, ticks and labels, in the plot's own coordinates.
std::string axes(const Chart& chart, const View& view) {
  std::string svg;
  const auto out = std::back_inserter(svg);
  const Ticks across = round_ticks(view.x, std::max(2, static_cast<int>(view.width_px / kPixelsPerTick_x)));
  const Ticks up = round_ticks(view.y, std::max(2, static_cast<int>(view.height_px / kPixelsPerTick_y)));
  std::string grid;
  for (std::size_t i = 0; i < across.at.size(); ++i) {
    const double x = view({across.at[i], view.y.low}).x();
    fmt::format_to(std::back_inserter(grid), "M{:.1f} 0v{:.1f}", x, view.height_px);
    fmt::format_to(out, "<text class=\"middle\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>", x, view.height_px + 17,
                   across.labels[i]);
  }
  for (std::size_t i = 0; i < up.at.size(); ++i) {
    const double y = view({view.x.low, up.at[i]}).y();
    fmt::format_to(std::back_inserter(grid), "M0 {:.1f}h{:.1f}", y, view.width_px);
    fmt::format_to(out, "<text class=\"end\" x=\"-7\" y=\"{:.1f}\">{}</text>", y + 4.5, up.labels[i]);
  }
  fmt::format_to(out, "\n<text class=\"middle\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>", view.width_px / 2,
                 view.height_px + 35, escaped(chart.x_label));
  fmt::format_to(out, "<text class=\"middle\" transform=\"translate(-57 {:.1f}) rotate(-90)\">{}</text>",
                 view.height_px / 2, escaped(chart.y_label));
  fmt::format_to(out, "\n<path class=\"grid\" d=\"{}\"/>\n", grid);
  return svg;
}

std::string discs(const Chart& chart, const View& view) {
  std::string svg;
  const auto out = std::back_inserter(svg);
  for (const Disc& disc : chart.discs) {
    if (!disc.at.allFinite()) continue;
    const Point at = view(disc.at);
    std::string circle =
        fmt::format("<circle class=\"{} {}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\"", disc.filled ? "disc" : "ring",
                    ink_class(disc.ink), at.x(), at.y(), disc.radius_px);
    circle += disc.hint.empty() ? "/>" : fmt::format("><title>{}</title></circle>", escaped(disc.hint));
    svg += linked(std::move(circle), disc.link) + "\n";
    if (disc.label.empty()) continue;
    const double half_px = kLetter_px * static_cast<double>(disc.label.size()) / 2, above = at.y() - disc.radius_px - 5;
    fmt::format_to(out, "<text class=\"halo middle\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
                   std::max(half_px, std::min(at.x(), view.width_px - half_px)),
                   above < 14 ? at.y() + disc.radius_px + 16 : above, escaped(disc.label));
  }
  return svg;
}

std::string contents(const Chart& chart, const View& view) {
  std::string svg;
  const auto out = std::back_inserter(svg);
  // An inner <svg> clips its contents.
  fmt::format_to(out, "<svg width=\"{:.1f}\" height=\"{:.1f}\">\n", view.width_px, view.height_px);
  for (const Area& area : chart.areas) {
    fmt::format_to(out, "<path class=\"{} {}\" d=\"{}{}\"/>\n", area.filled ? "area" : "line", ink_class(area.ink),
                   path_data(area.outline, view), area.filled ? "z" : "");
  }
  for (const Line& line : chart.lines) {
    fmt::format_to(out, "<path class=\"line {} {}\" d=\"{}\"/>\n", ink_class(line.ink), stroke_class(line.stroke),
                   path_data(line.points, view));
  }
  svg += discs(chart, view);
  fmt::format_to(out, "</svg>\n<path class=\"frame\" d=\"M0 0h{0:.1f}v{1:.1f}h-{0:.1f}z\"/>\n", view.width_px,
                 view.height_px);
  return svg;
}

}  // namespace

std::string_view ink_class(Ink ink) {
  constexpr std::string_view kClasses[] = {"real", "sim", "third", "fourth", "faint", "ground"};
  return kClasses[static_cast<std::size_t>(ink)];
}

std::string_view style_sheet() {
  // The colours of light and dark theme and of paper, then the classes.
  return R"(:root { color-scheme: light dark;
  --paper: #fff; --ink: #1b2430; --soft: #5d6875; --grid: #e3e7ec; --frame: #9aa4b0;
  --real: #0072b2; --sim: #d55e00; --third: #009e73; --fourth: #cc79a7; --faint: #7d8792;
  --ground: #e2dccf; --ground-edge: #8b8272; --shade: #0072b2; }
@media (prefers-color-scheme: dark) { :root {
  --paper: #14181d; --ink: #e4e8ed; --soft: #a2acb8; --grid: #2a313a; --frame: #68727e;
  --real: #56b4e9; --sim: #f0913c; --third: #2ec79b; --fourth: #e39cc4; --faint: #8b95a1;
  --ground: #37332b; --ground-edge: #958b79; --shade: #3f9fdc; } }
@media print { :root { color-scheme: light; --paper: #fff; --ink: #000; --soft: #333; --grid: #ddd; --frame: #777;
  --real: #0072b2; --sim: #d55e00; --third: #009e73; --fourth: #cc79a7; --faint: #777;
  --ground: #e2dccf; --ground-edge: #8b8272; --shade: #0072b2; } }
svg.chart { font: 13px system-ui, "DejaVu Sans", "Liberation Sans", Arial, sans-serif; max-width: 100%; height: auto; }
svg.chart text { fill: var(--soft); }
svg.chart text.title { fill: var(--ink); font-weight: 600; font-size: 14px; }
svg.chart text.middle { text-anchor: middle; }
svg.chart text.end { text-anchor: end; }
svg.chart path { fill: none; }
svg.chart .grid { stroke: var(--grid); }
svg.chart .frame { stroke: var(--frame); }
svg.chart .line { stroke-width: 1.8; stroke-linejoin: round; stroke-linecap: round; }
svg.chart .line.dashed { stroke-dasharray: 7 5; stroke-linecap: butt; }
svg.chart .line.dotted { stroke-dasharray: 2 3; stroke-width: 2; stroke-linecap: butt; }
svg.chart .line.hair { stroke-width: 0.7; }
svg.chart .line.wide { stroke-width: 3.6; stroke-opacity: 0.55; stroke-linecap: butt; }
svg.chart .line.real { stroke: var(--real); }
svg.chart .line.sim { stroke: var(--sim); }
svg.chart .line.third { stroke: var(--third); }
svg.chart .line.fourth { stroke: var(--fourth); }
svg.chart .line.faint { stroke: var(--faint); }
svg.chart .line.ground { stroke: var(--ground-edge); }
svg.chart .disc { fill-opacity: 0.75; }
svg.chart .whisker { stroke: var(--ink); stroke-width: 1.3; }
svg.chart .ring { fill: none; stroke-width: 1.8; pointer-events: all; }
svg.chart .disc.real { fill: var(--real); }
svg.chart .disc.sim, svg.chart .bar.sim { fill: var(--sim); }
svg.chart .disc.third, svg.chart .bar.third { fill: var(--third); }
svg.chart .bar.real { fill: var(--real); }
svg.chart .ring.sim { stroke: var(--sim); }
svg.chart .ring.real { stroke: var(--real); }
svg.chart .ring.third { stroke: var(--third); }
svg.chart .arrow.sim { fill: var(--sim); }
svg.chart .arrow.real { fill: var(--real); }
svg.chart .arrow.third { fill: var(--third); }
svg.chart .arrow.whisker-end { fill: var(--ink); }
svg.chart .mark { fill-opacity: 1; }
svg.chart .shade { fill: var(--shade); stroke: var(--frame); stroke-width: 0.6; }
svg.chart text.dark { fill: var(--ink); }
svg.chart text.small { font-size: 11px; }
svg.chart text.halo { fill: var(--ink); paint-order: stroke; stroke: var(--paper); stroke-width: 3px; }
svg.chart .area.ground { fill: var(--ground); stroke: var(--ground-edge); }
)";
}

std::string to_svg(const Chart& chart) {
  Bounds bounds;
  for (const Line& line : chart.lines) {
    for (const Point& p : line.points) bounds.add(p);
  }

  // The view must show the lines and what the chart includes.
  const bool empty = bounds.empty();
  if (empty) bounds.add({0, 0});
  for (const Point& p : chart.include) bounds.add(p);
  const View view = view_of(chart, bounds);
  const double height_px = view.height_px + kTop_px + kBottom_px;
  std::string svg;
  if (empty)
    svg = text_at(kLeft_px, kLegendBase_px, "not measured");
  else
    svg = fmt::format("{}<g transform=\"translate({} {})\">\n{}{}</g>\n", legend(chart), kLeft_px, kTop_px,
                      axes(chart, view), contents(chart, view));
  return svg_chart(chart.title, chart.width_px, height_px, svg, kLeft_px);
}

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        // XML allows no control characters, not even escaped
        if (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t')
          out += "\uFFFD";
        else
          out += c;
    }
  }
  return out;
}

}  // namespace kenaf::gap::plot
