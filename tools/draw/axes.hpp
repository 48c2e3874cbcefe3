// The frame around a view: grid, ticks, their labels and the axes' names.
#pragma once

#include <string>

#include "tools/draw/robot_shape.hpp"

namespace kenaf::draw {

// The part of a view's area inside of its labels.
Rectangle inside_labels(const Rectangle& area);

// Fills the area and draws the grid. The grid lies under the view.
void draw_grid(const Canvas& canvas, const Mapping& map);

// The frame, the tick labels and the axes' names with their unit: mm for small areas, m for large ones.
void draw_labels(const Canvas& canvas, const Mapping& map, const std::string& caption, const std::string& right_name,
                 const std::string& up_name);

// A length of 1, 2 or 5 times a power of ten that is at least `at_least`.
double round_step(double at_least);

}  // namespace kenaf::draw
