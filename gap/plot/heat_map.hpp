// A table of numbers, each on a box that is darker where more is.
//
// Thread safety: values and pure functions.
#pragma once

#include <string>
#include <vector>

namespace kenaf::gap::plot {

struct HeatCell {
  std::string text;       // empty: no box either
  double strength = 0;    // of its shade, 0 to 1
  std::string hint = {};  // shows under the pointer
};

struct HeatMap {
  std::string title;
  std::vector<std::string> rows, columns;    // names
  std::vector<std::vector<HeatCell>> cells;  // [row][column]
  std::string legend;                        // what shade and number mean
  double width_px = 1060;                    // at most
};

// One <svg> element, for the style sheet of chart.hpp. Without rows it says "nothing to show".
std::string to_svg(const HeatMap& map);

}  // namespace kenaf::gap::plot
