// A chart as SVG: lines and areas over two axes with round ticks, for reports that open offline. Text stays text, so
// that it can be searched and copied; colours are classes of one style sheet, so that a page suits light, dark and
// paper.
//
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

// Wide is pale, for what others are drawn over.
enum class Stroke { solid, dashed, dotted, hair, wide };

struct Line {
  std::vector<Point> points;  // in the axes' units; a point that is not finite breaks the line
  Ink ink = Ink::real;
  Stroke stroke = Stroke::solid;
  std::string legend = {};  // empty: not in the legend
};

// What is behind the lines; it does not widen the view.
struct Area {
  std::vector<Point> outline;
  Ink ink = Ink::ground;
  bool filled = true;  // and closed; false: only its line, which may have breaks
};

// A place with an amount, which the circle's area shows.
struct Disc {
  Point at;
  double radius_px;
  Ink ink = Ink::real;
  bool filled = true;       // otherwise a ring
  std::string label = {};   // above it, or below where there is no room
  std::string legend = {};  // empty: not in the legend
};

struct Chart {
  std::string title, x_label, y_label;  // labels with their unit: "x (m)"
  std::vector<Area> areas;              // the first is the lowest; all are under the lines
  std::vector<Line> lines;
  std::vector<Disc> discs;     // over the lines, clipped like areas; one that is not finite is left out
  std::vector<Point> include;  // what the view shows beside all points of the lines; areas are clipped
  bool equal_scales = false;   // as long on paper in both directions; the height follows
  double width_px = 540, height_px = 280;
};

// The style sheet that to_svg() relies on; a page has it once, in <style>.
std::string_view style_sheet();

// The names of its classes.
std::string_view ink_class(Ink ink);

// One <svg> element. A chart without any finite point says "not measured" in its place.
std::string to_svg(const Chart& chart);

// Text as it may stand in HTML and SVG, between tags and in attributes.
std::string escaped(std::string_view text);

}  // namespace kenaf::gap::plot
