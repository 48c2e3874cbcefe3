// A chart as SVG: lines and areas over two axes with round ticks, for reports that open offline. Text stays text, so
// that it can be searched and copied; colours are classes of one style sheet, so that a page suits light, dark and
// paper.
// Thread safety: values and pure functions.
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

namespace kenaf::gap::plot {

using Point = Eigen::Vector2d;

// Colours by role, from the Okabe-Ito palette, which the common kinds of colour blindness tell apart. Real and
// simulated differ in brightness too, for grey prints.
enum class Ink { real, sim, third, fourth, faint, ground };

enum class Stroke { solid, dashed, dotted, hair };

struct Line {
  std::vector<Point> points;  // in the axes' units; a point that is not finite breaks the line
  Ink ink = Ink::real;
  Stroke stroke = Stroke::solid;
  std::string legend = {};    // empty: not in the legend
};

// What is behind the lines; it does not widen the view.
struct Area {
  std::vector<Point> outline;
  Ink ink = Ink::ground;
  bool filled = true;         // and closed; false: only its line, which may have breaks
};

struct Chart {
  std::string title, x_label, y_label;  // labels with their unit: "x (m)"
  std::vector<Area> areas;              // the first is the lowest; all are under the lines
  std::vector<Line> lines;
  std::vector<Point> include;           // what the view shows beside all points of the lines; areas are clipped
  bool equal_scales = false;            // as long on paper in both directions; the height follows
  double width_px = 540, height_px = 280;
};

// The style sheet that to_svg() relies on; a page has it once, in <style>.
std::string_view style_sheet();

// One <svg> element. A chart without any finite point says "not measured" in its place.
std::string to_svg(const Chart& chart);

// Text as it may stand in HTML and SVG, between tags and in attributes.
std::string escaped(std::string_view text);

}  // namespace kenaf::gap::plot
