// A table of numbers on boxes, darker for more.
//
// Thread safety: values and pure functions.
#pragma once

#include <string>
#include <vector>

namespace kenaf::gap::plot {

struct HeatCell {
  std::string text;       // empty: no box, too
  double strength = 0;    // of the shade, 0 to 1
  std::string hint = {};  // shown under the pointer
};

struct HeatMap {
  std::string title;
  std::vector<std::string> rows, columns;    // names
  std::vector<std::vector<HeatCell>> cells;  // [row][column]
  std::string legend;                        // meaning of shade and number
  double width_px = 1060;                    // limit for the cells; long titles and legends may exceed it
};

// Returns one <svg> element, for the style sheet of chart.hpp. Without rows it says "nothing to show".
std::string to_svg(const HeatMap& map);

}  // namespace kenaf::gap::plot
