// What may be in an outline's part, in libsdformat's own description language.
//
// Thread safety: a pure function.
#pragma once

#include <string>
#include <string_view>

namespace kenaf::physics {

// Returns the description of a document (an <sdf> with a <world>) that holds a part of that kind (SdfPart::kind).
// Elements, types and defaults are those of SDF 1.9, and <density> and auto of SDF 1.11, as far as the outline keeps
// them.
std::string schema_of(std::string_view kind);

}  // namespace kenaf::physics
