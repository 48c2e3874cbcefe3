// An outline's parts as elements of libsdformat.
//
// libsdformat gives each element a description of all that may be in it, 2.5 MB for a model. So it reads each part by a
// description of the few elements that the outline keeps, and those that are returned have none.
//
// Thread safety: any thread.
#pragma once

#include <sdf/Element.hh>
#include <sdf/SDFImpl.hh>

#include "physics/files/sdf_outline.hpp"

namespace kenaf::physics {

// libsdformat refuses a link whose mass or inertia no rigid body has; in a static model they have no effect.
inline constexpr const char* kInertialElement = "kenaf:inertial";

// Returns the element of a part, without the parts in it. Elements have the file and the line that they have
// there. What the file leaves out is at SDF's default, or is no element. Throws DescriptionError ("file:line: what").
sdf::ElementPtr read_part(const SdfPart& part);

// Returns an <sdf> with that world, for sdf::Root::Load().
sdf::SDFPtr document_of(const sdf::ElementPtr& element);

}  // namespace kenaf::physics
