// SDF's shapes other than plane and box, as closed surfaces of triangles whose normals point outward.
// All corners lie on the shape, so the triangles lie within it by up to the chord error: at most 1 mm up to a radius of
// 6 m; beyond, the number of corners is constant and the error grows with the radius.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "physics/triangle_surface.hpp"

namespace kenaf::physics {

// Axis z, centre in the origin.
TriangleSurface cylinder_surface(double radius_m, double length_m);
TriangleSurface sphere_surface(double radius_m);
// `length_m` is that of the cylinder between the half spheres.
TriangleSurface capsule_surface(double radius_m, double length_m);
TriangleSurface ellipsoid_surface(const Eigen::Vector3d& radii_m);

// The polygon extruded from z = 0 to `height_m`; either sense of rotation. Throws DescriptionError if there are fewer
// than 3 or more than 500 points, or the polygon touches or crosses itself.
TriangleSurface prism_surface(std::vector<Eigen::Vector2d> corners_m, double height_m);

}  // namespace kenaf::physics
