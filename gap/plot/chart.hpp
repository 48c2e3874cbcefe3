// A chart as SVG: lines and areas over two axes with round ticks, for reports that open offline. Text stays text, so
// that it can be searched and copied; colours are classes of one style sheet, so that a page suits light and dark
// themes and paper.
//
// Thread safety: values and pure functions.
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

namespace kenaf::gap::plot {

using Point = Eigen::Vector2d;

// Colours by role, from the Okabe-Ito palette, distinguishable with the common kinds of colour blindness. Real and
// simulated also differ in brightness, for grey prints.
enum class Ink { real, sim, third, fourth, faint, ground };

// Wide is pale, for lines beneath others.
enum class Stroke { solid, dashed, dotted, hair, wide };

struct Line {
  std::vector<Point> points;  // in the axes' units; a point that is not finite breaks the line
  Ink ink = Ink::real;
  Stroke stroke = Stroke::solid;
  std::string legend = {};  // empty: not in the legend
};

// An area behind the lines; it does not widen the view.
struct Area {
  std::vector<Point> outline;
  Ink ink = Ink::ground;
  bool filled = true;  // and closed; false: only its line, which may have breaks
};

// A point with an amount, shown by the circle's area.
struct Disc {
  Point at;
  double radius_px;
  Ink ink = Ink::real;
  bool filled = true;       // otherwise a ring
  std::string label = {};   // above it, or below if there is no room
  std::string legend = {};  // empty: not in the legend
  std::string hint = {};    // shown under the pointer
  std::string link = {};    // followed by a click on it; empty: none
};

struct Chart {
  std::string title, x_label, y_label;  // labels with their unit: "x (m)"
  std::vector<Area> areas;              // the first is the lowest; all are under the lines
  std::vector<Line> lines;
  std::vector<Disc> discs;     // over the lines, clipped like areas; those that are not finite are left out
  std::vector<Point> include;  // points that the view shows besides those of the lines; areas are clipped
  bool equal_scales = false;   // the same scale on both axes; the height follows
  double width_px = 540, height_px = 280;
};

// Returns the style sheet that to_svg() relies on; a page has it once, in <style>.
std::string_view style_sheet();

// Returns the name of a colour's class in it.
std::string_view ink_class(Ink ink);

// Returns one <svg> element. A chart without any finite point says "not measured" instead.
std::string to_svg(const Chart& chart);

// Escapes text for HTML and SVG, between tags and in attributes.
std::string escaped(std::string_view text);

}  // namespace kenaf::gap::plot
