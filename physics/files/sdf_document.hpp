// The text of an SDF file (http://sdformat.org) as a tree of what this simulator reads.
//
// What has no effect here (visuals, sensors, plugins, ...) is noted with its line, does not get into the tree, and may
// hold anything. What SDF 1.8 and earlier say otherwise is put as SDF 1.9 says it.
//
// Thread safety: pure functions, but for the notes.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "physics/files/sdf_element.hpp"
#include "physics/files/sdf_notes.hpp"

namespace kenaf::physics {

// Models in models, whether written there or included: a world's own models have a depth of 1.
inline constexpr int kMostNestedModels = 16;
// Of one file, '<' and '=' counted: as much as a file of 16 MiB can hold would take 500 MB as a document.
inline constexpr std::size_t kMostMarks = 1'000'000;
// Of one element: reading them takes quadratic time.
inline constexpr std::size_t kMostAttributes = 1000;

// Returns the only <world> of a file. `file` is for errors and notes. In the world are <gravity>, <frame>, <include>
// and <model>; in a model <static>, <pose>, <link>, <frame>, <joint>, <include> and <model>. All worlds, models, links,
// collisions and frames have names, and siblings have different ones. Of a joint there are name, pose and, as
// attached_to, its child: it is not simulated, but poses may be given in its frame.
// Throws DescriptionError ("file:line: what") if the text is no XML document, has no <sdf> with a version, not exactly
// one <world>, models nested deeper than kMostNestedModels, more than kMostMarks or kMostAttributes, a <polyline> of
// more than 500 points, or names that are missing, reserved or used twice.
SdfElement sdf_world(std::string_view text, const std::string& file, SdfNotes& notes);

// Returns the first <model> of a file, or nothing if there is none. Throws as above.
std::optional<SdfElement> sdf_model(std::string_view text, const std::string& file, SdfNotes& notes);

// Throws DescriptionError if a world, model, link, collision or frame has no name, or a reserved one.
void check_name(const SdfElement& element);

// Throws DescriptionError if two siblings in a world or model have the same name.
void check_sibling_names(const SdfElement& parent);

}  // namespace kenaf::physics
