// The numbers, vectors, truth values and poses that SDF's elements say in words.
//
// Each function reads the first child of that name and throws DescriptionError with the child's place and name if its
// text is not such a value. What the file leaves out, with or without the child, is at the default given, SDF's own
// (http://sdformat.org/spec). Numbers are finite or not: ranges are the caller's.
//
// Thread safety: pure functions.
#pragma once

#include <Eigen/Core>
#include <string_view>

#include "physics/files/sdf_element.hpp"
#include "physics/pose.hpp"

namespace kenaf::physics {

double number_in(const SdfElement& element, std::string_view child, double otherwise);
Eigen::Vector3d vector3_in(const SdfElement& element, std::string_view child, const Eigen::Vector3d& otherwise);
bool truth_in(const SdfElement& element, std::string_view child, bool otherwise);
bool truth_attribute_of(const SdfElement& element, std::string_view name, bool otherwise);

// The text of the child; empty without one.
std::string text_in(const SdfElement& element, std::string_view child);

// The numbers of an element itself.
Eigen::Vector2d vector2_of(const SdfElement& element);

// What an element's <pose> says, with rotation_format and degrees; identity without one. The pose is finite.
Pose pose_in(const SdfElement& element);

}  // namespace kenaf::physics
