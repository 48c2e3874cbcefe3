// SVG elements shared by all kinds of charts.
//
// Thread safety: pure functions.
#pragma once

#include <string>
#include <string_view>

namespace kenaf::gap::plot {

// Returns a chart with its title at the left. To a screen reader it is a picture; with links, whose text a picture
// would hide, a group.
std::string svg_chart(std::string_view title, double width_px, double height_px, std::string_view contents,
                      double title_x_px = 0);

// Returns escaped text whose baseline begins at a point (with class "middle": is centred there, "end": ends there);
// empty for empty text.
std::string text_at(double x_px, double y_px, std::string_view text, std::string_view classes = {});

// Returns the approximate width of text at the charts' font size; reserve a little more.
double text_width_px(std::string_view text);
// Returns the text if it fits into `width_px`, otherwise its end after an ellipsis: long names differ at their ends.
std::string end_of(std::string_view text, double width_px);

// Returns `svg` as a link; unchanged if `link` is empty.
std::string linked(std::string svg, std::string_view link);

// Returns a box shaded by `strength`, from 0 to 1, on which text stays readable. `hint` is shown under the pointer.
std::string shaded_box(double x_px, double y_px, double width_px, double height_px, double strength,
                       std::string_view hint = {});

}  // namespace kenaf::gap::plot
