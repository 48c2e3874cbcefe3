// The collision shapes of a robot, from its description: convex hulls, prisms along y.
#pragma once

#include <memory>
#include <vector>

#include "physics/dynamics/bullet.hpp"
#include "physics/robot_description.hpp"

namespace kenaf::physics {

// The outline of a prism in its x-z plane, in order.
using Outline = std::vector<Eigen::Vector2d>;

Outline track_outline(const TrackDescription& track);  // a circle for a wheel

// A flipper around its pivot: x from the pivot to the tip drum.
Outline flipper_outline(const FlipperDescription& flipper);

// Area, centroid and second moments of area about the centroid of a convex outline.
struct OutlineMoments {
  double area;
  Eigen::Vector2d centroid;
  double Ixx, Izz;  // integrals of x^2 and z^2
};
OutlineMoments moments(const Outline& outline);

// A hull of `outline`, swept `width_m` along y around y = 0, moved by `offset`.
std::unique_ptr<btConvexHullShape> make_prism(const Outline& outline, double width_m, const Eigen::Vector3d& offset);
std::unique_ptr<btBoxShape> make_box(const Eigen::Vector3d& size_m);

}  // namespace kenaf::physics
