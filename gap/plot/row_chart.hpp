// Named quantities in rows, each with marks and their intervals on one common axis.
//
// Thread safety: values and pure functions.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gap/plot/axis.hpp"
#include "gap/plot/chart.hpp"

namespace kenaf::gap::plot {

// Shapes, so that the chart is readable without colours.
enum class Shape { ring, disc, bar };

struct RowMark {
  double value;  // left out if not finite
  Shape shape = Shape::disc;
  Ink ink = Ink::real;
  std::optional<Range> interval{};  // a whisker
};

struct Row {
  std::string label;           // left of the axis
  std::vector<RowMark> marks;  // joined by a line
  std::string note;            // right of the axis
};

struct RowLegend {
  Shape shape;
  Ink ink;
  std::string text;
};

struct RowChart {
  std::string title, x_label;
  std::vector<Row> rows;
  std::vector<RowLegend> legend;
  std::vector<std::pair<double, std::string>> guides;  // dashed vertical lines with their labels
  std::optional<Range> view;           // empty: all values and intervals; what lies beyond is an arrow at its edge
  bool logarithmic = false;            // values that are not positive lie beyond the left edge
  double label_px = 190, note_px = 0;  // more if they need it, up to half and a quarter of the width
  double width_px = 1060;
};

// Returns one <svg> element, for the style sheet of chart.hpp. Without rows it says "nothing to show".
std::string to_svg(const RowChart& chart);

}  // namespace kenaf::gap::plot
