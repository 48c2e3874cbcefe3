// <include merge="true">: what is in the included model becomes part of the model that includes it.
//
// Thread safety: pure functions.
#pragma once

#include <vector>

#include "physics/files/sdf_element.hpp"

namespace kenaf::physics {

// Appends what is in `model`, which stands where and under the name that its <include> says, to the children of another
// model, as libsdformat does (http://sdformat.org/tutorials?tut=composition_proposal, merging of included models): a
// frame "_merged__NAME__model__" takes the place of the model's own, and poses in that of the model are relative to it.
// Its <static> has no effect, as that of the other model counts. It must have no placement frame.
void add_merged(SdfElement model, std::vector<SdfElement>& children);

}  // namespace kenaf::physics
