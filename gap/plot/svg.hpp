// The pieces that all kinds of chart are written with.
//
// Thread safety: pure functions.
#pragma once

#include <string>
#include <string_view>

namespace kenaf::gap::plot {

// The opening tag of a chart with its title, which stands at the left; "</svg>" closes it.
std::string svg_begin(std::string_view title, double width_px, double height_px, double title_x_px = 0);

// Escaped text whose baseline begins (class "middle", "end": lies around, ends) at a place; nothing for no text.
std::string text_at(double x_px, double y_px, std::string_view text, std::string_view classes = {});

// About the width of text at the charts' font size: whoever needs room for it must take a little more.
double text_width_px(std::string_view text);
// All of the text where it has room in `width_px`; else its end, after an ellipsis: of long names the ends differ.
std::string end_of(std::string_view text, double width_px);

// A box shaded by `strength`, from 0 to 1, so that dark text on it stays readable. `hint` shows under the pointer.
std::string shaded_box(double x_px, double y_px, double width_px, double height_px, double strength,
                       std::string_view hint = {});

}  // namespace kenaf::gap::plot
