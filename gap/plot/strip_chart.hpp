// Named time spans in strips over one common axis, darker for more.
//
// Thread safety: values and pure functions.
#pragma once

#include <string>
#include <vector>

namespace kenaf::gap::plot {

struct StripSpan {
  double from, to;
  double strength;         // of the shade, 0 to 1
  std::string name, note;  // in the span, one below the other, if they have room
  std::string link = {};   // where a click on it leads, "#anchor"; empty: nowhere
};

struct Strip {
  std::string label;  // left of the axis
  std::vector<StripSpan> spans;
};

struct StripChart {
  std::string title, x_label;
  std::vector<Strip> strips;
  std::string legend;                      // meaning of the shade
  std::string least, most;                 // at the ends of the scale of shades
  double label_px = 190, width_px = 1060;  // labels get more if they need it, up to half of the width
};

// Returns one <svg> element, for the style sheet of chart.hpp. Without strips it says "nothing to show". A name without
// room in its span is shown under the pointer.
std::string to_svg(const StripChart& chart);

}  // namespace kenaf::gap::plot
