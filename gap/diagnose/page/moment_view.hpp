// A moment as a still picture and as data for the page's player. Both look at it alike: without perspective, from
// behind on the right of the real robot.
//
// Thread safety: pure functions.
#pragma once

#include <string>

#include "gap/diagnose/page/moments.hpp"
#include "gap/diagnose/page/shapes.hpp"

namespace kenaf::gap::diagnose {

inline constexpr double kMomentWidth_px = 524, kMomentHeight_px = 300;

// Where one looks from.
struct MomentView {
  Eigen::Vector3d centre_W_m;         // in the middle of the picture
  double azimuth_rad, elevation_rad;  // of the eye, seen from there; azimuth from x to y
  double half_width_m;                // from the middle to the edge
};
MomentView view_of_moment(const Moment& moment, const RobotFaces& robot);

// One <svg> element of class "still", coloured by the page's style sheet: the real robot, the others translucent under
// it. `title`: its name.
std::string moment_still(const Moment& moment, const RobotFaces& robot, const WorldFaces& world,
                         std::string_view title);

// JSON for moment_player.js, which documents it.
std::string robot_data(const RobotFaces& robot);
std::string moment_data(const Moment& moment, const RobotFaces& robot, const WorldFaces& world);

// HTML: every moment with what is seen, the command for the whole run, and its picture. `report_folder`: for the
// command; empty if it is not known.
std::string moments_section(const Diagnosis& d, std::span<const Overlay> overlays, std::span<const Moment> moments,
                            std::string_view report_folder);

}  // namespace kenaf::gap::diagnose
