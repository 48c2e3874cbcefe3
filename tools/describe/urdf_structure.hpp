// Whether links and joints of a URDF make one tree, and whether its numbers are numbers. liburdfdom takes a second
// parent of a link without a word, and forgets lines.
//
// Thread safety: a pure function.
#pragma once

#include <string>

#include "tools/describe/xml_tree.hpp"

namespace kenaf::describe {

// Throws DescriptionError with `file`, line, and the link or joint at fault: the root is not <robot>, or xacro's
// elements were not expanded; a name is missing, longer than 200 bytes or used twice; there are more than 1000 links; a
// joint's parent or child is missing or no link; a link has two parents; joints form a loop; there are several roots or
// none; a place, size, mass, inertia or limit is not as many finite numbers of at most 1e9 as it takes.
void check_structure(const XmlNode& robot, const std::string& file);

}  // namespace kenaf::describe
