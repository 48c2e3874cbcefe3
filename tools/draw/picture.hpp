// The whole picture: title, runs, views and legend.
#pragma once

#include "tools/draw/views.hpp"

namespace kenaf::draw {

enum class ViewChoice { top, side, automatic };  // automatic: from above, and from the side if the robot climbs

void draw_picture(const Canvas& canvas, const Scene& scene, const std::string& title, ViewChoice view);

// "0.401 m in 23.4 s, end 3.1 mm and 0.4 degrees from the start"; for the other runs also the distance of their ends
// from that of the first.
std::string summary(const Scene& scene, std::size_t index);

}  // namespace kenaf::draw
