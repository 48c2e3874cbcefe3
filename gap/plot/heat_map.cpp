#include "gap/plot/heat_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "gap/plot/svg.hpp"

namespace kenaf::gap::plot {

namespace {

constexpr double kMapTop_px = 46, kMostCell_px = 40, kLeastCell_px = 17, kCellHeight_px = 21;
constexpr double kSlant_deg = 55;  // of the columns' names

double widest_px(const std::vector<std::string>& names) {
  double width = 0;
  for (const std::string& name : names) width = std::max(width, text_width_px(name));
  return width;
}

}  // namespace

std::string to_svg(const HeatMap& map) {
  if (map.rows.empty() || map.columns.empty())
    return svg_begin(map.title, map.width_px, kMapTop_px) + text_at(0, kMapTop_px - 8, "nothing to show") + "</svg>\n";
  // Layout: names of rows at the left, slanted names of columns above, which are length * sin(slant) high; cells fill
  // the width.
  const double slant = kSlant_deg * 3.141592653589793 / 180;
  const double left_px = widest_px(map.rows) + 12, names_px = widest_px(map.columns);
  const double head_px = names_px * std::sin(slant) + 14, right_px = names_px * std::cos(slant) + 10;
  const auto columns = static_cast<double>(map.columns.size());
  const double cell_px = std::clamp((map.width_px - left_px - right_px) / columns, kLeastCell_px, kMostCell_px);
  const double width_px = std::max(left_px + columns * cell_px + right_px,
                                   std::max(text_width_px(map.legend), 1.1 * text_width_px(map.title)) + 8);

  std::string svg =
      svg_begin(map.title, width_px, kMapTop_px + head_px + kCellHeight_px * static_cast<double>(map.rows.size()) + 6);
  const auto out = std::back_inserter(svg);
  svg += text_at(0, 36, map.legend);
  fmt::format_to(out, "\n<g transform=\"translate({:.1f} {:.1f})\">\n", left_px, kMapTop_px + head_px);
  for (std::size_t c = 0; c < map.columns.size(); ++c)
    fmt::format_to(out, "<g transform=\"translate({:.1f} -6) rotate(-{})\">{}</g>\n",
                   (static_cast<double>(c) + 0.6) * cell_px, kSlant_deg, text_at(0, 0, map.columns[c], "dark"));
  for (std::size_t r = 0; r < map.rows.size(); ++r) {
    const double y = kCellHeight_px * static_cast<double>(r);
    svg += text_at(-8, y + kCellHeight_px / 2 + 4.5, map.rows[r], "end dark");
    for (std::size_t c = 0; c < map.columns.size(); ++c) {
      const HeatCell& cell = map.cells[r][c];
      if (cell.text.empty()) continue;
      const double x = cell_px * static_cast<double>(c);
      svg += shaded_box(x, y, cell_px, kCellHeight_px, cell.strength, cell.hint);
      svg += text_at(x + cell_px / 2, y + kCellHeight_px / 2 + 4, cell.text, "middle dark small");
    }
    svg += "\n";
  }
  return svg + "</g>\n</svg>\n";
}

}  // namespace kenaf::gap::plot
